// Two browsers on one session: who drives, and who watches by a link, with the driver's pictures or a camera of one's own.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { Fixture, kLaptop } from "./fixture.mjs";
import { difference } from "./viewer_page.mjs";

const fixture = new Fixture(["builtin:cornell"]);
let driver, watcher;

before(async () => {
  ({ viewer: driver } = await fixture.start());
  await driver.more_frames(1);
  const { session } = await driver.stage();
  watcher = await fixture.open(kLaptop, `#watch=${session}`);
  await watcher.more_frames(1);
});

after(() => fixture.stop());

const settled = async (viewer) => {
  await viewer.all_answered();
  await viewer.final_picture();
  return viewer.picture();
};

test("a watcher sees the driver's picture and none of the driver's controls", async () => {
  assert.ok(difference(await settled(driver), await settled(watcher)) < 1);
  assert.equal((await watcher.stage()).session, (await driver.stage()).session);
  assert.equal(await watcher.page.isVisible("#panel"), false);
  assert.equal(await watcher.page.isVisible(".transport"), false);
  assert.ok(await watcher.page.isDisabled("#watch-button"));
});

test("a watcher who drags looks for itself; the driver's picture stays", async () => {
  const drivers = await settled(driver);
  const shared = await settled(watcher);
  await watcher.drag({ x: 400, y: 400 }, { x: 620, y: 430 });
  await watcher.until("a picture of its own", () => watcher.picture(), (picture) => difference(shared, picture) > 1);
  await settled(watcher);
  await fixture.keep("watching", watcher.page);
  assert.ok(difference(drivers, await driver.picture()) < 1);
});

test("a button gives the driver's picture back", async () => {
  const own = await watcher.picture();
  await watcher.page.click("#watch-button");
  await watcher.until("another picture", () => watcher.picture(), (picture) => difference(own, picture) > 1);
  assert.ok(difference(await settled(driver), await settled(watcher)) < 1);
  assert.ok(await watcher.page.isDisabled("#watch-button"));
});

test("a watcher's keys change nothing for others", async () => {
  const drivers = await settled(driver);
  await watcher.page.keyboard.press("2");
  await watcher.until("a word about it", () => watcher.page.textContent("#toasts"), (text) => /driver/.test(text));
  assert.ok(difference(drivers, await settled(driver)) < 1);
});

test("a watcher who leaves ends nothing; a session that is gone is not made anew", async () => {
  const { session } = await driver.stage();
  await watcher.page.goto("about:blank");
  assert.equal((await fetch(fixture.address(`v1/sessions/${session}`))).status, 200);
  const late = await fixture.open(kLaptop, "#watch=0123456789abcdef");
  await late.until("the refusal", () => late.page.textContent("#banner-text"), (text) => text.trim() !== "");
  assert.equal((await late.stage()).session, undefined);
});
