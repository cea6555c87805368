// What the user wants, on its way to the server: at most one message per animation frame, the newest value of each
// thing in it, numbered so that a frame can say which it answers.

const kRemembered = 256;  // messages whose answer is awaited

/** Two partial inputs as one: later members replace earlier ones, settings join, edits of one path keep the last. */
export function merge_inputs(earlier, later) {
  const merged = { ...earlier, ...later };
  if (earlier.settings && later.settings) merged.settings = { ...earlier.settings, ...later.settings };
  if (earlier.edits && later.edits) {
    const replaced = new Set(later.edits.map((edit) => edit.path));
    merged.edits = [...earlier.edits.filter((edit) => !replaced.has(edit.path)), ...later.edits];
  }
  return merged;
}

export class Inputs {
  /**
   * @param {(seq: number, change: object) => boolean} send sends one input message; false if there is no connection now
   * @param {(callback: Function) => void} next_frame requestAnimationFrame, or a test's
   */
  constructor(send, next_frame = (callback) => requestAnimationFrame(callback)) {
    this.send = send;
    this.next_frame = next_frame;
    this.last_seq = 0;
    this.last_seq_with = {};  // member -> the last number it was sent under
    this.pending = null;
    this.scheduled = false;
    this.awaited = [];        // {seq, at_ms}, ascending
  }

  /**
   * Adds to the next message.
   * @param {object} input any of camera, edits, settings, playing, time_s, scene, width, height
   * @param {number=} at_ms when the user did it (performance.now's clock); latency counts from here
   */
  push(input, at_ms = performance.now()) {
    this.pending = this.pending
      ? { input: merge_inputs(this.pending.input, input), at_ms: this.pending.at_ms }
      : { input, at_ms };
    if (this.scheduled) return;
    this.scheduled = true;
    this.next_frame(() => {
      this.scheduled = false;
      this.flush();
    });
  }

  /** Sends what waits. Without a connection it goes on waiting; call again when there is one. */
  flush() {
    if (!this.pending) return;
    const { input, at_ms } = this.pending;
    const seq = this.last_seq + 1;
    if (!this.send(seq, input)) return;
    this.pending = null;
    this.last_seq = seq;
    for (const member of Object.keys(input)) this.last_seq_with[member] = seq;
    this.awaited.push({ seq, at_ms });
    if (this.awaited.length > kRemembered) this.awaited.shift();
  }

  /** True if `member` was sent later than the input `seq`, or waits to be: the server's word on it is out of date. */
  is_newer_than(seq, member) {
    return (this.last_seq_with[member] ?? 0) > (seq ?? this.last_seq) || member in (this.pending?.input ?? {});
  }

  /**
   * A frame that answers input `seq` is on the screen.
   * @returns {number | null} milliseconds since that input was made; null if it was answered before
   */
  answered(seq, now_ms = performance.now()) {
    const input = this.awaited.find((entry) => entry.seq === seq);
    this.awaited = this.awaited.filter((entry) => entry.seq > seq);
    return input ? now_ms - input.at_ms : null;
  }

  /** True if something was asked for that no frame has answered. */
  has_unanswered() {
    return this.awaited.length > 0 || this.pending !== null;
  }

  /** A new session counts from 1 again; what was not answered never will be. */
  restart() {
    this.last_seq = 0;
    this.last_seq_with = {};
    this.awaited = [];
  }
}
