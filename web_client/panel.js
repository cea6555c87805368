// The side panel: its sections, and a control for each of the renderer's settings.
import { make, make_choice, make_icon, make_slider, make_toggle } from "./controls.js";
import { kPictureSizes } from "./picture_size.js";
import { scene_title } from "./session_model.js";
import { method_name, short_number } from "./stats.js";

const kSamples = [1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096];
const kFireflyClamps = [0, 5, 10, 20, 50, 100, 200, 500, 1000];
const kFrameRates = [0, 5, 10, 15, 20, 24, 30, 60, 120, 240];
const kIndirectSizes = [32, 48, 64, 96, 128, 192, 256, 384, 512, 768, 1024];
const kShadowSizes = [128, 256, 512, 1024, 2048, 4096];
const kViews = [
  ["final", "Final picture"], ["direct", "Direct light"], ["indirect", "Indirect light"], ["albedo", "Albedo"],
  ["normal", "Normals"], ["depth", "Depth"], ["position", "Position"], ["normal-depth", "Normal and depth"],
  ["occlusion-distance", "Mean distance of hits"], ["bounce", "One bounce"], ["direction", "One direction"],
  ["hit-distance", "Its distance to the hit"], ["candidates", "Its candidates"], ["patch", "Patches and seeds"],
  ["reference-map", "Reference map"], ["unmatched", "Unmatched pixels"],
  ["history", "Frames in the history"], ["variance", "Variance"], ["gradient", "Change of light"],
  ["motion", "Motion"], ["cache-cells", "Cells of the cache"],
];
const kRealtimeViews = ["history", "variance", "gradient", "motion", "cache-cells"];
const kDirectionViews = ["direction", "hit-distance", "candidates"];
const kPatches = [1, 2, 4, 8, 16];
const kTriangleGroups = [1, 2, 4, 8, 16, 32, 64];
const kOwnCamera = "own";
// The last step of the bounces' slider stands for "inf", which the methods realtime and reference know.
const kMostBounces = 8, kEndless = kMostBounces + 1;
const kExposure = { min: -16, max: 16, step: 0.1 };

export class Panel {
  /**
   * @param {HTMLElement} element @param {object} model a SessionModel
   * @param {object} owner `push(input, at_ms)`, `open_scene(name)`, `choose_file()`, `use_camera(index)`,
   *   `picture_size()` and `set_picture_size(choice)`, `exposure_ev()`: what is applied at present
   */
  constructor(element, model, owner) {
    this.model = model;
    this.owner = owner;
    this.shows = [];
    const section = (id, title, open, ...rows) => {
      const body = make("div", { class: "section-body" }, ...rows);
      const details = make("details", { id: `section-${id}`, open: stored(id) ?? open },
        make("summary", {}, make("h2", { textContent: title })), body);
      details.addEventListener("toggle", () => store(id, details.open));
      element.append(details);
      return body;
    };
    section("scene", "Scene", true, ...this.scene_rows());
    section("picture", "Picture", true, ...this.picture_rows());
    section("light", "Light transport", true, ...this.transport_rows());
    this.lights_place = section("lights", "Lights", true);
    this.stats_place = section("stats", "Performance", true);
    section("advanced", "Advanced", false, ...this.advanced_rows());
    model.subscribe((changed) => this.shows.forEach((show) => show(changed)));
  }

  /** Keeps a control at what the model says whenever one of `members` changes. */
  keep(members, show) {
    this.shows.push((changed) => members.some((member) => changed.has(member)) && show(this.model));
  }

  /** A control bound to one of the renderer's settings. */
  setting(name, make_control, options) {
    const tell = (value, at_ms) => {
      // Bounces are counted from 1, directions from 0, and another view may have fewer.
      const first = name === "view" ? { view_index: value === "bounce" ? 1 : 0 } : {};
      this.owner.push({ settings: { [name]: value, ...first } }, at_ms);
    };
    const control = make_control({ ...options, on_input: tell, on_change: tell });
    this.keep(["settings"], (model) => name in model.settings && control.set(model.settings[name]));
    return control;
  }

  scene_rows() {
    const { owner } = this;
    const scene = make_choice({ label: "Scene", options: [], on_change: (name) => owner.open_scene(name) });
    const facts = make("p", { class: "hint" });
    this.keep(["scenes", "scene"], (model) => {
      scene.offer(model.scenes.map((entry) => [entry.name, scene_title(entry.name)]));
      scene.set(model.scene);
      facts.textContent = facts_of(model.scene_entry());
    });
    const camera = make_choice({
      label: "Camera", options: [], on_change: (value) => value !== kOwnCamera && owner.use_camera(Number(value)),
    });
    this.keep(["scenes", "scene", "camera"], (model) => {
      const { cameras } = model.scene_entry();
      const named = cameras.map((name, index) => [String(index), name || `Camera ${index + 1}`]);
      const follows = model.follows_scene_camera();
      camera.offer(follows ? named : [...named, [kOwnCamera, "Your own"]]);
      camera.set(follows ? String(model.camera?.index ?? 0) : kOwnCamera);
      camera.row.hidden = cameras.length < 2;
    });
    const open = make_wide_button(make_icon("open"), "Open a .glb file");
    open.addEventListener("click", () => owner.choose_file());
    return [scene.row, facts, camera.row, open];
  }

  picture_rows() {
    const { owner } = this;
    const view = this.setting("view", make_choice, { label: "Show", options: kViews });
    const view_index = this.setting("view_index", make_slider, { label: "Which", min: 0, max: 4095, step: 1 });
    this.keep(["settings"], ({ settings }) => {
      const is_bounce = settings.view === "bounce";
      view_index.row.hidden = !is_bounce && !kDirectionViews.includes(settings.view);
      view_index.limit(is_bounce ? Math.min(64, Number(settings.bounces) || 64) : settings.samples - 1);
      view_index.set(settings.view_index);
    });
    const size = make_choice({
      label: "Size", options: kPictureSizes, hint: "Pixels the server renders; the picture is scaled to the window",
      on_change: (choice) => owner.set_picture_size(choice),
    });
    size.set(owner.picture_size());
    const automatic = make_toggle({
      label: "Automatic exposure",
      on_change: (on) => owner.push({ settings: { exposure_ev: on ? null : Number(owner.exposure_ev().toFixed(1)) } }),
    });
    const exposure = make_slider({
      label: "Exposure", ...kExposure, format: (ev) => `${ev > 0 ? "+" : ""}${Number(ev).toFixed(1)} EV`,
      on_input: (ev, at_ms) => owner.push({ settings: { exposure_ev: ev } }, at_ms),
    });
    this.show_exposure = () => exposure.set(this.model.settings.exposure_ev ?? owner.exposure_ev());
    this.keep(["settings"], ({ settings }) => {
      const is_automatic = (settings.exposure_ev ?? null) === null;
      automatic.set(is_automatic);
      exposure.enable(!is_automatic);
      this.show_exposure();
    });
    const tone = this.setting("tone_map", make_choice, {
      label: "Tone curve", options: [["neutral", "Neutral"], ["linear", "Linear"]],
    });
    return [view.row, view_index.row, size.row, automatic.row, exposure.row, tone.row];
  }

  transport_rows() {
    const method = make_choice({
      label: "Method", options: [],
      on_change: (name) => this.owner.push({ settings: this.settings_for_method(name) }),
    });
    this.keep(["settings"], (model) => method.set(model.settings.method));
    this.keep(["methods"], (model) => method.offer(model.methods.map((name) => [name, method_name(name)])));
    const samples = this.setting("samples", make_slider, {
      label: "Samples", values: kSamples, hint: "Directions for each pixel of the indirect map",
    });
    this.keep(["limits"], (model) => samples.limit(model.limits.max_samples));
    const indirect_size = this.setting("indirect_size", make_slider, {
      label: "Indirect map", values: kIndirectSizes, format: (value) => `${value} px`,
      hint: "Longer side of the map that indirect light is computed on",
    });
    const bounces = this.bounces_slider();
    const denoise = this.setting("denoise", make_toggle, {
      label: "Denoise", hint: "Smooths the indirect map without crossing edges",
    });
    const multiple_scattering = this.setting("multiple_scattering", make_toggle, {
      label: "Multiple scattering", hint: "Keeps the light that bounces between the microfacets of rough surfaces",
    });
    const temporal_antialiasing = this.setting("temporal_antialiasing", make_toggle, {
      label: "Temporal anti-aliasing", hint: "Edges smooth over the frames, along with what moves",
    });
    const firefly_clamp = this.setting("firefly_clamp", make_slider, {
      label: "Firefly clamp", values: kFireflyClamps, format: (value) => (value > 0 ? `${value} × mean` : "Off"),
      hint: "The most that one sample may bring of bounced light. Takes light away: the figures tell how much",
    });
    const hand_over = this.setting("hand_over", make_toggle, {
      label: "Reference when still", hint: "A picture that has stood still for a while goes over into the reference's",
    });
    const target_fps = this.setting("target_fps", make_slider, {
      label: "Frame rate", values: kFrameRates, format: (value) => (value > 0 ? `${value}/s` : "Any"),
      hint: "Samples and the indirect map become fewer and smaller where frames would take longer than for this rate",
    });
    this.keep(["settings"], ({ settings }) => {
      for (const { row } of [temporal_antialiasing, firefly_clamp, target_fps]) row.hidden = settings.method !== "realtime";
      denoise.row.hidden = settings.method !== "thesis";  // realtime always does, reference never
      hand_over.row.hidden = settings.method === "reference";
    });
    return [
      method.row, samples.row, indirect_size.row, bounces.row, denoise.row, multiple_scattering.row,
      temporal_antialiasing.row, firefly_clamp.row, target_fps.row, hand_over.row,
    ];
  }

  /** What a choice of the method changes: bounces and views that it does not know go with the old one. */
  settings_for_method(method) {
    const settings = this.model.settings;
    const change = { method };
    if (settings.bounces === "inf" && method === "thesis") change.bounces = kMostBounces;
    if (kRealtimeViews.includes(settings.view) && method !== "realtime") change.view = "final";
    return change;
  }

  bounces_slider() {
    const names = { 0: "None", [kEndless]: "No limit" };
    const tell = (step, at_ms) =>
      this.owner.push({ settings: { bounces: step === kEndless ? "inf" : step } }, at_ms);
    const slider = make_slider({
      label: "Bounces", min: 0, max: kEndless, step: 1, format: (step) => names[step] ?? String(step), on_input: tell,
    });
    this.keep(["settings"], ({ settings }) => {
      slider.limit(settings.method === "thesis" ? kMostBounces : kEndless);
      slider.set(settings.bounces === "inf" ? kEndless : settings.bounces);
    });
    return slider;
  }

  advanced_rows() {
    const estimator = this.setting("estimator", make_choice, {
      label: "Estimator", options: [["corrected", "Corrected"], ["literal", "Literal"]],
      hint: "Literal follows the published formula to the letter",
    });
    const patch = this.setting("patch", make_slider, {
      label: "Patch", values: kPatches, format: (value) => (Number(value) === 1 ? "Off" : `${value} × ${value}`),
      hint: "Pixels of the indirect map that share directions and candidates",
    });
    const triangle_groups = this.setting("triangle_groups", make_slider, {
      label: "Triangle groups", values: kTriangleGroups, hint: "The nearest triangle of each is a patch's candidate",
    });
    const normal_threshold = this.setting("normal_threshold", make_slider, {
      label: "Normals agree", min: 0, max: 1, step: 0.01, format: (cosine) => `≥ ${Number(cosine).toFixed(2)}`,
      hint: "Least cosine between the normals of similar pixels",
    });
    const depth_threshold = this.setting("depth_threshold", make_slider, {
      label: "Depths agree", min: 0, max: 0.5, step: 0.01, format: (share) => `${Math.round(100 * share)} %`,
      hint: "Greatest difference between the depths of similar pixels",
    });
    const similarity = this.setting("similarity", make_choice, {
      label: "Similarity", options: [["corrected", "Corrected"], ["literal", "Literal"]],
      hint: "Literal asks for depths that differ, as the formula is printed",
    });
    const trace_missed = this.setting("trace_missed", make_toggle, {
      label: "Trace missed rays", hint: "Where no candidate of the patch lies before a pixel, its ray is traced",
    });
    const brute_force = this.setting("brute_force", make_toggle, {
      label: "Brute force", hint: "Thesis: rays try every triangle. Refused where that would take seconds",
    });
    const shadow_size = this.setting("shadow_size", make_slider, {
      label: "Shadow map", values: kShadowSizes, format: (value) => `${value} px`,
    });
    const shadow_filter = this.setting("shadow_filter", make_slider, {
      label: "Shadow filter", min: 1, max: 15, step: 2, format: (value) => `${value} px`,
    });
    const reset = make_wide_button("Reset all settings");
    reset.addEventListener("click", () => this.owner.push({ settings: this.model.default_settings ?? {} }));
    return [estimator.row, patch.row, triangle_groups.row, normal_threshold.row, depth_threshold.row, similarity.row,
      trace_missed.row, brute_force.row, shadow_size.row, shadow_filter.row, reset];
  }
}

const make_wide_button = (...content) => make("button", { type: "button", class: "text-button is-wide" }, ...content);

function facts_of(entry) {
  const facts = [`${short_number(entry.triangles ?? 0)} triangles`];
  facts.push(entry.duration_s > 0 ? `${Number(entry.duration_s.toFixed(1))} s` : "still");
  return facts.join(" · ");
}

function stored(id) {
  const text = localStorage.getItem(`lightwell.open.${id}`);
  return text === null ? undefined : text === "true";
}

const store = (id, open) => localStorage.setItem(`lightwell.open.${id}`, String(open));
