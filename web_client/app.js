// The viewer's parts, put together: the user's hands -> inputs -> the server -> frames and state -> what is shown.
import { Access, ask_for_token } from "./access.js";
import { CameraDriver } from "./camera_driver.js";
import { Connection } from "./connection.js";
import { FrameView } from "./frame_view.js";
import { Gestures } from "./gestures.js";
import { Inputs } from "./inputs.js";
import { LightHandles } from "./light_handles.js";
import { LightPanel } from "./light_panel.js";
import { Banner, show_note } from "./notices.js";
import { OrbitCamera } from "./orbit_camera.js";
import { Panel } from "./panel.js";
import { wanted_size } from "./picture_size.js";
import { problem_from, words_of } from "./problem.js";
import { ack, demotion, ProtocolError } from "./protocol.js";
import { SessionModel } from "./session_model.js";
import { hash_of, parse_hash } from "./share.js";
import { listen_for_shortcuts } from "./shortcuts.js";
import { Stats } from "./stats.js";
import { Transport } from "./transport.js";
import { Uploader } from "./upload.js";
import { can_decode_video } from "./video_pictures.js";
import { Watching, watch_link } from "./watching.js";
import { connect_chrome } from "./chrome.js";

const kResizeWaitMs = 120;
const kHashWaitMs = 400;
const kSizeKey = "lightwell.picture_size";

const base = new URL(".", location.href);
const stage = document.getElementById("stage");
const access = new Access(sessionStorage);
history.replaceState(null, "", access.take_from(location.hash) || location.pathname + location.search);
const wished = parse_hash(location.hash);
let picture_size = localStorage.getItem(kSizeKey) ?? "auto";
let asked_size = { width: 0, height: 0 };
let was_open = false;
let held_acks = [];
let pictures_shown = 0;  // over all streams

const inputs = new Inputs(send_input);
const watching = new Watching(wished.watch, {
  size: current_size,
  push: (change) => inputs.push(change),
  copy_link,
  returned: show_what_is,
});
const model = new SessionModel((seq, member) => inputs.is_newer_than(seq, member));
const orbit = new OrbitCamera();
const frames = new FrameView(document.getElementById("picture"), frame_done, give_up_video);
let takes_video = false;
const banner = new Banner(() => connection.connect());

function send_input(seq, change) {
  try {
    const sent = connection.send(watching.message(seq, change));
    if (sent) stage.dataset.asked = seq;
    return sent;
  } catch (error) {  // a value the protocol does not know; kept, it would stop every later input
    if (!(error instanceof ProtocolError)) throw error;
    show_note(`That cannot be asked for: ${error.message}`, "trouble");
    return true;
  }
}

/** The user's wish: shown at once, sent with the next animation frame. */
function push(input, at_ms) {
  if (!watching.allows(input)) return show_note("Only the driver changes that.");
  model.ask(input);
  inputs.push(input, at_ms);
}

const camera = new CameraDriver(model, orbit, { push, rect: () => frames.rect(), animate: () => gestures.animate() });
const gestures = new Gestures(frames.canvas, orbit, {
  rect: () => frames.rect(),
  begin: () => camera.begin(),
  moved: (at_ms) => camera.moved(at_ms),
});
const panel = new Panel(document.getElementById("panel"), model, {
  push,
  open_scene,
  choose_file: () => uploader.choose(),
  use_camera: (index) => camera.use(index),
  picture_size: () => picture_size,
  set_picture_size,
  exposure_ev: () => stats?.server?.exposure_ev ?? 0,
});
const stats = new Stats(model, panel.stats_place);
new LightPanel(panel.lights_place, model, push);
const handles = new LightHandles(document.getElementById("light-layer"), document.getElementById("sky-dial"), model, {
  push,
  rect: () => frames.rect(),
});
const transport = new Transport(model, { push, follow: () => camera.toggle_follow(), fit: () => camera.fit() });
const uploader = new Uploader(base, access, {
  most_bytes: () => model.limits.max_upload_bytes,
  is_builtin: (name) => model.scenes.some((entry) => entry.name === name && entry.builtin),
  opened: async (name) => {
    model.set({ scenes: await scene_list() });
    open_scene(name);
  },
});
const chrome = connect_chrome(model, stats, { push, screenshot });

const connection = new Connection(base, access, {
  session_request: async () => {
    const request = { ...current_size(), playing: model.playing };
    if (model.scene === null) return { ...request, scene: await first_scene(), ...wished };
    const { scene, settings, time_s } = model;
    return { ...request, scene, camera: model.camera, settings, time_s };
  },
  hello: () => ({
    codecs: takes_video ? ["h264", "jpeg"] : ["jpeg"],
    ...current_size(),
    device_pixel_ratio: devicePixelRatio,
    role: watching.role,
  }),
  on_state: connection_state,
  on_welcome: welcomed,
  on_message: (message) => {
    if (message.type === "state") {
      if (message.scene) watching.lost();
      model.apply(message);
    }
    if (message.type === "pose") model.keep_pose(message);
    if (message.type === "stats") {
      stats.server_says(message);
      panel.show_exposure();
    }
    if (message.type === "error") refused(message);
  },
  on_frame: (frame) => frames.receive(frame),
  on_refused: (problem) => {
    if (problem.status === 401) {
      ask_for_token(access, access.token ? "That token is not known here." : "", () => connection.connect());
      return false;
    }
    if (watching.session) return false;
    const can_do_without = model.scene === null && Object.keys(wished).length > 0;
    if (can_do_without) show_note(`The address asks for something that is not here. ${problem.message}`, "trouble");
    delete wished.scene;
    delete wished.camera;
    return can_do_without;
  },
}, watching.session);

function connection_state(state, { wait_ms, reason }) {
  stage.dataset.connection = state;
  chrome.show_connection(state, was_open);
  if (state === "waiting") {
    const text = was_open ? "The connection is lost." : "The server does not answer.";
    banner.count_down(text, wait_ms);
  } else if (state === "connecting" && was_open) {
    banner.show("Connecting again.", false);
  } else if (state === "stopped") {
    banner.show(reason, true);
  } else if (state === "open") {
    banner.hide();
    was_open = true;
  }
}

/** A stream is open. What the user asked for and no frame has answered is asked for again. */
function welcomed(message, is_new_session) {
  const { camera: own_camera, settings, playing, edits } = model;
  const lost = inputs.has_unanswered() && !is_new_session;
  held_acks = [];
  frames.restart();
  stats.restart();
  model.poses.clear();
  if (is_new_session) inputs.restart();
  Object.assign(stage.dataset, { session: message.session, seq: 0, asked: inputs.last_seq, final: false });
  model.apply(message);
  if (lost) push({ camera: own_camera, settings, playing });
  if (edits.length > 0 && (lost || is_new_session)) push({ edits });
  if (was_open) show_note(is_new_session ? "Connected again, in a new session." : "Connected again.");
  asked_size = current_size();
  inputs.push(asked_size);
  inputs.flush();
}

/** The server refused an input: says so, and shows again what really is. */
async function refused(message) {
  show_note(words_of(message.problem, message.problem?.status), "trouble");
  if (message.seq) watching.lost();  // else it is trouble of the server's own
  await show_what_is();
}

async function show_what_is() {
  const address = new URL(`v1/sessions/${connection.session}`, base);
  const response = await fetch(address, { cache: "no-store", headers: access.headers() }).catch(() => null);
  if (response?.ok) model.apply({ ...(await response.json()), type: "session" });
}

/** JPEG from here on: the server is told, and the user why. */
function give_up_video(reason) {
  if (!takes_video) return;
  takes_video = false;
  connection.send(demotion(reason));
  show_note(`Video makes trouble here (${reason}): pictures are JPEG from now on.`, "trouble");
}

function frame_done(frame, times) {
  const { header } = frame;
  if (document.hidden) held_acks.push([header.frame, times, performance.now()]);  // the server stops: nobody looks
  else connection.send(ack(header.frame, times));
  if (times.shown_ms === undefined) return;
  model.frame_shown(header);
  stats.frame_shown(frame, times, inputs.answered(header.input_seq, times.shown_ms));
  pictures_shown += 1;
  const { input_seq: seq, is_final: final, codec } = header;
  Object.assign(stage.dataset, { shown: pictures_shown, seq, final, codec });
  handles.place();
  chrome.show_status();
}

// A page that is gone for good needs no session; one that the browser may bring back does.
addEventListener("pagehide", (event) => {
  if (!event.persisted) connection.end_session();
});

document.addEventListener("visibilitychange", () => {
  connection.set_paused(document.hidden);
  if (document.hidden) return;
  for (const [frame, times, since_ms] of held_acks) {
    connection.send(ack(frame, { ...times, held_ms: performance.now() - since_ms }));
  }
  held_acks = [];
});

async function scene_list() {
  const response = await fetch(new URL("v1/scenes", base), { cache: "no-store", headers: access.headers() });
  if (!response.ok) throw await problem_from(response);
  return (await response.json()).scenes;
}

/** What to open when the address names no scene: the one the server was started with. */
const first_scene = async () => wished.scene ?? (await scene_list())[0].name;

function open_scene(name) {
  camera.forget();
  push({ scene: name, camera: null, time_s: 0, playing: true });
}

async function copy_link() {
  await navigator.clipboard.writeText(watch_link(base, connection.session));
  show_note("Copied: whoever opens the link watches.");
}

async function screenshot() {
  const blob = await frames.png();
  if (!blob) return;
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = `${model.scene}-${model.time_s.toFixed(2)}s.png`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  show_note(`Saved as ${link.download}`);
}

function current_size() {
  const is_slow = model.device === "" || model.is_software_device();
  return wanted_size(picture_size, stage.getBoundingClientRect(), devicePixelRatio, model.limits, is_slow);
}

function set_picture_size(choice) {
  picture_size = choice;
  localStorage.setItem(kSizeKey, choice);
  ask_for_size();
}

function ask_for_size() {
  const size = current_size();
  if (size.width === asked_size.width && size.height === asked_size.height) return;
  asked_size = size;
  inputs.push(size);
}

let resize_timer = 0;
function resized() {
  frames.fit();
  handles.place();
  clearTimeout(resize_timer);
  resize_timer = setTimeout(ask_for_size, kResizeWaitMs);
}
new ResizeObserver(resized).observe(stage);

let hash_timer = 0;
model.subscribe((changed) => {
  if (watching.session || (!changed.has("camera") && !changed.has("scene"))) return;
  clearTimeout(hash_timer);
  hash_timer = setTimeout(() => history.replaceState(null, "", `#${hash_of(model.scene, model.camera)}`), kHashWaitMs);
});
addEventListener("hashchange", () => {
  const with_token = access.token;
  const rest = access.take_from(location.hash);
  if (access.token !== with_token) {
    history.replaceState(null, "", rest || location.pathname + location.search);
    connection.connect();
  }
  const asked = parse_hash(location.hash);
  if (asked.watch !== watching.session) return location.reload();
  if (asked.scene && asked.scene !== model.scene) open_scene(asked.scene);
  if (asked.camera) push({ camera: asked.camera });
});

listen_for_shortcuts({
  " ": () => transport.toggle(),
  1: () => push({ settings: { view: "final" } }),
  2: () => push({ settings: { view: "direct" } }),
  3: () => push({ settings: { view: "indirect" } }),
  f: () => camera.fit(),
  c: () => camera.toggle_follow(),
  s: screenshot,
  h: () => chrome.toggle_panel(),
  l: () => stage.classList.toggle("without-handles"),
  "?": () => chrome.open_help(),
});

takes_video = await can_decode_video();
connection.connect();
