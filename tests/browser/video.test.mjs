// Moving pictures as video, where the browser decodes it, and as JPEG where it does not.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { Fixture, kDesktop, kLaptop } from "./fixture.mjs";

const fixture = new Fixture(["builtin:cornell"]);  // walls of red and green: a wrong matrix of colours shows
let viewer;

before(async () => {
  await fixture.start();
  await fixture.viewer.context.close();  // what it renders takes the others' time
  viewer = await fixture.open(kDesktop, "", keep_what_is_drawn);
});

after(() => fixture.stop());

/** In the page: `drawn.video` and `drawn.file` are all pictures of their kind so far, as the mean RGB of 16 x 16 cells. */
function keep_what_is_drawn() {
  const { drawImage } = CanvasRenderingContext2D.prototype;
  const means = ({ data, width, height }) => {
    const sums = new Float64Array(16 * 16 * 4);
    for (let i = 0; i < data.length; ++i) {
      const x = (i >> 2) % width;
      const y = Math.floor((i >> 2) / width);
      const cell = Math.floor((y * 16) / height) * 16 + Math.floor((x * 16) / width);
      sums[cell * 4 + (i & 3)] += data[i];
    }
    return [...sums].flatMap((sum, i) => (i % 4 === 3 ? [] : [(sum * 255) / sums[i | 3]]));  // alpha is 255 throughout
  };
  globalThis.drawn = { video: [], file: [] };
  CanvasRenderingContext2D.prototype.drawImage = function (picture, ...place) {
    drawImage.call(this, picture, ...place);
    if (this.canvas.id !== "picture") return;
    const kind = picture instanceof ImageBitmap ? "file" : "video";
    globalThis.drawn[kind].push(means(this.getImageData(0, 0, this.canvas.width, this.canvas.height)));
  };
}

const drawn = (viewer) => viewer.page.evaluate(() => globalThis.drawn);
const codec = async (viewer) => (await viewer.stage()).codec;

/** The mean absolute difference of two coarse pictures. */
const difference = (a, b) => a.reduce((sum, value, i) => sum + Math.abs(value - b[i]), 0) / a.length;

/** Moves the camera by a hair, so that a picture comes that moved. */
async function nudge(viewer) {
  const { width, height } = await viewer.box("#picture");
  await viewer.drag({ x: width / 2, y: height / 2 }, { x: width / 2 + 1, y: height / 2 });
}

test("what stands still ends as a JPEG; what moves is video of the same colours", async () => {
  const { session } = await viewer.stage();
  const without_decoder = `delete globalThis.VideoDecoder; (${keep_what_is_drawn})()`;
  const watcher = await fixture.open(kDesktop, `#watch=${session}`, without_decoder);
  await watcher.more_frames(1);
  await viewer.final_picture();
  assert.equal(await codec(viewer), "jpeg");
  await viewer.page.evaluate(() => { globalThis.drawn.video = []; });
  await viewer.until("video", async () => {
    await nudge(viewer);
    return (await drawn(viewer)).video.length;
  }, (count) => count >= 3);
  await viewer.all_answered();
  const { file: files, video: none } = await drawn(watcher);
  assert.equal(none.length, 0);
  const [key, ...moved] = (await drawn(viewer)).video;
  const nearest = (picture) => [...files].sort((a, b) => difference(picture, a) - difference(picture, b))[0];
  assert.ok(difference(key, nearest(key)) < 1.5, `pictures differ by ${difference(key, nearest(key))}`);
  // Without a GPU Chromium multiplies Cb by 2 where BT.709 has 2.11: blue is 5 of 100 nearer to grey there.
  const most = [4, 4, 10];
  const off = key.map((value, i) => Math.abs(value - nearest(key)[i]));
  assert.ok(off.every((value, i) => value < most[i % 3]), `a colour is off by ${Math.max(...off)}`);
  for (const picture of moved) assert.ok(difference(picture, nearest(picture)) < 3);
  await watcher.context.close();
});

test("a scene that plays is video, in every size of the window", async () => {
  const playing = await fixture.open(kLaptop, "#scene=helicopters");
  await playing.until("video", () => codec(playing), (name) => name === "h264");
  await playing.more_frames(5);
  assert.equal(await codec(playing), "h264");
  await playing.page.$eval("#section-stats", (element) => { element.open = true; element.scrollIntoView(); });
  await playing.until("the figures", () => playing.page.textContent(".facts"), (text) => /H\.264/.test(text));
  await fixture.keep("video", playing.page);
  await playing.page.setViewportSize({ width: 700, height: 720 });
  await playing.until("a picture of the window's shape", () => playing.page.$eval("#picture", (canvas) => {
    const { width, height } = canvas.parentElement.getBoundingClientRect();
    return canvas.width / canvas.height - width / height;
  }), (difference) => Math.abs(difference) < 0.03);
  await playing.more_frames(5);
  await playing.until("video", () => codec(playing), (name) => name === "h264");
  assert.deepEqual(playing.errors, []);
  await playing.context.close();
});

const troubles = {
  "a decoder that is silent": () => { VideoDecoder.prototype.decode = () => {}; },
  "a decoder that fails": () => {
    VideoDecoder.prototype.decode = () => { throw new DOMException("the test's own", "EncodingError"); };
  },
};
for (const [trouble, script] of Object.entries(troubles)) {
  test(`${trouble} is given up for JPEG, with the reason`, async () => {
    const other = await fixture.open(kLaptop, "#scene=helicopters", script);
    const words = await other.until("a word about it", () => other.page.textContent("#toasts"), (text) => /JPEG/.test(text));
    assert.match(words, /silent|the test's own/);
    await other.until("a JPEG", () => codec(other), (name) => name === "jpeg");
    await other.more_frames(5);
    assert.equal(await codec(other), "jpeg");
    await other.context.close();
  });
}

test("a browser without a decoder has JPEG from the first picture on", async () => {
  const other = await fixture.open(kLaptop, "#scene=helicopters", () => { delete globalThis.VideoDecoder; });
  await other.more_frames(5);
  assert.equal(await codec(other), "jpeg");
  assert.deepEqual(other.errors, []);
  await other.context.close();
});
