// The viewer of a server that asks for a token.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { Fixture, kDesktop } from "./fixture.mjs";

const kToken = "browser-token-0123456789";
const fixture = new Fixture(["--token", kToken]);
let viewer, page;

before(async () => {
  ({ viewer, page } = await fixture.start());
});

after(() => fixture.stop());

test("a token is asked for, and the right one opens the viewer", async () => {
  await page.waitForSelector("#token-dialog", { state: "visible" });
  await fixture.keep("desktop-token");
  await page.fill("#token-input", "not-the-right-token-at-all");
  await page.keyboard.press("Enter");
  await viewer.until("to be told", () => page.textContent("#token-reason"), (text) => /not known/.test(text));
  await page.fill("#token-input", kToken);
  await page.keyboard.press("Enter");
  await viewer.more_frames(2);
  assert.equal(await page.isVisible("#token-dialog"), false);
  viewer.errors = viewer.errors.filter((text) => !/status of 401/.test(text));
  assert.deepEqual(viewer.errors, []);
});

test("a token in the address opens the viewer, and does not stay there", async () => {
  const linked = await fixture.open(kDesktop, `#scene=cornell&token=${kToken}`);
  await linked.more_frames(1);
  assert.equal(await linked.page.textContent("#scene-title"), "Cornell");
  assert.doesNotMatch(linked.page.url(), /token/);
  assert.deepEqual(linked.errors, []);
  await linked.context.close();
});
