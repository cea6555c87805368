// What the viewer knows of its session: the server's word, with what the user has just asked for laid over it, so that
// a control answers the hand at once and never jumps back to an older truth.

const kMembers = [
  "scene", "scenes", "settings", "camera", "playing", "time_s", "bounds", "view", "lights", "device", "limits",
  "methods", "role",
];

/** A scene's name as words: "rigged-figure" as "Rigged figure". @param {string} name */
export function scene_title(name) {
  const words = name.replace(/[-_]+/g, " ").trim();
  return words ? words[0].toUpperCase() + words.slice(1) : name;
}

export class SessionModel {
  /** @param {(seq: number | undefined, member: string) => boolean} is_newer see Inputs.is_newer_than */
  constructor(is_newer) {
    this.is_newer = is_newer;
    this.listeners = [];
    this.scene = null;
    this.scenes = [];
    this.settings = {};
    this.default_settings = null;
    this.camera = null;      // as asked for: null, {index} or {eye, target, yfov}
    this.playing = true;
    this.time_s = 0;
    this.bounds = null;
    this.view = null;        // as it stands in the picture shown
    this.lights = [];
    this.device = "";
    this.limits = { max_width: 4096, max_height: 4096, max_samples: 4096, max_upload_bytes: Infinity };
    this.methods = [];
    this.role = "driver";
    this.edits = [];         // all that was asked for since the scene was opened, one for each path
    this.poses = new Map();  // frame id -> pose message
    this.light_changes = new Map();  // light index -> members asked for and not yet in the picture
  }

  /** Calls `listener(changed)` after each change, `changed` being the set of members that did. */
  subscribe(listener) {
    this.listeners.push(listener);
  }

  /** Takes `welcome` or `state`. */
  apply(message) {
    const changes = {};
    for (const member of kMembers) {
      if (!(member in message) || message[member] === undefined) continue;
      if (message.type === "state" && this.is_newer(message.seq, member)) continue;
      changes[member] = message[member];
    }
    this.default_settings ??= changes.settings ?? null;
    this.set(changes);
  }

  /** Lays over it what the user has asked for. */
  ask(input) {
    const changes = {};
    for (const member of ["camera", "playing", "time_s", "scene"]) {
      if (member in input) changes[member] = input[member];
    }
    if (input.settings) changes.settings = { ...this.settings, ...input.settings };
    if ("scene" in changes) {
      this.edits = [];
      this.light_changes.clear();
    }
    if (input.edits) {
      const replaced = new Set(input.edits.map((edit) => edit.path));
      this.edits = [...this.edits.filter((edit) => !replaced.has(edit.path)), ...input.edits];
    }
    this.set(changes);
  }

  /** Shows a light with `change` (position, direction, color or intensity) before the server's picture does. */
  change_light(index, change) {
    this.light_changes.set(index, { ...this.light_changes.get(index), ...change });
    this.set({ lights: this.lights });
  }

  set(changes) {
    Object.assign(this, changes);
    if (changes.lights) {
      this.lights = changes.lights.map((light) => ({ ...light, ...this.light_changes.get(light.index) }));
    }
    const changed = new Set(Object.keys(changes));
    if (changed.size > 0) this.listeners.forEach((listener) => listener(changed));
  }

  /** Remembers a pose until its frame is on the screen. */
  keep_pose(message) {
    this.poses.set(message.frame, message);
  }

  /** The frame with this header is on the screen: what moves stands as in it. */
  frame_shown({ frame, input_seq, scene_time_s }) {
    const changes = { time_s: scene_time_s };
    if (!this.is_newer(input_seq, "edits")) this.light_changes.clear();
    for (const [id, pose] of this.poses) {
      if (id > frame) continue;
      if (pose.view) changes.view = pose.view;
      if (pose.lights) changes.lights = pose.lights;
      this.poses.delete(id);
    }
    if (this.is_newer(input_seq, "time_s")) delete changes.time_s;
    this.set(changes);
  }

  /** The open scene's entry in the list of scenes; an empty one if it is not listed. */
  scene_entry() {
    return this.scenes.find((entry) => entry.name === this.scene) ?? { name: this.scene, cameras: [], duration_s: 0 };
  }

  /** True while the picture is seen through one of the scene's cameras (or the one made for a scene without any). */
  follows_scene_camera() {
    return !this.camera || "index" in this.camera;
  }

  /** True if the server renders on a processor, where every pixel counts. */
  is_software_device() {
    return /llvmpipe|softpipe|swrast|swiftshader|software/i.test(this.device);
  }
}
