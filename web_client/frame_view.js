// Frames onto the canvas: decodes one at a time, of those that wait only the newest, and tells when each was shown.
import { picture_rect, shapes_agree } from "./view_math.js";

const kMimeTypes = { jpeg: "image/jpeg", png: "image/png" };

export class FrameView {
  /**
   * @param {HTMLCanvasElement} canvas lies over the whole of its parent
   * @param {(frame: object, times: {received_ms, decoded_ms?, shown_ms?, queue}) => void} on_done called once for each
   *   frame, in order: with `shown_ms` when it is on the canvas, without when a newer one made it needless
   */
  constructor(canvas, on_done) {
    this.canvas = canvas;
    this.on_done = on_done;
    this.context = canvas.getContext("2d", { alpha: false });
    this.waiting = null;
    this.is_decoding = false;
    this.shown = null;  // the frame on the canvas
  }

  /** Takes a frame as decode_frame gives it. */
  receive(frame) {
    const entry = { frame, received_ms: performance.now() };
    if (this.waiting) this.on_done(this.waiting.frame, { received_ms: this.waiting.received_ms, queue: 0 });
    this.waiting = entry;
    if (!this.is_decoding) this.decode_waiting();
  }

  async decode_waiting() {
    this.is_decoding = true;
    while (this.waiting) {
      const { frame, received_ms } = this.waiting;
      this.waiting = null;
      try {
        const bitmap = await createImageBitmap(new Blob([frame.payload], { type: kMimeTypes[frame.header.codec] }));
        const decoded_ms = performance.now();
        this.draw(bitmap, frame);
        this.on_done(frame, { received_ms, decoded_ms, shown_ms: performance.now(), queue: this.waiting ? 1 : 0 });
      } catch (error) {  // a picture that does not decode must not stop the stream
        console.warn(`frame ${frame.header.frame} does not decode: ${error.message}`);
        this.on_done(frame, { received_ms, queue: 0 });
      }
    }
    this.is_decoding = false;
  }

  draw(bitmap, frame) {
    const { canvas } = this;
    if (canvas.width !== bitmap.width || canvas.height !== bitmap.height) {
      canvas.width = bitmap.width;
      canvas.height = bitmap.height;
      this.fit();
    }
    this.context.drawImage(bitmap, 0, 0);
    bitmap.close();
    this.shown = frame;
  }

  /** Lets the canvas fill its parent if the picture has its shape; call when the parent's size changes. */
  fit() {
    const box = this.canvas.parentElement.getBoundingClientRect();
    const fills = shapes_agree(this.canvas.width / this.canvas.height, box);
    this.canvas.style.objectFit = fills ? "cover" : "contain";
  }

  /** Where the picture lies, in CSS pixels relative to the canvas's parent. */
  rect() {
    const { width, height } = this.canvas.parentElement.getBoundingClientRect();
    const aspect = this.shown ? this.canvas.width / this.canvas.height : width / height;
    return picture_rect(aspect, { x: 0, y: 0, width, height });
  }

  /** The picture as a PNG file; null before the first frame. @returns {Promise<Blob | null>} */
  async png() {
    if (!this.shown) return null;
    return new Promise((resolve) => this.canvas.toBlob(resolve, "image/png"));
  }
}
