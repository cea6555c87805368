// Frames onto the canvas: decodes one at a time, of those that wait only the newest (of video all, for each needs the
// one before it), and tells when each was shown.
import { VideoPictures } from "./video_pictures.js";
import { picture_rect, shapes_agree } from "./view_math.js";

const kMimeTypes = { jpeg: "image/jpeg", png: "image/png" };

export class FrameView {
  /**
   * @param {HTMLCanvasElement} canvas lies over the whole of its parent
   * @param {(frame: object, times: {received_ms, decoded_ms?, shown_ms?, queue}) => void} on_done called once for each
   *   frame of a stream that goes on: with `shown_ms` when it is on the canvas, without when a newer one made it needless
   * @param {(reason: string) => void} on_video_trouble video does not decode here
   */
  constructor(canvas, on_done, on_video_trouble) {
    this.canvas = canvas;
    this.on_done = on_done;
    this.on_video_trouble = on_video_trouble;
    this.context = canvas.getContext("2d", { alpha: false });
    this.stream = null;  // {video, last_drawn}: what belongs to the stream that frames come from
    this.waiting = null;
    this.is_decoding = false;
    this.shown = null;  // the frame on the canvas
    this.restart();
  }

  /** Takes a frame as decode_frame gives it. */
  receive(frame) {
    if (frame.header.codec === "h264") return this.receive_video(frame);
    const entry = { frame, received_ms: performance.now() };
    if (this.waiting) this.on_done(this.waiting.frame, { received_ms: this.waiting.received_ms, queue: 0 });
    this.waiting = entry;
    if (!this.is_decoding) this.decode_waiting();
  }

  /** Another stream: frames count from 1 again, and nothing is told of those of the one before. */
  restart() {
    this.stream?.video.close();
    this.stream = { video: new VideoPictures(), last_drawn: 0 };
    this.waiting = null;
  }

  async receive_video(frame) {
    const { stream } = this;
    const received_ms = performance.now();
    try {
      const picture = await stream.video.decode(frame);
      if (picture) this.decoded(stream, frame, picture, { received_ms, queue: stream.video.awaited.size });
    } catch (error) {
      if (stream !== this.stream) return;
      this.on_done(frame, { received_ms, queue: 0 });
      this.on_video_trouble(error.message || error.name);
    }
  }

  async decode_waiting() {
    this.is_decoding = true;
    while (this.waiting) {
      const { stream } = this;
      const { frame, received_ms } = this.waiting;
      this.waiting = null;
      try {
        const bitmap = await createImageBitmap(new Blob([frame.payload], { type: kMimeTypes[frame.header.codec] }));
        this.decoded(stream, frame, bitmap, { received_ms, queue: this.waiting ? 1 : 0 });
      } catch (error) {  // a picture that does not decode must not stop the stream
        console.warn(`frame ${frame.header.frame} does not decode: ${error.message}`);
        if (stream === this.stream) this.on_done(frame, { received_ms, queue: 0 });
      }
    }
    this.is_decoding = false;
  }

  /** @param {ImageBitmap | VideoFrame} picture closed here @param {object} frame what it was decoded from */
  decoded(stream, frame, picture, times) {
    if (stream === this.stream) {
      times.decoded_ms = performance.now();
      if (frame.header.frame > stream.last_drawn) {  // a file may be quicker than the video before it
        this.draw(picture, frame);
        stream.last_drawn = frame.header.frame;
        times.shown_ms = performance.now();
      }
      this.on_done(frame, times);
    }
    picture.close();
  }

  draw(picture, frame) {
    const { canvas } = this;
    const { width, height } = frame.header;
    if (canvas.width !== width || canvas.height !== height) {
      Object.assign(canvas, { width, height });
      this.fit();
    }
    this.context.drawImage(picture, 0, 0, width, height);
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
