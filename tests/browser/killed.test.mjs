// A server is killed, and another told to stop, while one viewer drives its session and another watches: both come back by
// themselves, at another server over the same folder, to the session as it was. Between them stands the balancer as it is
// deployed.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { once } from "node:events";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import os from "node:os";
import path from "node:path";
import { after, before, test } from "node:test";
import { Fixture, kDesktop, kLaptop, program, root } from "./fixture.mjs";
import { free_port, start_server } from "./server_process.mjs";
import { difference, open_browser } from "./viewer_page.mjs";

const kBackWithinMs = 60000;  // five seconds until the dead server's session is another's, and what a busy machine adds

/** HAProxy with the configuration of setup/deploy, before the servers at `ports`. */
async function start_balancer(folder, ports) {
  const port = await free_port();
  let text = readFileSync(path.join(root, "setup/deploy/haproxy.cfg"), "utf8").replace("127.0.0.1:8080", `127.0.0.1:${port}`);
  for (let gpu = 0; gpu < 3; ++gpu) {
    const server = `  server gpu${gpu} 127.0.0.1:900${gpu + 1}\n`;
    assert.ok(text.includes(server));
    text = text.replace(server, server.replace(`900${gpu + 1}`, ports[gpu]));
  }
  const file = path.join(folder, "haproxy.cfg");
  writeFileSync(file, text);
  const child = spawn(process.env.HAPROXY ?? "/usr/sbin/haproxy", ["-f", file], { stdio: "ignore" });
  const stopped = once(child, "exit");
  return { port, close: () => (child.kill("SIGKILL"), stopped) };
}

class Cluster extends Fixture {
  async start() {
    this.folder = mkdtempSync(path.join(os.tmpdir(), "lightwell-"));
    const options = [...this.options, "--data", path.join(this.folder, "data"), "--max-request-rate", "0"];
    const start_one = () => start_server(program, [...options, "--drain-delay", "3"]);
    this.servers = await Promise.all([start_one(), start_one(), start_one()]);
    this.line = await start_balancer(this.folder, this.servers.map(({ port }) => port));
    this.server = { stop: () => Promise.all(this.servers.map((server) => server.stop())) };
    this.browser = await open_browser();
    await this.until_reachable();
    this.viewer = await this.open(kDesktop);
    this.page = this.viewer.page;
  }

  async until_reachable() {
    const until_ms = Date.now() + kBackWithinMs;
    while (!(await fetch(this.address("readyz")).catch(() => null))?.ok) {
      assert.ok(Date.now() < until_ms, "the balancer finds no server");
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
  }

  async stop() {
    await super.stop();
    rmSync(this.folder, { recursive: true, force: true });
  }

  /** The servers that say they have the session: one at most, since asking another does not move it. */
  async homes_of(session) {
    const has = async ({ port }) =>
      (await fetch(`http://127.0.0.1:${port}/v1/sessions/${session}`).catch(() => null))?.status === 200;
    const answers = await Promise.all(this.servers.map(has));
    return this.servers.filter((_, i) => answers[i]);
  }
}

const cluster = new Cluster(["builtin:cornell"]);
let driver, watcher;

before(async () => {
  await cluster.start();
  driver = cluster.viewer;
});

after(() => cluster.stop());

const settled = async (viewer) => {
  await viewer.all_answered();
  await viewer.final_picture();
  return viewer.picture();
};

const is_back = (viewer, session, shown) =>
  viewer.until("the same session at another server", () => viewer.stage(), (stage) =>
    stage.connection === "open" && stage.session === session && Number(stage.shown) > Number(shown), kBackWithinMs);

test("who drove and who watched go on at another server when theirs is killed", async () => {
  await cluster.pictures_around(() => cluster.setting("Samples").fill("7"));
  await driver.drag({ x: 500, y: 450 }, { x: 640, y: 470 });
  const { session } = await driver.stage();
  watcher = await cluster.open(kLaptop, `#watch=${session}`);
  await watcher.more_frames(1);
  const before = await settled(driver);
  const [home, ...others] = await cluster.homes_of(session);
  assert.equal(others.length, 0);
  const shown = (await driver.stage()).shown, watched = (await watcher.stage()).shown;

  await home.kill();
  await driver.page.waitForSelector("#banner", { state: "visible" });
  await Promise.all([is_back(driver, session, shown), is_back(watcher, session, watched)]);
  await driver.page.waitForSelector("#banner", { state: "hidden" });

  assert.equal(await cluster.setting("Samples").inputValue(), "7");
  assert.ok(difference(before, await settled(driver)) < 1, "the camera is where it was");
  assert.ok(difference(await driver.picture(), await settled(watcher)) < 1);
  assert.equal((await cluster.homes_of(session)).length, 1);
  await cluster.keep("killed", driver.page);
});

test("who drove drives on, and the watcher sees it", async () => {
  const watched = await settled(watcher);
  const [earlier, later] = await cluster.pictures_around(() => driver.drag({ x: 640, y: 470 }, { x: 420, y: 430 }));
  assert.ok(difference(earlier, later) > 1);
  await watcher.until("the driver's new picture", () => watcher.picture(), (picture) => difference(watched, picture) > 1);
  assert.ok(difference(await settled(driver), await settled(watcher)) < 1);
});

test("both go on at the third when the second is told to stop", async () => {
  const { session } = await driver.stage();
  const before = await settled(driver);
  const [home] = await cluster.homes_of(session);
  const shown = (await driver.stage()).shown, watched = (await watcher.stage()).shown;
  await home.stop();
  await Promise.all([is_back(driver, session, shown), is_back(watcher, session, watched)]);
  assert.ok(difference(before, await settled(driver)) < 1, "the camera is where it was");
  const [earlier, later] = await cluster.pictures_around(() => driver.drag({ x: 420, y: 430 }, { x: 640, y: 480 }));
  assert.ok(difference(earlier, later) > 1, "who drove drives on");
});
