// The viewer in a real browser against the real server: picture, camera, settings, lights, files.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { after, before, test } from "node:test";
import { Fixture, kDesktop } from "./fixture.mjs";
import { make_glb } from "./make_glb.mjs";
import { difference } from "./viewer_page.mjs";

const fixture = new Fixture();
let viewer, page;

before(async () => {
  ({ viewer, page } = await fixture.start());
});

after(() => fixture.stop());

const canvas_width = () => page.$eval("#picture", (canvas) => canvas.width);
const status = () => page.textContent("#status-text");

test("the page shows a picture that is not black and moves", async () => {
  const { shown } = await viewer.more_frames(1);
  assert.ok(Number(shown) > 0);
  const first = await viewer.picture();
  assert.ok(first.mean > 8, `mean brightness ${first.mean}`);
  await viewer.until("the picture to change", () => viewer.picture(), (picture) => difference(first, picture) > 0.3);
  await viewer.until("the rate to be told", status, (text) => /\d+ fps/.test(text));
  assert.equal(await page.isVisible("#curtain"), false);
  assert.equal(await page.isVisible("#banner"), false);
  await fixture.keep("desktop");
});

test("space pauses; the picture is refined to its end and then stands still", async () => {
  await page.keyboard.press("Space");
  assert.equal(await page.getAttribute("#play-button", "aria-label"), "Play");
  await viewer.until("the status to say so", status, (text) => /Refining|Final/.test(text));
  await viewer.final_picture();
  await viewer.until("the status to say so", status, (text) => /Final/.test(text));
  await fixture.keep("desktop-final");
  const { shown } = await viewer.stage();
  await page.waitForTimeout(700);
  assert.equal((await viewer.stage()).shown, shown);
});

test("dragging orbits: the picture changes and frames answer the inputs", async () => {
  const [earlier, later] = await fixture.pictures_around(() => viewer.drag({ x: 500, y: 450 }, { x: 760, y: 480 }));
  assert.ok(difference(earlier, later) > 1, `difference ${difference(earlier, later)}`);
  assert.equal(await page.getAttribute("#follow-button", "aria-pressed"), "false");
  await viewer.until("the address to keep the camera", () => page.evaluate(() => location.hash), (hash) =>
    /^#scene=[a-z]+&eye=.*&target=/.test(hash));
  await fixture.keep("desktop-orbited");
});

test("wheel, right drag and arrow keys move the camera too", async () => {
  const [, zoomed] = await fixture.pictures_around(async () => {
    await page.mouse.move(700, 400);
    await page.mouse.wheel(0, -400);
  });
  const [before_pan, panned] = await fixture.pictures_around(() =>
    viewer.drag({ x: 500, y: 450 }, { x: 620, y: 380 }, { button: "right" }));
  assert.ok(difference(zoomed, panned) > 0.5 && difference(before_pan, panned) > 0.5);
  const [before_key, turned] = await fixture.pictures_around(() => page.keyboard.press("ArrowLeft", { delay: 300 }));
  assert.ok(difference(before_key, turned) > 0.5);
});

test("the scene's camera is a key away", async () => {
  await fixture.pictures_around(() => page.keyboard.press("c"));
  assert.equal(await page.getAttribute("#follow-button", "aria-pressed"), "true");
  const [, whole] = await fixture.pictures_around(() => page.keyboard.press("f"));
  assert.ok(whole.mean > 0);
  await fixture.pictures_around(() => page.keyboard.press("c"));
});

test("1, 2 and 3 switch the light shown; direct light alone is darker", async () => {
  await fixture.setting("Automatic exposure").uncheck();
  const [final, direct] = await fixture.pictures_around(() => page.keyboard.press("2"));
  assert.ok(await page.isChecked("#view-switch input[value=direct]"));
  assert.ok(direct.mean < final.mean - 1, `direct ${direct.mean}, final ${final.mean}`);
  await fixture.keep("desktop-direct");
  const [, indirect] = await fixture.pictures_around(() => page.keyboard.press("3"));
  assert.ok(difference(direct, indirect) > 1);
  await fixture.keep("desktop-indirect");
  await fixture.pictures_around(() => page.keyboard.press("1"));
  await fixture.setting("Automatic exposure").check();
});

test("the settings reach the picture", async () => {
  await fixture.pictures_around(() => fixture.setting("Samples").fill("2"));
  assert.equal(await page.locator(".row", { has: fixture.setting("Samples") }).locator("output").textContent(), "4");
  const [, normals] = await fixture.pictures_around(() => fixture.setting("Show").selectOption("normal"));
  const [, back] = await fixture.pictures_around(() => fixture.setting("Show").selectOption("final"));
  assert.ok(difference(normals, back) > 1);
  await fixture.pictures_around(() => fixture.setting("Size").selectOption("1280"));
  await viewer.until("the larger picture", canvas_width, (width) => width === 1280);
  await fixture.pictures_around(() => fixture.setting("Size").selectOption("auto"));
  await fixture.setting("Samples").fill("5");
});

test("scrubbing goes to another time", async () => {
  const [earlier, later] = await fixture.pictures_around(() =>
    page.$eval("#scrubber", (scrubber) => {
      scrubber.value = scrubber.max * 0.6;
      scrubber.dispatchEvent(new Event("input"));
      scrubber.dispatchEvent(new Event("change"));
    }));
  assert.ok(difference(earlier, later) > 0.3);
});

test("a dropped .glb is opened", async () => {
  await viewer.drop_file("Test Corner.glb", make_glb());
  await viewer.until("the scene", () => page.textContent("#scene-title"), (title) => title === "Test corner");
  await viewer.more_frames(2);
  await viewer.final_picture();
  assert.ok((await viewer.picture()).mean > 8);
  await fixture.keep("desktop-dropped");
});

test("a lamp dragged in the picture lights another place", async () => {
  const handle = await viewer.box(".light-handle.is-point");
  const from = { x: handle.x + handle.width / 2, y: handle.y + handle.height / 2 };
  const to = { x: from.x - 220, y: from.y + 40 };
  const [earlier, later] = await fixture.pictures_around(() => viewer.drag(from, to));
  assert.ok(difference(earlier, later) > 1);
  const moved = await viewer.box(".light-handle.is-point");
  assert.ok(Math.hypot(moved.x - handle.x + 220, moved.y - handle.y - 40) < 3, "the handle stays under the pointer");
  const columns = (picture, from_x, to_x) =>
    picture.grey.filter((_, i) => i % 32 >= from_x && i % 32 < to_x).reduce((sum, value) => sum + value, 0);
  const left_share = (picture) => columns(picture, 0, 16) / columns(picture, 0, 32);
  assert.ok(left_share(later) > left_share(earlier), "the left is brighter now");
  await fixture.keep("desktop-light");
  const [lit, dark] = await fixture.pictures_around(() => page.getByRole("switch", { name: "lamp on" }).uncheck());
  assert.ok(dark.mean < lit.mean);
  await fixture.pictures_around(() => page.getByRole("switch", { name: "lamp on" }).check());
});

test("what cannot be opened is refused in words", async () => {
  await viewer.drop_file("broken.glb", Buffer.from("this is no model"));
  await page.waitForSelector(".toast.is-trouble");
  const words = await page.textContent(".toast.is-trouble span");
  assert.match(words, /broken\.glb was not opened\. .{10,}/);
  await fixture.keep("desktop-refused");
  await viewer.drop_file("scene.gltf", Buffer.from("{}"));
  await viewer.until("the second note", () => page.textContent("#toasts"), (text) => /Export it as \.glb/.test(text));
  viewer.errors = viewer.errors.filter((text) => !/status of 4\d\d/.test(text));  // Chromium reports every 4xx there
});

test("the picture can be saved", async () => {
  const [download] = await Promise.all([page.waitForEvent("download"), page.keyboard.press("s")]);
  assert.match(download.suggestedFilename(), /^test-corner-\d+\.\d\ds\.png$/);
  const bytes = await readFile(await download.path());
  assert.equal(bytes.subarray(1, 4).toString(), "PNG");
});

test("an address opens its scene and camera, and one that is wrong says so", async () => {
  const shared = await fixture.open(kDesktop, "#scene=cornell&eye=0,1,9&target=0,1,0&yfov=0.5");
  await shared.more_frames(1);
  assert.equal(await shared.page.textContent("#scene-title"), "Cornell");
  assert.equal(await shared.page.getAttribute("#follow-button", "aria-pressed"), "false");
  await shared.context.close();
  const wrong = await fixture.open(kDesktop, "#scene=no-such-scene");
  await wrong.until("to be told", () => wrong.page.textContent("#toasts"), (text) => /no-such-scene/.test(text));
  await wrong.more_frames(1);
  await wrong.context.close();
});

test("nothing was reported in the console", () => assert.deepEqual(viewer.errors, []));

