// Frames of video to pictures, by the browser's WebCodecs. A frame is decoded after the one before it; none is left out.

const kSilenceMs = 2000;  // a decoder that says nothing for so long will not speak again
const kTried = { codec: "avc1.42C01F", codedWidth: 1280, codedHeight: 720, optimizeForLatency: true };

/** Whether this browser, on this page (a secure one: others have no decoder), takes the video that servers send. */
export async function can_decode_video() {
  if (typeof VideoDecoder === "undefined") return false;
  return VideoDecoder.isConfigSupported(kTried).then(({ supported }) => supported, () => false);
}

/**
 * The codec's name as a key's parameter sets give it: avc1 and the profile, constraints and level.
 * @param {Uint8Array} bytes of Annex B
 */
export function codec_name(bytes) {
  for (let i = 0; i + 6 < bytes.length; ++i) {
    if (bytes[i] !== 0 || bytes[i + 1] !== 0 || bytes[i + 2] !== 1 || (bytes[i + 3] & 31) !== 7) continue;
    const digits = [...bytes.subarray(i + 4, i + 7)].map((byte) => byte.toString(16).padStart(2, "0"));
    return `avc1.${digits.join("").toUpperCase()}`;
  }
  throw new Error("a key without parameter sets");
}

export class VideoPictures {
  constructor() {
    this.decoder = null;
    this.configured = "";
    this.awaited = new Map();  // frame id -> {resolve, reject, timer}
  }

  /**
   * @param {object} frame as decode_frame gives it
   * @returns {Promise<VideoFrame | null>} to be closed; null if the stream ended before
   */
  decode({ header, payload }) {
    return new Promise((resolve, reject) => {
      const timer = setTimeout(() => this.fail(new Error("the decoder is silent")), kSilenceMs);
      this.awaited.set(header.frame, { resolve, reject, timer });
      try {
        if (header.is_key) this.configure(header, payload);
        if (!this.decoder) throw new Error("video begins without a key");
        const type = header.is_key ? "key" : "delta";
        this.decoder.decode(new EncodedVideoChunk({ type, timestamp: header.frame, data: payload }));
      } catch (error) {
        this.fail(error);
      }
    });
  }

  /** The stream has ended: what waits is not wanted any more. */
  close() {
    this.give_up(({ resolve }) => resolve(null));
  }

  configure({ width, height }, payload) {
    const codec = codec_name(payload);
    const wanted = `${codec} ${width} ${height}`;
    if (this.decoder && wanted === this.configured) return;
    this.decoder ??= new VideoDecoder({
      output: (picture) => this.decoded(picture),
      error: (error) => this.fail(error),
    });
    this.decoder.configure({ codec, codedWidth: width, codedHeight: height, optimizeForLatency: true });
    this.configured = wanted;
  }

  decoded(picture) {
    const awaited = this.awaited.get(picture.timestamp);
    if (!awaited) return picture.close();
    clearTimeout(awaited.timer);
    this.awaited.delete(picture.timestamp);
    awaited.resolve(picture);
  }

  /** Nothing that waits will come. */
  fail(error) {
    this.give_up(({ reject }) => reject(error));
  }

  give_up(tell) {
    for (const awaited of this.awaited.values()) {
      clearTimeout(awaited.timer);
      tell(awaited);
    }
    this.awaited.clear();
    if (this.decoder && this.decoder.state !== "closed") this.decoder.close();
    this.decoder = null;
  }
}
