// The viewer in windows of several sizes, by keys alone and by touch.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { Fixture, kLaptop, kPhone } from "./fixture.mjs";

const fixture = new Fixture();
let viewer, page;

before(async () => {
  ({ viewer, page } = await fixture.start());
});

after(() => fixture.stop());

const canvas_aspect = () => page.$eval("#picture", (canvas) => canvas.width / canvas.height);

test("keys: help, panel, handles; the panel's width goes to the picture", async () => {
  await page.keyboard.press("?");
  assert.ok(await page.isVisible("#help"));
  await fixture.keep("desktop-help");
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

test("a laptop's window", async () => {
  const laptop = await fixture.open(kLaptop);
  await laptop.more_frames(3);
  await laptop.page.waitForTimeout(700);
  await fixture.keep("laptop", laptop.page);
  await laptop.page.$eval("#section-stats", (element) => element.scrollIntoView());
  await laptop.page.waitForTimeout(500);
  await fixture.keep("laptop-figures", laptop.page);
  await laptop.context.close();
});

test("a phone: everything inside the screen, large enough for a finger, turned and pinched by touch", async () => {
  const phone = await fixture.open(kPhone);
  await phone.more_frames(2);
  await phone.page.waitForTimeout(500);
  await fixture.keep("phone", phone.page);
  const boxes = await phone.page.$$eval("#stage button, #view-switch label", (elements) => elements
    .filter((element) => element.checkVisibility({ visibilityProperty: true }))
    .map((element) => ({ id: element.id, ...element.getBoundingClientRect().toJSON() })));
  for (const box of boxes) {
    const is_inside = box.left >= 0 && box.right <= 390 && box.top >= 0 && box.bottom <= 844;
    assert.ok(is_inside, `${JSON.stringify(box)} is outside`);
    if (box.id) assert.ok(box.width >= 40 && box.height >= 40, `${box.id} is ${box.width} x ${box.height}`);
  }
  assert.equal(await phone.page.evaluate(() => document.documentElement.scrollWidth), 390);
  const answered = async () => Number((await phone.stage()).seq);
  const { seq: start } = await phone.all_answered();
  await phone.touch([[{ x: 150, y: 400 }, { x: 190, y: 410 }, { x: 240, y: 420 }]]);
  await phone.until("an answer to the finger", answered, (value) => value > Number(start));
  const { seq: turned } = await phone.all_answered();
  await phone.touch([
    [{ x: 150, y: 400 }, { x: 140, y: 380 }, { x: 120, y: 350 }],
    [{ x: 240, y: 500 }, { x: 255, y: 520 }, { x: 270, y: 550 }],
  ]);
  await phone.until("an answer to the pinch", answered, (value) => value > Number(turned));
  await fixture.keep("phone-pinched", phone.page);
  await phone.page.tap("#panel-button");
  await phone.more_frames(2);
  await phone.page.waitForTimeout(400);
  await fixture.keep("phone-panel", phone.page);
  const stage = await phone.box("#stage");
  const panel = await phone.box("#panel");
  assert.ok(stage.height > 300 && panel.y >= stage.height - 1, "the picture stays in sight beside the settings");
  assert.deepEqual(phone.errors, []);
  await phone.context.close();
});

