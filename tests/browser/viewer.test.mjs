// The viewer in a real browser against the real server.
//   LIGHTWELL=build/release/lightwell node --test tests/browser/viewer.test.mjs
// Pictures of the page are left in LIGHTWELL_SCREENSHOTS (build/release/browser) for people to look at.
import assert from "node:assert/strict";
import { mkdirSync } from "node:fs";
import { readFile } from "node:fs/promises";
import path from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { make_glb } from "./make_glb.mjs";
import { Line, start_server } from "./server_process.mjs";
import { difference, open_browser, ViewerPage } from "./viewer_page.mjs";

const root = fileURLToPath(new URL("../..", import.meta.url));
const program = process.env.LIGHTWELL ?? path.join(root, "build/release/lightwell");
const screenshots = process.env.LIGHTWELL_SCREENSHOTS ?? path.join(root, "build/release/browser");
const kDesktop = { viewport: { width: 1440, height: 900 } };
const kLaptop = { viewport: { width: 1280, height: 720 } };
const kPhone = { viewport: { width: 390, height: 844 }, deviceScaleFactor: 3, isMobile: true, hasTouch: true };

let server, browser, line, viewer, page;

before(async () => {
  mkdirSync(screenshots, { recursive: true });
  const running_at = Number(process.env.LIGHTWELL_PORT ?? 0);  // to look at a server that runs already
  server = running_at ? { port: running_at, stop() {} } : await start_server(program);
  line = await new Line(server.port).open();
  browser = await open_browser();
  viewer = await ViewerPage.open(browser, address(), kDesktop);
  page = viewer.page;
});

after(async () => {
  await browser?.close();
  line?.close();
  await server?.stop();
});

const keep = (name, of = page) => of.screenshot({ path: path.join(screenshots, `${name}.png`) });
const address = () => `http://127.0.0.1:${line.port}/`;
const seq = async () => Number((await viewer.stage()).seq);
const answered = (input) => viewer.until(`the answer to input ${input}`, seq, (value) => value >= input);
const setting = (label) => page.getByLabel(label, { exact: true });
const canvas_width = () => page.$eval("#picture", (canvas) => canvas.width);
const canvas_aspect = () => page.$eval("#picture", (canvas) => canvas.width / canvas.height);
const status = () => page.textContent("#status-text");

/** Does `act`, waits for the frame that answers it, and gives the picture before and after. */
async function pictures_around(act) {
  const earlier = await viewer.picture();
  const input = (await seq()) + 1;
  await act();
  await answered(input);
  await viewer.more_frames(2);
  return [earlier, await viewer.picture()];
}

test("the page shows a picture that is not black and moves", async () => {
  const { frame } = await viewer.more_frames(1);
  assert.ok(Number(frame) > 0);
  const first = await viewer.picture();
  assert.ok(first.mean > 8, `mean brightness ${first.mean}`);
  await viewer.until("the picture to change", () => viewer.picture(), (picture) => difference(first, picture) > 0.3);
  await page.waitForTimeout(1000);
  assert.match(await status(), /\d+ fps/);
  assert.equal(await page.isVisible("#curtain"), false);
  assert.equal(await page.isVisible("#banner"), false);
  await keep("desktop");
});

test("space pauses; the picture is refined to its end and then stands still", async () => {
  await page.keyboard.press("Space");
  assert.equal(await page.getAttribute("#play-button", "aria-label"), "Play");
  await viewer.until("the status to say so", status, (text) => /Refining|Final/.test(text));
  await viewer.final_picture();
  await viewer.until("the status to say so", status, (text) => /Final/.test(text));
  await keep("desktop-final");
  const { frame } = await viewer.stage();
  await page.waitForTimeout(700);
  assert.equal((await viewer.stage()).frame, frame);
});

test("dragging orbits: the picture changes and frames answer the inputs", async () => {
  const [earlier, later] = await pictures_around(() => viewer.drag({ x: 500, y: 450 }, { x: 760, y: 480 }));
  assert.ok(difference(earlier, later) > 1, `difference ${difference(earlier, later)}`);
  assert.equal(await page.getAttribute("#follow-button", "aria-pressed"), "false");
  await viewer.until("the address to keep the camera", () => page.evaluate(() => location.hash), (hash) =>
    /^#scene=[a-z]+&eye=.*&target=/.test(hash));
  await keep("desktop-orbited");
});

test("wheel, right drag and arrow keys move the camera too", async () => {
  const [, zoomed] = await pictures_around(async () => {
    await page.mouse.move(700, 400);
    await page.mouse.wheel(0, -400);
  });
  const [before_pan, panned] = await pictures_around(() =>
    viewer.drag({ x: 500, y: 450 }, { x: 620, y: 380 }, { button: "right" }));
  assert.ok(difference(zoomed, panned) > 0.5 && difference(before_pan, panned) > 0.5);
  const [before_key, turned] = await pictures_around(() => page.keyboard.press("ArrowLeft", { delay: 300 }));
  assert.ok(difference(before_key, turned) > 0.5);
});

test("the scene's camera is a key away", async () => {
  await pictures_around(() => page.keyboard.press("c"));
  assert.equal(await page.getAttribute("#follow-button", "aria-pressed"), "true");
  const [, whole] = await pictures_around(() => page.keyboard.press("f"));
  assert.ok(whole.mean > 0);
  await pictures_around(() => page.keyboard.press("c"));
});

test("1, 2 and 3 switch the light shown; direct light alone is darker", async () => {
  await setting("Automatic exposure").uncheck();
  const [final, direct] = await pictures_around(() => page.keyboard.press("2"));
  assert.ok(await page.isChecked("#view-switch input[value=direct]"));
  assert.ok(direct.mean < final.mean - 1, `direct ${direct.mean}, final ${final.mean}`);
  await keep("desktop-direct");
  const [, indirect] = await pictures_around(() => page.keyboard.press("3"));
  assert.ok(difference(direct, indirect) > 1);
  await keep("desktop-indirect");
  await pictures_around(() => page.keyboard.press("1"));
  await setting("Automatic exposure").check();
});

test("the settings reach the picture", async () => {
  await pictures_around(() => setting("Samples").fill("2"));
  assert.equal(await page.locator(".row", { has: setting("Samples") }).locator("output").textContent(), "4");
  const [, normals] = await pictures_around(() => setting("Show").selectOption("normal"));
  const [, back] = await pictures_around(() => setting("Show").selectOption("final"));
  assert.ok(difference(normals, back) > 1);
  await pictures_around(() => setting("Size").selectOption("1280"));
  await viewer.until("the larger picture", canvas_width, (width) => width === 1280);
  await pictures_around(() => setting("Size").selectOption("auto"));
  await setting("Samples").fill("5");
});

test("scrubbing goes to another time", async () => {
  const [earlier, later] = await pictures_around(() =>
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
  await keep("desktop-dropped");
});

test("a lamp dragged in the picture lights another place", async () => {
  const handle = await viewer.box(".light-handle.is-point");
  const from = { x: handle.x + handle.width / 2, y: handle.y + handle.height / 2 };
  const to = { x: from.x - 220, y: from.y + 40 };
  const [earlier, later] = await pictures_around(() => viewer.drag(from, to));
  assert.ok(difference(earlier, later) > 1);
  const moved = await viewer.box(".light-handle.is-point");
  assert.ok(Math.hypot(moved.x - handle.x + 220, moved.y - handle.y - 40) < 3, "the handle stays under the pointer");
  const columns = (picture, from_x, to_x) =>
    picture.grey.filter((_, i) => i % 32 >= from_x && i % 32 < to_x).reduce((sum, value) => sum + value, 0);
  const left_share = (picture) => columns(picture, 0, 16) / columns(picture, 0, 32);
  assert.ok(left_share(later) > left_share(earlier), "the left is brighter now");
  await keep("desktop-light");
  const [lit, dark] = await pictures_around(() => page.getByRole("switch", { name: "lamp on" }).uncheck());
  assert.ok(dark.mean < lit.mean);
  await pictures_around(() => page.getByRole("switch", { name: "lamp on" }).check());
});

test("what cannot be opened is refused in words", async () => {
  await viewer.drop_file("broken.glb", Buffer.from("this is no model"));
  await page.waitForSelector(".toast.is-trouble");
  const words = await page.textContent(".toast.is-trouble span");
  assert.match(words, /broken\.glb was not opened\. .{10,}/);
  await keep("desktop-refused");
  await viewer.drop_file("scene.gltf", Buffer.from("{}"));
  await viewer.until("the second note", () => page.textContent("#toasts"), (text) => /Export it as \.glb/.test(text));
  viewer.errors = viewer.errors.filter((text) => !/status of 4\d\d/.test(text));  // Chromium reports every 4xx there
});

test("a cut connection is said, comes back by itself and keeps the session", async () => {
  await page.locator(".toast button").first().click();
  const { session } = await viewer.stage();
  const input = await seq();
  line.cut();
  await page.waitForSelector("#banner", { state: "visible" });
  await keep("desktop-cut");
  await viewer.drag({ x: 500, y: 450 }, { x: 600, y: 470 });  // what is done meanwhile is not lost
  await page.waitForTimeout(600);
  line.mend();
  await page.waitForSelector("#banner", { state: "hidden", timeout: 30000 });
  await viewer.more_frames(1);
  assert.equal((await viewer.stage()).session, session);
  await viewer.until("the answer to the drag", seq, (value) => value > input);
  viewer.errors = viewer.errors.filter((text) => !/ERR_|WebSocket/.test(text));
});

test("a session that has ended is made anew, with its scene and settings", async () => {
  const { session } = await viewer.stage();
  await setting("Samples").fill("4");
  await viewer.more_frames(1);
  await fetch(`http://127.0.0.1:${line.port}/v1/sessions/${session}`, { method: "DELETE" });
  await viewer.until("another session", () => viewer.stage(), (stage) =>
    stage.session !== session && stage.connection === "open");
  await viewer.more_frames(1);
  assert.equal(await page.textContent("#scene-title"), "Test corner");
  assert.equal(await setting("Samples").inputValue(), "4");
  viewer.errors = viewer.errors.filter((text) => !/ERR_|WebSocket|status of 404/.test(text));
});

test("the picture can be saved", async () => {
  const [download] = await Promise.all([page.waitForEvent("download"), page.keyboard.press("s")]);
  assert.match(download.suggestedFilename(), /^test-corner-\d+\.\d\ds\.png$/);
  const bytes = await readFile(await download.path());
  assert.equal(bytes.subarray(1, 4).toString(), "PNG");
});

test("keys: help, panel, handles; the panel's width goes to the picture", async () => {
  await page.keyboard.press("?");
  assert.ok(await page.isVisible("#help"));
  await keep("desktop-help");
  await page.keyboard.press("Escape");
  assert.equal(await page.isVisible("#help"), false);
  await page.keyboard.press("h");
  await viewer.until("the panel to go", () => viewer.box("#stage"), (box) => box.width === 1440);
  await viewer.until("a picture of the window's shape", canvas_aspect, (aspect) => Math.abs(aspect - 1.6) < 0.02);
  await page.keyboard.press("l");
  assert.equal(await page.isVisible("#light-layer"), false);
  await page.keyboard.press("l");
  await page.keyboard.press("h");
  await viewer.until("the panel to come", () => viewer.box("#stage"), (box) => box.width < 1440);
});

test("everything can be reached by Tab, and shows that it has the focus", async () => {
  const seen = new Set();
  for (let i = 0; i < 40; ++i) {
    await page.keyboard.press("Tab");
    seen.add(await page.evaluate(() => document.activeElement.id || document.activeElement.className));
  }
  for (const id of ["picture", "screenshot-button", "panel-button", "fit-button"]) assert.ok(seen.has(id), id);
  await page.focus("#picture");
});

test("nothing was reported in the console", () => assert.deepEqual(viewer.errors, []));

test("a laptop's window", async () => {
  const laptop = await ViewerPage.open(browser, address(), kLaptop);
  await laptop.more_frames(3);
  await laptop.page.waitForTimeout(700);
  await keep("laptop", laptop.page);
  await laptop.page.$eval("#section-stats", (element) => element.scrollIntoView());
  await laptop.page.waitForTimeout(500);
  await keep("laptop-figures", laptop.page);
  await laptop.context.close();
});

test("a phone: everything inside the screen, large enough for a finger, turned and pinched by touch", async () => {
  const phone = await ViewerPage.open(browser, address(), kPhone);
  await phone.more_frames(2);
  await phone.page.waitForTimeout(500);
  await keep("phone", phone.page);
  const boxes = await phone.page.$$eval("#stage button, #view-switch label", (elements) => elements
    .filter((element) => element.checkVisibility({ visibilityProperty: true }))
    .map((element) => ({ id: element.id, ...element.getBoundingClientRect().toJSON() })));
  for (const box of boxes) {
    const is_inside = box.left >= 0 && box.right <= 390 && box.top >= 0 && box.bottom <= 844;
    assert.ok(is_inside, `${JSON.stringify(box)} is outside`);
    if (box.id) assert.ok(box.width >= 40 && box.height >= 40, `${box.id} is ${box.width} x ${box.height}`);
  }
  assert.equal(await phone.page.evaluate(() => document.documentElement.scrollWidth), 390);
  const sent = async () => Number((await phone.stage()).seq);
  const start = await sent();
  await phone.touch([[{ x: 150, y: 400 }, { x: 190, y: 410 }, { x: 240, y: 420 }]]);
  const turned = await phone.until("an answer to the finger", sent, (value) => value > start);
  await phone.touch([
    [{ x: 150, y: 400 }, { x: 140, y: 380 }, { x: 120, y: 350 }],
    [{ x: 240, y: 500 }, { x: 255, y: 520 }, { x: 270, y: 550 }],
  ]);
  await phone.until("an answer to the pinch", sent, (value) => value > turned);
  await keep("phone-pinched", phone.page);
  await phone.page.tap("#panel-button");
  await phone.more_frames(2);
  await phone.page.waitForTimeout(400);
  await keep("phone-panel", phone.page);
  const stage = await phone.box("#stage");
  const panel = await phone.box("#panel");
  assert.ok(stage.height > 300 && panel.y >= stage.height - 1, "the picture stays in sight beside the settings");
  assert.deepEqual(phone.errors, []);
  await phone.context.close();
});

test("a long wait for the server can be cut short", async () => {
  const lost = await ViewerPage.open(browser, address(), kDesktop);
  await lost.more_frames(1);
  line.cut();
  const words = () => lost.page.textContent("#banner-text");
  await lost.until("a wait of some seconds", words, (text) => /in [4-9] s/.test(text));
  line.mend();
  await lost.page.click("#banner-button");
  await lost.page.waitForSelector("#banner", { state: "hidden", timeout: 2000 });
  await lost.context.close();
});
