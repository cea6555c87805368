// What every browser test starts from: the real server, a line to it, and the viewer open in Chromium.
//   LIGHTWELL=build/release/lightwell node --test tests/browser/viewer.test.mjs
// Pictures of the page are left in LIGHTWELL_SCREENSHOTS (build/release/browser) for people to look at.
import { mkdirSync } from "node:fs";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { Line, start_server } from "./server_process.mjs";
import { open_browser, ViewerPage } from "./viewer_page.mjs";

export const root = fileURLToPath(new URL("../..", import.meta.url));
export const program = process.env.LIGHTWELL ?? path.join(root, "build/release/lightwell");
const screenshots = process.env.LIGHTWELL_SCREENSHOTS ?? path.join(root, "build/release/browser");
const running_at = Number(process.env.LIGHTWELL_PORT ?? 0);  // a server to use that runs already

export const kDesktop = { viewport: { width: 1440, height: 900 } };
export const kLaptop = { viewport: { width: 1280, height: 720 } };
export const kPhone = { viewport: { width: 390, height: 844 }, deviceScaleFactor: 3, isMobile: true, hasTouch: true };

export class Fixture {
  /** @param {string[]} options of `lightwell serve`; unless they say otherwise, a final picture stays */
  constructor(options = []) {
    this.options = options.includes("--reference-after") ? options : [...options, "--reference-after", "0"];
  }

  async start() {
    mkdirSync(screenshots, { recursive: true });
    this.server = running_at ? { port: running_at, stop() {} } : await start_server(program, this.options);
    this.line = await new Line(this.server.port).open();
    this.browser = await open_browser();
    this.viewer = await this.open(kDesktop);
    this.page = this.viewer.page;
    return this;
  }

  /** One more viewer, with playwright's `options` for its window and `hash` in its address; `first` runs in it before. */
  open(options, hash = "", first = undefined) {
    return ViewerPage.open(this.browser, this.address(hash), options, first);
  }

  async stop() {
    await this.browser?.close();
    this.line?.close();
    await this.server?.stop();
  }

  /** Of the viewer, or of what is named relative to it, over the line that can be cut. */
  address(relative = "") {
    return `http://127.0.0.1:${this.line.port}/${relative}`;
  }

  keep(name, page = this.page) {
    return page.screenshot({ path: path.join(screenshots, `${name}.png`) });
  }

  /** The panel's control with this label. */
  setting(label) {
    return this.page.getByLabel(label, { exact: true });
  }

  /** Does `act`, waits for a picture that answers it, and gives the picture before and after. */
  async pictures_around(act) {
    const { viewer } = this;
    const { asked } = await viewer.all_answered();
    const earlier = await viewer.picture();
    await act();
    await viewer.until(`an input after ${asked}`, () => viewer.stage(), (stage) => Number(stage.asked) > Number(asked));
    const { shown } = await viewer.all_answered();
    await viewer.until("a finer picture", () => viewer.stage(), (stage) =>
      stage.final === "true" || Number(stage.shown) >= Number(shown) + 2);
    return [earlier, await viewer.picture()];
  }
}
