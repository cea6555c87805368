// A session that stands still goes over into the method reference, and comes back at a touch.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { Fixture } from "./fixture.mjs";

const fixture = new Fixture([
  "builtin:cornell", "--samples", "4", "--bounces", "1", "--no-denoise", "--indirect-size", "64", "--reference-after", "1",
]);
let viewer, page;

before(async () => {
  ({ viewer, page } = await fixture.start());
});

after(() => fixture.stop());

const status = () => page.textContent("#status-text");

const method_shown = () => page.textContent("#section-stats dl.facts dd");  // the first of them

const bounces = () => page.locator(".row", { has: fixture.setting("Bounces") }).locator("output").textContent();

test("bounces without a limit come and go with the method", async () => {
  await fixture.pictures_around(() => fixture.setting("Method").selectOption("reference"));
  await fixture.pictures_around(() => fixture.setting("Bounces").fill("9"));
  assert.equal(await bounces(), "No limit");
  await fixture.pictures_around(() => fixture.setting("Method").selectOption("thesis"));
  assert.equal(await bounces(), "8");
  await fixture.pictures_around(() => fixture.setting("Method").selectOption("realtime"));
  await fixture.pictures_around(() => fixture.setting("Bounces").fill("1"));
  assert.deepEqual(viewer.errors, []);
});

test("the final picture is refined by reference, and a drag ends that at once", async () => {
  await page.keyboard.press("Space");
  await viewer.final_picture();
  await viewer.until("pictures by reference", () => viewer.stage(), (stage) => stage.final !== "true");
  await viewer.until("the samples to be told", status, (text) => /Refining by reference, \d+ samples/.test(text));
  await viewer.until("the method to be told", method_shown, (name) => name === "Reference");
  await fixture.keep("desktop-reference");
  await fixture.pictures_around(() => viewer.drag({ x: 500, y: 450 }, { x: 560, y: 460 }));
  await viewer.until("the method to be told", method_shown, (name) => name === "Realtime");
  assert.deepEqual(viewer.errors, []);
});
