// The viewer in a browser, as the test sees and handles it.
import assert from "node:assert/strict";
import { chromium } from "playwright-core";

const kChromium = process.env.CHROMIUM ?? "/usr/bin/chromium";
const kFlags = [
  "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
  "--disable-component-update", "--disable-sync",
];
const kWithinMs = 60000;  // what takes a moment alone takes long beside others
const kFinalWithinMs = 120000;  // dozens of frames, of a scene whose shaders may be new: no bound on speed, but on patience

export const open_browser = () => chromium.launch({ executablePath: kChromium, args: kFlags });

export class ViewerPage {
  /** Opens the viewer in a context of its own, with playwright's `options` for it. */
  static async open(browser, address, options, first = undefined) {
    const viewer = new ViewerPage();
    viewer.context = await browser.newContext({ acceptDownloads: true, ...options });
    viewer.page = await viewer.context.newPage();
    viewer.errors = [];
    if (first) await viewer.page.addInitScript(first);
    viewer.page.on("console", (message) => {
      if (["error", "warning"].includes(message.type())) viewer.errors.push(message.text());
    });
    viewer.page.on("pageerror", (error) => viewer.errors.push(error.stack));
    await viewer.page.goto(address);
    return viewer;
  }

  /** What the stage says of itself: connection, session, asked (inputs sent), seq (input answered), shown, final. */
  async stage() {
    return this.page.$eval("#stage", (element) => ({ ...element.dataset }));
  }

  /** Waits until `test(value)` of `read()`; fails with the last value. */
  async until(what, read, test, within_ms = kWithinMs) {
    const until_ms = Date.now() + within_ms;
    for (;;) {
      const value = await read();
      if (test(value)) return value;
      if (Date.now() > until_ms) assert.fail(`${what}: not within ${within_ms} ms; last seen ${JSON.stringify(value)}; errors: ${this.errors.slice(-6).join(" | ")}`);
      await this.page.waitForTimeout(30);
    }
  }

  /** Waits until `count` more pictures have been shown than now, over whatever streams. */
  async more_frames(count = 1) {
    const before = Number((await this.stage()).shown ?? 0);
    return this.until(`${count} more frames`, () => this.stage(), (stage) => Number(stage.shown) >= before + count);
  }

  /** Waits until the picture shows all that was asked for. */
  async all_answered() {
    return this.until("the answer to all inputs", () => this.stage(), ({ asked, seq, shown }) =>
      Number(shown) > 0 && seq === asked);
  }

  /** Waits for the picture that nothing finer will follow. */
  async final_picture() {
    return this.until("the final picture", () => this.stage(), (stage) => stage.final === "true", kFinalWithinMs);
  }

  /** The picture's mean brightness (0..255) and a coarse copy of it, 32 x 32 grey values. */
  async picture() {
    return this.page.$eval("#picture", (canvas) => {
      const small = new OffscreenCanvas(32, 32).getContext("2d");
      small.drawImage(canvas, 0, 0, 32, 32);
      const { data } = small.getImageData(0, 0, 32, 32);
      const grey = [];
      for (let i = 0; i < data.length; i += 4) grey.push((data[i] + data[i + 1] + data[i + 2]) / 3);
      return { mean: grey.reduce((sum, value) => sum + value, 0) / grey.length, grey };
    });
  }

  async box(selector) {
    return this.page.$eval(selector, (element) => {
      const { x, y, width, height } = element.getBoundingClientRect();
      return { x, y, width, height };
    });
  }

  async drag(from, to, options = {}) {
    await this.page.mouse.move(from.x, from.y);
    await this.page.mouse.down(options);
    await this.page.mouse.move((from.x + to.x) / 2, (from.y + to.y) / 2, { steps: 4 });
    await this.page.mouse.move(to.x, to.y, { steps: 4 });
    await this.page.waitForTimeout(150);  // held still, so that nothing goes on by itself
    await this.page.mouse.up(options);
  }

  /** Fingers by the browser's own touch input: `paths` has a list of points for each finger. */
  async touch(paths) {
    const session = await this.context.newCDPSession(this.page);
    const points = (step) => paths.map((path, id) => ({ ...path[step], id }));
    const send = (type, touchPoints) => session.send("Input.dispatchTouchEvent", { type, touchPoints });
    await send("touchStart", points(0));
    for (let step = 1; step < paths[0].length; ++step) {
      await send("touchMove", points(step));
      await this.page.waitForTimeout(20);
    }
    await this.page.waitForTimeout(150);
    await send("touchEnd", []);
    await session.detach();
  }

  /** Drops a file on the page as a desktop would. */
  async drop_file(name, bytes) {
    const base64 = Buffer.from(bytes).toString("base64");
    await this.page.evaluate(({ name, base64 }) => {
      const bytes = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
      const dataTransfer = new DataTransfer();
      dataTransfer.items.add(new File([bytes], name));
      for (const type of ["dragenter", "dragover", "drop"]) {
        document.body.dispatchEvent(new DragEvent(type, { dataTransfer, bubbles: true, cancelable: true }));
      }
    }, { name, base64 });
  }
}

/** The mean difference of two pictures, in grey values. */
export const difference = (a, b) =>
  a.grey.reduce((sum, value, i) => sum + Math.abs(value - b.grey[i]), 0) / a.grey.length;
