// The viewer when the connection, the session or the looker is gone for a while.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { Fixture, kDesktop } from "./fixture.mjs";

const kPatienceMs = 60000;
const kLongWaitMs = 2500;
const kMostOnTheWay = 6;  // pictures sent and not acknowledged, by the protocol

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
  const shown = async () => Number((await viewer.stage()).shown);
  await fixture.pictures_around(() => fixture.setting("Scene").selectOption("helicopters"));
  await hide(true);
  try {
    const before = await shown();
    const none_for_a_second = async () => {
      const first = await shown();
      await page.waitForTimeout(1000);
      return await shown() === first;
    };
    await viewer.until("a second without a picture", none_for_a_second, (none) => none);
    assert.ok(await shown() <= before + kMostOnTheWay, "no more than are on the way");
  } finally {
    await hide(false);
  }
  await viewer.more_frames(5);
});

test("a cut connection is said, comes back by itself and keeps the session", async () => {
  const { session } = await viewer.stage();
  const { asked } = await viewer.all_answered();
  fixture.line.cut();
  await page.waitForSelector("#banner", { state: "visible" });
  await fixture.keep("desktop-cut");
  await viewer.drag({ x: 500, y: 450 }, { x: 600, y: 470 });  // what is done meanwhile is not lost
  fixture.line.mend();
  await page.waitForSelector("#banner", { state: "hidden", timeout: kPatienceMs });
  assert.equal((await viewer.stage()).session, session);
  const answered = await viewer.all_answered();
  assert.ok(Number(answered.asked) > Number(asked), "the drag was asked for");
  assert.equal(await page.getAttribute("#follow-button", "aria-pressed"), "false");
  viewer.errors = viewer.errors.filter((text) => !/ERR_|WebSocket/.test(text));
});

test("a session that has ended is made anew, with its scene and settings", async () => {
  const { session } = await viewer.stage();
  await fixture.pictures_around(() => fixture.setting("Samples").fill("4"));
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
  await lost.page.evaluate((long_ms) => {  // a long wait does not end by itself any more
    const { dataset } = document.getElementById("stage");
    const set_timer = window.setTimeout;
    window.setTimeout = (act, ms, ...rest) => {
      const is_endless = dataset.connection === "waiting" && ms >= long_ms;
      if (is_endless) dataset.waits = "without end";
      return set_timer(act, is_endless ? 1e9 : ms, ...rest);
    };
  }, kLongWaitMs);
  fixture.line.cut();
  await lost.until("a long wait", () => lost.stage(), (stage) => stage.waits === "without end");
  assert.match(await lost.page.textContent("#banner-text"), /Trying again/);
  fixture.line.mend();
  await lost.page.click("#banner-button", { timeout: kPatienceMs });
  await lost.page.waitForSelector("#banner", { state: "hidden", timeout: kPatienceMs });
  await lost.context.close();
});
