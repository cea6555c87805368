// What travels on the stream, for browsers and node: frames and messages, bytes to values and back.
// protocol/README.md describes it; protocol/golden_vectors.json holds this file and the C++ codec to the same results.
// Nothing is imported, and nothing but ProtocolError is thrown.

export const subprotocol = "lightwell.v1";
export const protocol_version = 1;
export const frame_header_bytes = 48;
export const close_code = Object.freeze({
  draining: 1001, bad_message: 4000, session_ended: 4001, too_slow: 4002, not_allowed: 4003,
});

/** Something that came, or was to be sent, is not what the protocol says. `pointer` is the JSON pointer of the member. */
export class ProtocolError extends Error {
  constructor(detail, pointer = "") {
    super(pointer ? `${pointer}: ${detail}` : detail);
    this.name = "ProtocolError";
    this.detail = detail;
    this.pointer = pointer;
  }
}

// Frames.

const frame_magic = 0x3146574c;
const frame_codecs = [null, "jpeg", "png", "h264"];

/**
 * A binary message as {header, payload}: `payload` is a Uint8Array on the message's own memory, `header` has codec
 * ("jpeg", "png" or "h264"), is_key, is_final, is_lossless, frame, input_seq, scene_revision (a BigInt), capture_ms,
 * scene_time_s, width, height, payload_bytes and render_ms.
 */
export function decode_frame(buffer) {
  if (buffer.byteLength < frame_header_bytes) throw new ProtocolError("a frame shorter than its header");
  const view = new DataView(buffer);
  if (view.getUint32(0, true) !== frame_magic) throw new ProtocolError("not a frame: wrong magic");
  if (view.getUint8(4) !== 1) throw new ProtocolError("unknown frame version");
  if (view.getUint8(5) !== 1) throw new ProtocolError("unknown frame type");
  const codec = frame_codecs[view.getUint8(6)];
  if (!codec) throw new ProtocolError("unknown frame codec");
  const flags = view.getUint8(7);
  const header = {
    codec,
    is_key: (flags & 1) !== 0,
    is_final: (flags & 2) !== 0,
    is_lossless: (flags & 4) !== 0,
    frame: view.getUint32(8, true),
    input_seq: view.getUint32(12, true),
    scene_revision: view.getBigUint64(16, true),
    capture_ms: view.getFloat64(24, true),
    scene_time_s: view.getFloat32(32, true),
    width: view.getUint16(36, true),
    height: view.getUint16(38, true),
    payload_bytes: view.getUint32(40, true),
    render_ms: view.getFloat32(44, true),
  };
  check_frame(header, buffer.byteLength);
  return { header, payload: new Uint8Array(buffer, frame_header_bytes) };
}

function check_frame(header, message_bytes) {
  const refuse = (detail) => { throw new ProtocolError(detail); };
  if (header.frame === 0) refuse("frame id 0");
  if (!Number.isFinite(header.capture_ms)) refuse("capture time is not finite");
  if (!Number.isFinite(header.scene_time_s)) refuse("scene time is not finite");
  if (header.width === 0 || header.height === 0) refuse("a frame without pixels");
  if (header.payload_bytes !== message_bytes - frame_header_bytes) refuse("payload length does not match the message");
  if (!Number.isFinite(header.render_ms)) refuse("render time is not finite");
}

/** The inverse of decode_frame, for tests and stand-in servers. */
export function encode_frame(header, payload) {
  const bytes = new Uint8Array(frame_header_bytes + payload.length);
  const view = new DataView(bytes.buffer);
  view.setUint32(0, frame_magic, true);
  view.setUint8(4, 1);
  view.setUint8(5, 1);
  view.setUint8(6, frame_codecs.indexOf(header.codec));
  view.setUint8(7, (header.is_key ? 1 : 0) | (header.is_final ? 2 : 0) | (header.is_lossless ? 4 : 0));
  view.setUint32(8, header.frame, true);
  view.setUint32(12, header.input_seq, true);
  view.setBigUint64(16, BigInt(header.scene_revision), true);
  view.setFloat64(24, header.capture_ms, true);
  view.setFloat32(32, header.scene_time_s, true);
  view.setUint16(36, header.width, true);
  view.setUint16(38, header.height, true);
  view.setUint32(40, payload.length, true);
  view.setFloat32(44, header.render_ms, true);
  bytes.set(payload, frame_header_bytes);
  return bytes.buffer;
}

// Messages. A reader is a function of (value, pointer, strict) that throws if the value is not what it should be;
// strict readings refuse members that are not known.

const largest_float = 3.4028234663852886e38;
const largest_index = 0x7fffffff;
const largest_u32 = 0xffffffff;

function refuse(what, value, pointer) {
  const text = typeof value === "number" ? String(value) : JSON.stringify(value) ?? String(value);
  throw new ProtocolError(`must be ${what}, not ${text.length > 60 ? `${text.slice(0, 60)}...` : text}`, pointer);
}

function escape_token(name) {
  return name.replaceAll("~", "~0").replaceAll("/", "~1");
}

function is_object(value) {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}

function is_given(value, name) {
  return Object.hasOwn(value, name) && value[name] !== undefined;
}

const any = () => {};

const boolean = (value, pointer) => {
  if (typeof value !== "boolean") refuse("true or false", value, pointer);
};

const number = (low = -largest_float, high = largest_float, low_open = false) => (value, pointer) => {
  if (typeof value === "number" && (low_open ? value > low : value >= low) && value <= high) return;
  refuse(`a number ${low_open ? "above" : "from"} ${low} to ${high}`, value, pointer);
};

const integer = (low, high) => (value, pointer) => {
  if (!Number.isInteger(value) || value < low || value > high) {
    refuse(`a whole number from ${low} to ${high}`, value, pointer);
  }
};

const string = (min_bytes, max_bytes) => (value, pointer) => {
  const bytes = typeof value === "string" ? new TextEncoder().encode(value).length : -1;
  if (bytes < min_bytes || bytes > max_bytes) refuse(`a string of ${min_bytes} to ${max_bytes} bytes`, value, pointer);
};

const one_of = (...names) => (value, pointer) => {
  if (!names.includes(value)) refuse(`one of ${names.join(", ")}`, value, pointer);
};

const matching = (pattern, what) => (value, pointer) => {
  if (typeof value !== "string" || !pattern.test(value)) refuse(what, value, pointer);
};

const array = (read, min_size, max_size) => (value, pointer, strict) => {
  if (!Array.isArray(value) || value.length < min_size || value.length > max_size) {
    refuse(`an array of ${min_size} to ${max_size} elements`, value, pointer);
  }
  value.forEach((element, index) => read(element, `${pointer}/${index}`, strict));
};

const nullable = (read) => (value, pointer, strict) => {
  if (value !== null) read(value, pointer, strict);
};

/** Members by name; those of `optional_members` may be left out (undefined is left out too: it does not travel). */
const object = (members, optional_members = {}) => (value, pointer, strict) => {
  if (!is_object(value)) refuse("an object", value, pointer);
  for (const [name, read] of Object.entries(members)) {
    if (!is_given(value, name)) throw new ProtocolError(`the member "${name}" is missing`, pointer);
    read(value[name], `${pointer}/${name}`, strict);
  }
  for (const [name, read] of Object.entries(optional_members)) {
    if (is_given(value, name)) read(value[name], `${pointer}/${name}`, strict);
  }
  const is_known = (name) => Object.hasOwn(members, name) || Object.hasOwn(optional_members, name);
  const unknown = strict ? Object.keys(value).find((name) => !is_known(name)) : undefined;
  if (unknown !== undefined) {
    throw new ProtocolError(`the member "${unknown}" is not known here`, `${pointer}/${escape_token(unknown)}`);
  }
};

const token = string(1, 256);
const text = string(0, 65536);
const count = integer(0, Number.MAX_SAFE_INTEGER);
const u32 = integer(0, largest_u32);
const sequence = integer(1, largest_u32);
const index = integer(0, largest_index);
const at_least_one = integer(1, largest_index);
const pixels = integer(1, 65535);
const time = number(0, 1e9);
const vector = array(number(), 3, 3);
const texts = array(text, 0, 4096);
const role = one_of("driver", "viewer");
const scene_name = matching(/^[a-z0-9_-]{1,64}$/, "a scene's name, 1 to 64 of a-z, 0-9, _ and -");

const free_camera = (value, pointer, strict) => {
  object({ eye: vector, target: vector }, {
    yfov: number(0, 3.14, true), znear: number(0, largest_float, true),
  })(value, pointer, strict);
  if (value.eye.every((coordinate, axis) => coordinate === value.target[axis])) {
    throw new ProtocolError("eye and target are the same point", pointer);
  }
};

const camera = nullable((value, pointer, strict) => {
  const names_one = is_object(value) && Object.hasOwn(value, "index");
  (names_one ? object({ index }) : free_camera)(value, pointer, strict);
});

const bounces = (value, pointer) => {
  if (value !== "inf") index(value, pointer);
};

const settings = object({}, {
  method: token, samples: at_least_one, bounces, indirect_size: at_least_one, estimator: token, view: token,
  view_index: index, patch: at_least_one, triangle_groups: at_least_one, normal_threshold: number(-1, 1),
  depth_threshold: number(0, 10), similarity: token, trace_missed: boolean, brute_force: boolean,
  exposure_ev: nullable(number(-64, 64)), tone_map: token, seed: u32,
  background: nullable(array(number(0), 3, 3)), shadow_size: at_least_one, shadow_filter: at_least_one,
  denoise: boolean, multiple_scattering: boolean, temporal_antialiasing: boolean,
  firefly_clamp: number(0, 1e6), hand_over: boolean, target_fps: index, warm_up: index,
});

const edit = (value, pointer) => {
  if (!is_object(value)) refuse("an object", value, pointer);
  const members = { op: one_of("add", "remove", "replace", "test"), path: json_pointer };
  object(members)(value, pointer, false);
  if (value.op !== "remove") object({ value: any })(value, pointer, false);
};

function json_pointer(value, pointer) {
  string(0, 1024)(value, pointer);
  if (!/^(\/([^~/]|~[01])*)*$/u.test(value)) refuse("a JSON pointer", value, pointer);
}

const change = {
  edits: array(edit, 0, 4096), camera, settings, playing: boolean, time_s: time, scene: scene_name,
  width: pixels, height: pixels,
};

const client_messages = {
  hello: object({ type: any, codecs: array(string(1, 32), 1, 16), width: pixels, height: pixels },
    { device_pixel_ratio: number(0, 16, true), role, resume: nullable(token) }),
  input: object({ type: any, seq: sequence }, change),
  look: object({ type: any, seq: sequence }, { camera, width: pixels, height: pixels }),
  ack: object({ type: any, frame: sequence },
    { received_ms: number(), decoded_ms: number(), shown_ms: number(), queue: u32, held_ms: number() }),
  demotion: object({ type: any, reason: string(1, 256) }),
  ping: object({ type: any, t: number() }),
};

const scenes = array(object({
  name: scene_name, builtin: boolean, triangles: count, duration_s: time, cameras: texts, animated: boolean,
}), 0, 65536);

const lights = array(object({
  index, name: text, kind: token, node: index, position: vector, direction: vector, color: vector,
  intensity: number(),
}, { parent_from_world: array(number(), 16, 16) }), 0, 65536);

const limits = object({ max_width: u32, max_height: u32, max_samples: u32, max_upload_bytes: count });
const bounds = object({ min: vector, max: vector });
const problem = object({ title: text, status: integer(400, 599), detail: text },
  { type: text, instance: text, pointer: text });

const server_messages = {
  welcome: object({
    session: token, role, codec: token, protocol: integer(protocol_version, protocol_version), resume: token,
    scene: scene_name, scenes, settings, camera, playing: boolean, time_s: time, device: text, limits, methods: texts,
    codecs: texts, bounds, view: free_camera, lights,
  }),
  state: object({}, {
    seq: sequence, scene: scene_name, scenes, settings, camera, playing: boolean, time_s: time, bounds,
    view: free_camera, lights,
  }),
  pose: object({ frame: sequence, view: free_camera, lights }),
  stats: object({
    fps: number(), render_ms: number(), encode_ms: number(),
    stages: array(object({ name: text, ms: number() }), 0, 256), rays: count, triangles: count,
    exposure_ev: number(), accumulated: u32, clamped_share: number(), method: token, time_s: time,
  }),
  error: object({ problem }, { seq: sequence }),
  pong: object({ t: number() }),
  bye: object({ reason: text, reconnect: boolean }),
};

function check_message(message, readers, strict) {
  object({ type: string(1, 32) })(message, "", false);
  if (!Object.hasOwn(readers, message.type)) {
    throw new ProtocolError(`no message is called "${message.type}"`, "/type");
  }
  readers[message.type](message, "", strict);
  return message;
}

function parse_json(json) {
  try {
    return JSON.parse(json);
  } catch {
    throw new ProtocolError("no valid JSON");
  }
}

/**
 * A text message of the server as an object with a `type`. Members that are not known are left as they are; a message
 * of a type that is not known is a ProtocolError with the pointer "/type", to be passed over.
 */
export function parse_message(json) {
  return check_message(parse_json(json), server_messages, false);
}

/** A text message of a client, as the server checks it; for tests and stand-in servers. */
export function parse_client_message(json) {
  return check_message(parse_json(json), client_messages, true);
}

// Builders: the text to send. A wrong value is a ProtocolError here rather than a refusal by the server.

function client_text(message) {
  return JSON.stringify(check_message(message, client_messages, true));
}

/** `options`: codecs, width, height, and if wanted device_pixel_ratio, role and resume. */
export function hello(options) {
  return client_text({ type: "hello", device_pixel_ratio: 1, role: "driver", resume: null, ...options });
}

/** `change_wanted`: any of edits, camera, settings, playing, time_s, scene, width and height. */
export function input(seq, change_wanted) {
  return client_text({ type: "input", seq, ...change_wanted });
}

/** A viewer's own look. `own`: any of camera, width and height; what is left out is the driver's. */
export function look(seq, own = {}) {
  return client_text({ type: "look", seq, ...own });
}

/** `timing`: what is known of received_ms, decoded_ms, shown_ms and queue. */
export function ack(frame, timing = {}) {
  return client_text({ type: "ack", frame, queue: 0, ...timing });
}

/** Video makes trouble here: JPEG alone from now on. @param {string} reason its beginning is sent */
export function demotion(reason) {
  return client_text({ type: "demotion", reason: [...reason].slice(0, 64).join("") });
}

export function ping(t) {
  return client_text({ type: "ping", t });
}
