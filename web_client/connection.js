// One session on the server and the stream into it. Keeps itself alive: when the stream ends it comes back to the same
// session, or makes a new one like it when the server no longer has it, waiting longer after each failure.
import { close_code, decode_frame, hello, parse_message, ping, ProtocolError, subprotocol } from "./protocol.js";
import { Problem, problem_from } from "./problem.js";

const kFirstWaitMs = 250;
const kLongestWaitMs = 8000;
const kWelcomeWithinMs = 15000;
const kPingEveryMs = 2000;
const kSilenceMs = 8000;  // no word from the server for so long: the line is dead although nobody closed it
const kOwnSleepMs = 2 * kPingEveryMs;  // a pulse as late as this: it was the page that slept, and the line may be well

/**
 * What the connection asks of its owner, and tells it.
 * @typedef {object} ConnectionOwner
 * @property {() => Promise<object>} session_request the body of POST /v1/sessions, as things are now
 * @property {() => object} hello members of `hello` besides `resume`
 * @property {(state: 'connecting'|'open'|'waiting'|'stopped', detail: {wait_ms?: number, reason?: string}) => void}
 *   on_state
 * @property {(message: object, is_new_session: boolean) => void} on_welcome
 * @property {(message: object) => void} on_message every other text message
 * @property {(frame: object) => void} on_frame
 * @property {(problem: Problem) => boolean} on_refused the session was refused; true: ask again (session_request
 *   changed)
 */

export class Connection {
  /**
   * @param {URL} base the folder the viewer is served from @param {import("./access.js").Access} access
   * @param {ConnectionOwner} owner @param {string=} watched the session to watch: no other is made in its place
   */
  constructor(base, access, owner, watched = undefined) {
    this.base = base;
    this.access = access;
    this.owner = owner;
    this.watched = watched;
    this.session = null;
    this.resume = null;
    this.socket = null;
    this.failures = 0;
    this.retry_timer = 0;
    this.round_trip_ms = null;
    this.is_open = false;
    this.is_paused = false;
    this.is_stopped = false;  // gave up; only the user connects again
    this.connecting = false;
  }

  /** Connects, or tries again at once if it was waiting to. */
  async connect() {
    clearTimeout(this.retry_timer);
    if (this.socket || this.connecting) return;
    this.connecting = true;
    this.is_stopped = false;
    this.owner.on_state("connecting", {});
    try {
      const is_new = await this.ensure_session();
      this.open_stream(is_new);
    } catch (error) {
      if (error instanceof Problem && error.status < 500 && error.status !== 429) {
        if (!this.owner.on_refused(error)) return this.stop(error.message);
      }
      this.wait_and_retry(error.retry_after_s);
    } finally {
      this.connecting = false;
    }
  }

  /** Sends a built message if the stream is open. @param {string} text @returns {boolean} whether it was sent */
  send(text) {
    if (!this.is_open) return false;
    this.socket.send(text);
    return true;
  }

  /** While paused (nobody looks) silence is expected, and a stream that ends is not opened again before the pause does. */
  set_paused(is_paused) {
    this.is_paused = is_paused;
    this.heard_ms = performance.now();
    if (!is_paused && !this.socket && !this.is_stopped) this.connect();
  }

  /** Gives the session back, from a page that is being closed. */
  end_session() {
    if (!this.session || this.watched) return;
    const request = { method: "DELETE", keepalive: true, headers: this.access.headers() };
    fetch(new URL(`v1/sessions/${this.session}`, this.base), request).catch(() => {});
  }

  /** True if a new session was made, false if the old one is still there. */
  async ensure_session() {
    this.session ??= this.watched ?? null;
    if (this.session) {
      const request = { cache: "no-store", headers: this.access.headers() };
      const response = await fetch(new URL(`v1/sessions/${this.session}`, this.base), request);
      if (response.ok) return false;
      if (this.watched || (response.status !== 404 && response.status !== 410)) throw await problem_from(response);
      this.session = null;
      this.resume = null;
    }
    const response = await fetch(new URL("v1/sessions", this.base), {
      method: "POST",
      headers: { "content-type": "application/json", ...this.access.headers() },
      body: JSON.stringify(await this.owner.session_request()),
    });
    if (!response.ok) throw await problem_from(response);
    this.session = (await response.json()).id;
    return true;
  }

  open_stream(is_new) {
    const address = new URL(`v1/sessions/${this.session}/stream`, this.base);
    address.protocol = address.protocol.replace("http", "ws");
    const socket = new WebSocket(address, this.access.subprotocols(subprotocol));
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    this.farewell = null;
    this.heard_ms = performance.now();
    this.welcome_timer = setTimeout(() => this.drop(socket), kWelcomeWithinMs);
    this.pulse_ms = this.heard_ms;
    const pulse = setInterval(() => this.check_pulse(socket), kPingEveryMs);
    socket.onopen = () => socket.send(hello({ ...this.owner.hello(), resume: this.resume }));
    socket.onmessage = ({ data }) => {
      if (this.socket === socket) this.heard(data, is_new);
    };
    socket.onclose = ({ code, reason }) => {
      clearInterval(pulse);
      if (this.socket === socket) this.closed(code, reason);
    };
  }

  heard(data, is_new) {
    this.heard_ms = performance.now();
    try {
      if (typeof data !== "string") return this.owner.on_frame(decode_frame(data));
      const message = parse_message(data);
      if (message.type === "welcome") this.welcomed(message, is_new);
      else if (message.type === "pong") this.round_trip_ms = this.heard_ms - message.t;
      else if (message.type === "bye") this.farewell = message;
      else this.owner.on_message(message);
    } catch (error) {
      if (!(error instanceof ProtocolError)) throw error;
      if (error.pointer !== "/type") console.warn(`not understood: ${error.message}`);  // else a newer server's word
    }
  }

  welcomed(message, is_new) {
    clearTimeout(this.welcome_timer);
    this.failures = 0;
    this.is_open = true;
    this.session = message.session;
    this.resume = message.resume;
    this.owner.on_welcome(message, is_new);
    this.owner.on_state("open", {});
  }

  closed(code, reason) {
    clearTimeout(this.welcome_timer);
    this.socket = null;
    this.is_open = false;
    this.round_trip_ms = null;
    const words = this.farewell?.reason || reason;
    if (code === close_code.not_allowed || this.farewell?.reconnect === false) {
      this.stop(words || "The server ended the session.");
    } else {
      if (code === close_code.session_ended) this.session = this.resume = null;
      this.wait_and_retry();
    }
  }

  stop(reason) {
    this.is_stopped = true;
    this.owner.on_state("stopped", { reason });
  }

  wait_and_retry(at_least_s = 0) {
    if (this.is_paused) return this.owner.on_state("waiting", { wait_ms: 0 });  // until someone looks
    const longest = Math.min(kFirstWaitMs * 2 ** this.failures, kLongestWaitMs);
    const wait_ms = Math.max(longest * (0.75 + 0.5 * Math.random()), at_least_s * 1000);
    this.failures += 1;
    this.owner.on_state("waiting", { wait_ms });
    this.retry_timer = setTimeout(() => this.connect(), wait_ms);
  }

  check_pulse(socket) {
    const now_ms = performance.now();
    if (now_ms - this.pulse_ms > kOwnSleepMs) this.heard_ms = now_ms;
    this.pulse_ms = now_ms;
    if (!this.is_open || this.is_paused) return;
    if (now_ms - this.heard_ms > kSilenceMs) this.drop(socket);
    else this.send(ping(now_ms));
  }

  /** Gives a socket up without waiting for the other side's farewell, which on a dead line never comes. */
  drop(socket) {
    socket.close();
    if (this.socket === socket) this.closed(1006, "");
  }
}
