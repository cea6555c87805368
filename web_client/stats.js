// What is going on, in figures: frame rate, the time from input to picture and what it is made of, the renderer's
// stages.
import { make } from "./controls.js";

const kRateWindowMs = 1000;
const kSmooth = 0.25;  // share of a new value in a figure that would flicker otherwise
const kParts = [
  ["render", "Render"], ["encode", "Encode"], ["network", "Network and waiting"], ["show", "Decode and show"],
];
const kCodecNames = { jpeg: "JPEG", png: "PNG", h264: "H.264" };
const kFacts = ["Method", "Rays", "Triangles", "Picture", "Received", "Exposure", "Clamped light", "Device"];

/** 1234567 as "1.23M", 1522 as "1,522". */
export function short_number(value) {
  if (!(value >= 1e5)) return Math.round(value || 0).toLocaleString("en");
  const [unit, size] = value >= 1e9 ? ["G", 1e9] : value >= 1e6 ? ["M", 1e6] : ["k", 1e3];
  return `${(value / size).toPrecision(3)}${unit}`;
}

/** Milliseconds with as many digits as matter. */
export const short_ms = (ms) => (ms < 9.95 ? ms.toFixed(1) : String(Math.round(ms)));

/** Leaves an element alone that says so already, so that what a user has selected in it stays selected. */
function write(element, text) {
  if (element.textContent !== String(text)) element.textContent = text;
}

const kMethodNames = { thesis: "Thesis", realtime: "Realtime", reference: "Reference" };

/** A method's name for people; that of the protocol where there is none. */
export const method_name = (method) => kMethodNames[method] ?? method;

const picture_fact = ({ width, height, codec }) => `${width} × ${height}, ${kCodecNames[codec]}`;

/** Of the indirect light, what the firefly clamp has taken away. */
function clamped_fact(settings, server) {
  const clamps = settings?.firefly_clamp > 0 && server?.method === "realtime";
  return clamps ? `${(100 * server.clamped_share).toPrecision(2)} %` : "–";
}

export class Stats {
  /** @param {object} model a SessionModel @param {HTMLElement} section the panel's place for it */
  constructor(model, section) {
    this.model = model;
    this.shown_at_ms = [];
    this.bytes = [];
    this.latency_ms = null;
    this.parts_ms = { render: 0, encode: 0, network: 0, show: 0 };
    this.server = null;
    this.frame = null;
    this.build(section);
    setInterval(() => this.show(), 250);
  }

  build(section) {
    const figure = (words) => make("span", {}, make("b"), ` ${words}`);
    this.headline = make("p", { class: "figures" }, figure("fps"), figure("ms to picture"));
    this.bar = make("div", { class: "parts-bar" }, ...kParts.map(([part]) => make("i", { class: `part is-${part}` })));
    this.legend = make("ul", { class: "legend" }, ...kParts.map(([part, label]) =>
      make("li", { class: `is-${part}` }, make("span", { textContent: label }), make("output"))));
    this.stages = make("ul", { class: "stages", ariaLabel: "Time of each stage" });
    const facts = kFacts.flatMap((name) => [make("dt", { textContent: name }), make("dd")]);
    this.facts = make("dl", { class: "facts" }, ...facts);
    const title = make("h3", { textContent: "Stages of a frame" });
    section.append(this.headline, this.bar, this.legend, title, this.stages, this.facts);
  }

  /** Takes the server's `stats`. */
  server_says(message) {
    this.server = message;
  }

  /** A new connection: what was counted before says nothing now. */
  restart() {
    this.shown_at_ms = [];
    this.bytes = [];
    this.latency_ms = null;
    this.server = null;
    this.frame = null;
  }

  /**
   * A frame is on the screen.
   * @param {object} frame @param {object} times its times on this machine @param {number | null} latency_ms since the
   *   input
   *   it is the first to answer
   */
  frame_shown(frame, times, latency_ms) {
    this.frame = frame;
    this.shown_at_ms.push(times.shown_ms);
    this.bytes.push({ at_ms: times.received_ms, size: frame.payload.byteLength });
    if (latency_ms === null) return;
    if (this.server) {  // a refinement that this input has ended
      this.server = { ...this.server, accumulated: 1, method: this.model.settings?.method ?? this.server.method };
    }
    const render = frame.header.render_ms;
    const encode = this.server?.encode_ms ?? 0;
    const show = times.shown_ms - times.received_ms;
    const parts = { render, encode, network: Math.max(latency_ms - render - encode - show, 0), show };
    const share = this.latency_ms === null ? 1 : kSmooth;
    for (const part in parts) this.parts_ms[part] += (parts[part] - this.parts_ms[part]) * share;
    this.latency_ms = (this.latency_ms ?? latency_ms) * (1 - share) + latency_ms * share;
  }

  /** Frames shown in the last second. */
  frame_rate() {
    const since_ms = performance.now() - kRateWindowMs;
    this.shown_at_ms = this.shown_at_ms.filter((at_ms) => at_ms > since_ms);
    this.bytes = this.bytes.filter((entry) => entry.at_ms > since_ms);
    const count = this.shown_at_ms.length;
    if (count < 2) return count;
    const span_ms = this.shown_at_ms[count - 1] - this.shown_at_ms[0];
    return span_ms > 0 ? ((count - 1) * 1000) / span_ms : count;
  }

  /** The status line's words while connected. */
  summary() {
    if (!this.frame) return "Waiting for the first picture";
    const frames = this.server?.accumulated ?? 1;
    const by = this.server ? ` by ${method_name(this.server.method).toLowerCase()}` : "";
    if (this.frame.header.is_final) return frames > 1 ? `Final${by}, ${frames} samples` : "Final";
    if (frames > 1) return `Refining${by}, ${frames} samples`;
    const latency = this.latency_ms === null ? "" : ` · ${short_ms(this.latency_ms)} ms`;
    return `${Math.round(this.frame_rate())} fps${latency}`;
  }

  show() {
    if (this.headline.closest("details")?.open === false || this.headline.offsetParent === null) return;
    const rate = this.frame_rate();
    const latency = this.latency_ms === null ? "–" : short_ms(this.latency_ms);
    write(this.headline.children[0].firstChild, Math.round(rate));
    write(this.headline.children[1].firstChild, latency);
    const total = Object.values(this.parts_ms).reduce((sum, ms) => sum + ms, 0) || 1;
    kParts.forEach(([part], i) => {
      this.bar.children[i].style.width = `${(100 * this.parts_ms[part]) / total}%`;
      write(this.legend.children[i].lastChild, `${short_ms(this.parts_ms[part])} ms`);
    });
    this.show_stages();
    this.show_facts(rate);
  }

  show_stages() {
    const stages = this.server?.stages ?? [];
    const longest = Math.max(...stages.map((stage) => stage.ms), 1e-6);
    while (this.stages.children.length > stages.length) this.stages.lastChild.remove();
    stages.forEach((stage, i) => {
      const row = this.stages.children[i] ?? this.stages.appendChild(
        make("li", {}, make("span"), make("i", { class: "bar" }), make("output")));
      write(row.children[0], stage.name);
      row.children[1].style.setProperty("--share", stage.ms / longest);
      write(row.children[2], `${short_ms(stage.ms)} ms`);
    });
  }

  show_facts(rate) {
    const rays = this.server?.rays ?? 0;
    const received = this.bytes.reduce((sum, entry) => sum + entry.size, 0);
    const facts = [
      this.server ? method_name(this.server.method) : "–",
      `${short_number(rays)} / frame · ${short_number(rays * rate)} / s`,
      short_number(this.server?.triangles ?? this.model.scene_entry().triangles ?? 0),
      this.frame ? picture_fact(this.frame.header) : "–",
      `${((received * 8) / 1e6).toFixed(1)} Mbit/s`,
      this.server ? `${this.server.exposure_ev.toFixed(1)} EV` : "–",
      clamped_fact(this.model.settings, this.server),
      this.model.device || "–",
    ];
    this.facts.querySelectorAll("dd").forEach((place, i) => write(place, facts[i]));
  }
}
