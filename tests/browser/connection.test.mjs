// The viewer when the connection, the session or the looker is gone for a while.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { Fixture, kDesktop } from "./fixture.mjs";

const fixture = new Fixture();
let viewer, page;

before(async () => {
  ({ viewer, page } = await fixture.start());
});

after(() => fixture.stop());

test("a page nobody looks at takes no pictures, and goes on when it is looked at again", async () => {
  const hide = (hidden) => page.evaluate((value) => {
    Object.defineProperty(document, "hidden", { value, configurable: true });
    document.dispatchEvent(new Event("visibilitychange"));
  }, hidden);
  await fixture.pictures_around(() => fixture.setting("Scene").selectOption("helicopters"));
  await hide(true);
  await page.waitForTimeout(500);
  const { frame } = await viewer.stage();
  await page.waitForTimeout(500);
  assert.ok(Number((await viewer.stage()).frame) <= Number(frame) + 2);
  await hide(false);
  await viewer.more_frames(5);
});

test("a cut connection is said, comes back by itself and keeps the session", async () => {
  const { session } = await viewer.stage();
  const input = await fixture.seq();
  fixture.line.cut();
  await page.waitForSelector("#banner", { state: "visible" });
  await fixture.keep("desktop-cut");
  await viewer.drag({ x: 500, y: 450 }, { x: 600, y: 470 });  // what is done meanwhile is not lost
  await page.waitForTimeout(600);
  fixture.line.mend();
  await page.waitForSelector("#banner", { state: "hidden", timeout: 30000 });
  await viewer.more_frames(1);
  assert.equal((await viewer.stage()).session, session);
  await viewer.until("the answer to the drag", () => fixture.seq(), (value) => value > input);
  assert.equal(await page.getAttribute("#follow-button", "aria-pressed"), "false");
  viewer.errors = viewer.errors.filter((text) => !/ERR_|WebSocket/.test(text));
});

test("a session that has ended is made anew, with its scene and settings", async () => {
  const { session } = await viewer.stage();
  await fixture.setting("Samples").fill("4");
  await viewer.more_frames(1);
  await fetch(fixture.address(`v1/sessions/${session}`), { method: "DELETE" });
  await viewer.until("another session", () => viewer.stage(), (stage) =>
    stage.session !== session && stage.connection === "open");
  await viewer.more_frames(1);
  assert.equal(await page.textContent("#scene-title"), "Helicopters");
  assert.equal(await fixture.setting("Samples").inputValue(), "4");
  viewer.errors = viewer.errors.filter((text) => !/ERR_|WebSocket|status of 404/.test(text));
});

test("a long wait for the server can be cut short", async () => {
  const lost = await fixture.open(kDesktop);
  await lost.more_frames(1);
  fixture.line.cut();
  const words = () => lost.page.textContent("#banner-text");
  await lost.until("a wait of some seconds", words, (text) => /in [4-9] s/.test(text));
  fixture.line.mend();
  await lost.page.click("#banner-button");
  await lost.page.waitForSelector("#banner", { state: "hidden", timeout: 2000 });
  await lost.context.close();
});
