// The viewer's arithmetic, without a browser: node --test tests/browser/viewer_parts.test.mjs
import assert from "node:assert/strict";
import { test } from "node:test";
import { Inputs, merge_inputs } from "../../web_client/inputs.js";
import {
  color_of_hex, dial_from_direction, direction_from_dial, edits_of_light, hex_of_color,
} from "../../web_client/lights.js";
import { OrbitCamera } from "../../web_client/orbit_camera.js";
import { wanted_size } from "../../web_client/picture_size.js";
import { words_of } from "../../web_client/problem.js";
import { scene_title, SessionModel } from "../../web_client/session_model.js";
import { hash_of, parse_hash } from "../../web_client/share.js";
import { short_number } from "../../web_client/stats.js";
import { refusal_of, scene_name_of } from "../../web_client/upload.js";
import { shortest_rotation } from "../../web_client/vector.js";
import { codec_name } from "../../web_client/video_pictures.js";
import { picture_rect, project, unproject } from "../../web_client/view_math.js";

const rect = { x: 0, y: 0, width: 800, height: 600 };
const bounds = { min: [-4, 0, -2], max: [4, 6, 2] };
const view = { eye: [3, 4, 5], target: [0, 1, -1], yfov: 0.9 };

const close = (actual, expected, tolerance = 1e-6) => {
  [actual].flat().forEach((value, i) => {
    const wanted = [expected].flat()[i];
    assert.ok(Math.abs(value - wanted) <= tolerance, `${JSON.stringify(actual)} is not ${JSON.stringify(expected)}`);
  });
};

const camera_at = (start = view, keep_target = true) => {
  const camera = new OrbitCamera();
  camera.adopt(start, bounds, keep_target);
  return camera;
};

test("the middle of the picture is what the camera looks at", () => {
  const seen = project(view.target, view, rect);
  close([seen.x, seen.y, seen.depth], [400, 300, Math.hypot(3, 3, 6)]);
});

test("a point at the top of the picture is half the field of view away", () => {
  const up_view = { eye: [0, 0, 0], target: [0, 0, -1], yfov: Math.PI / 2 };
  close([project([0, 2, -2], up_view, rect).y, project([2, 0, -2], up_view, rect).x], [0, 700]);
});

test("unproject is the inverse of project", () => {
  const point = [0.7, -1.2, 0.4];
  const { x, y, depth } = project(point, view, rect);
  close(unproject(x, y, depth, view, rect), point);
});

test("a picture of all but the window's shape fills it, another stands whole in its middle", () => {
  const fills = picture_rect(1.335, rect);
  assert.ok(fills.width >= 800 && fills.height >= 600);
  close(Object.values(picture_rect(2, rect)), [0, 100, 800, 400]);
  close(Object.values(picture_rect(1, rect)), [100, 0, 600, 600]);
});

test("the camera gives back the view it took over", () => {
  for (const keep_target of [true, false]) {
    const taken = camera_at(view, keep_target).view();
    close(taken.eye, view.eye);
    close(project(view.target, taken, rect).x, 400);
    assert.equal(taken.yfov, view.yfov);
  }
});

test("a turn keeps the distance and stops short of the poles", () => {
  const camera = camera_at();
  camera.turn(1, 0.3);
  close(Math.hypot(...camera.view().eye.map((value, i) => value - view.target[i])), Math.hypot(3, 3, 6));
  camera.turn(0, 100);
  assert.ok(camera.elevation < Math.PI / 2 && camera.elevation > 1.5);
});

test("a turn to the right moves the scene to the right", () => {
  const camera = camera_at();
  const near = [1, 2, 2];  // between the target and the eye
  const before = project(near, camera.view(), rect).x;
  camera.turn(0.05, 0);
  assert.ok(project(near, camera.view(), rect).x > before);
});

test("a pan carries what is in the target's plane along with the hand", () => {
  const camera = camera_at();
  const held = unproject(200, 150, camera.distance, camera.view(), rect);
  camera.pan(37, -12, rect);
  const seen = project(held, camera.view(), rect);
  close([seen.x, seen.y], [237, 138]);
});

test("a zoom keeps what is under the pointer there", () => {
  const camera = camera_at();
  const held = unproject(620, 90, camera.distance, camera.view(), rect);
  camera.zoom(1.7, { x: 620, y: 90 }, rect);
  const seen = project(held, camera.view(), rect);
  close([seen.x, seen.y], [620, 90], 1e-3);
});

test("zooming on and on goes forwards instead of sticking", () => {
  const camera = camera_at();
  for (let i = 0; i < 60; ++i) camera.zoom(1.2, { x: 400, y: 300 }, rect);
  const first = camera.view().eye;
  for (let i = 0; i < 20; ++i) camera.zoom(1.2, { x: 400, y: 300 }, rect);
  assert.ok(Math.hypot(...camera.view().eye.map((value, i) => value - first[i])) > 1);
});

test("fit brings every corner of the scene into the picture, in any shape of window", () => {
  for (const shape of [rect, { x: 0, y: 0, width: 300, height: 700 }]) {
    const camera = camera_at();
    camera.fit(bounds, shape.width / shape.height);
    for (let i = 0; i < 60 && camera.moving(); ++i) camera.advance(1 / 60, shape);
    assert.equal(camera.moving(), false);
    for (let corner = 0; corner < 8; ++corner) {
      const point = [0, 1, 2].map((i) => ((corner >> i) & 1 ? bounds.max : bounds.min)[i]);
      const seen = project(point, camera.view(), shape);
      assert.ok(seen.depth > 0 && seen.x >= 0 && seen.x <= shape.width && seen.y >= 0 && seen.y <= shape.height);
    }
  }
});

test("a let-go turn runs out, and how far does not hang on the frame rate", () => {
  const angle_after = (rate) => {
    const camera = camera_at();
    const start = camera.azimuth;
    camera.coast(2, 0);
    for (let i = 0; i < 2 * rate && camera.moving(); ++i) camera.advance(1 / rate, rect);
    assert.equal(camera.moving(), false);
    return start - camera.azimuth;
  };
  close(angle_after(30), angle_after(144), 5e-3);
});

test("inputs of one frame become one message; the newest of each thing counts", () => {
  const merged = merge_inputs(
    { settings: { samples: 8, view: "direct" }, edits: [{ path: "/a", value: 1 }, { path: "/b", value: 1 }] },
    { settings: { samples: 16 }, edits: [{ path: "/a", value: 2 }], playing: false },
  );
  assert.deepEqual(merged.settings, { samples: 16, view: "direct" });
  assert.deepEqual(merged.edits, [{ path: "/b", value: 1 }, { path: "/a", value: 2 }]);
  assert.equal(merged.playing, false);
});

test("inputs wait for a connection, count from 1 and know their latency", () => {
  const sent = [];
  let is_open = false;
  const frames = [];
  const inputs = new Inputs((seq, change) => is_open && sent.push({ seq, ...change }) > 0, (run) => frames.push(run));
  inputs.push({ time_s: 1 }, 100);
  inputs.push({ time_s: 2 }, 110);
  assert.equal(frames.length, 1);
  frames.pop()();
  assert.deepEqual(sent, []);
  assert.ok(inputs.is_newer_than(0, "time_s"));
  is_open = true;
  inputs.flush();
  assert.deepEqual(sent, [{ seq: 1, time_s: 2 }]);
  assert.ok(inputs.is_newer_than(0, "time_s") && !inputs.is_newer_than(1, "time_s"));
  assert.equal(inputs.answered(1, 150), 50);
  assert.equal(inputs.answered(1, 170), null);
});

test("the server's older word does not undo what was asked for since", () => {
  const model = new SessionModel((seq) => seq < 5);
  model.apply({ type: "welcome", settings: { samples: 32 }, playing: true });
  model.ask({ settings: { samples: 64 } });
  model.apply({ type: "state", seq: 4, settings: { samples: 32 } });
  assert.equal(model.settings.samples, 64);
  model.apply({ type: "state", seq: 5, settings: { samples: 48 } });
  assert.equal(model.settings.samples, 48);
});

test("a pose counts from its own frame on", () => {
  const model = new SessionModel(() => false);
  model.keep_pose({ frame: 7, view, lights: [] });
  model.frame_shown({ frame: 6, input_seq: 0, scene_time_s: 1 });
  assert.equal(model.view, null);
  model.frame_shown({ frame: 8, input_seq: 0, scene_time_s: 1 });
  assert.deepEqual(model.view, view);
});

test("a light is moved and turned in its node's own space", () => {
  const twice_and_aside = [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 1, 0, 0, 1];
  const light = { index: 1, node: 4, kind: "spot", parent_from_world: twice_and_aside };
  const [translation, rotation] = edits_of_light(light, { position: [1, 2, 3], direction: [0, 0, -1] });
  assert.deepEqual(translation, { op: "replace", path: "/nodes/4/translation", value: [3, 4, 6] });
  close(rotation.value, [0, 0, 0, 1]);
  const [intensity] = edits_of_light(light, { intensity: 0 });
  assert.equal(intensity.path, "/extensions/KHR_lights_punctual/lights/1/intensity");
});

test("the shortest rotation turns one direction into the other, opposite ones too", () => {
  const turn = ([x, y, z, w], v) => {
    const across = [y * v[2] - z * v[1], z * v[0] - x * v[2], x * v[1] - y * v[0]].map((value) => 2 * value);
    const twice = [y * across[2] - z * across[1], z * across[0] - x * across[2], x * across[1] - y * across[0]];
    return v.map((value, i) => value + w * across[i] + twice[i]);
  };
  for (const to of [[0, -1, 0], [0.6, 0, 0.8], [0, 0, 1], [0, 0, -1]]) {
    close(turn(shortest_rotation([0, 0, -1], to), [0, 0, -1]), to);
  }
});

test("colours survive the way to the browser's colour field and back", () => {
  assert.equal(hex_of_color([1, 1, 1]), "#ffffff");
  assert.equal(hex_of_color([0, 0, 0]), "#000000");
  assert.equal(hex_of_color([4, 2, 0]), hex_of_color([1, 0.5, 0]));
  close(color_of_hex(hex_of_color([0.8, 0.4, 0.1])), [0.8, 0.4, 0.1], 0.01);
});

test("the sky dial: overhead is its middle, ahead is up, and it reads back", () => {
  close(dial_from_direction([0, -1, 0], 0.4), [0, 0]);
  close(dial_from_direction([0, 0, 1], 0), [0, -1]);  // light from -Z, where the camera looks
  close(dial_from_direction([-1, 0, 0], 0), [1, 0]);  // light from the right
  for (const heading of [0, 1, -2.5]) {
    const direction = direction_from_dial(0.3, -0.5, heading);
    close(Math.hypot(...direction), 1);
    close(dial_from_direction(direction, heading), [0.3, -0.5]);
  }
});

test("the size asked for has the window's shape, keeps the limits and is even", () => {
  const limits = { max_width: 2048, max_height: 2048 };
  const stage = { width: 1200, height: 800 };
  assert.deepEqual(wanted_size("auto", stage, 2, limits, true), { width: 512, height: 342 });
  assert.deepEqual(wanted_size("auto", stage, 2, limits, false), { width: 1920, height: 1280 });
  assert.deepEqual(wanted_size("window", stage, 2, limits, true), { width: 2048, height: 1366 });
  assert.deepEqual(wanted_size("1280", { width: 390, height: 844 }, 3, limits, true), { width: 592, height: 1280 });
  assert.deepEqual(wanted_size("auto", { width: 0, height: 0 }, 1, limits, true), { width: 16, height: 16 });
});

test("the address keeps scene and camera, and nonsense in it is passed over", () => {
  const camera = { eye: [1, 2.5, -3], target: [0, 1, 0], yfov: 0.8 };
  assert.deepEqual(parse_hash(`#${hash_of("atrium", camera)}`), { scene: "atrium", camera });
  assert.deepEqual(parse_hash(`#${hash_of("venus", { index: 2 })}`), { scene: "venus", camera: { index: 2 } });
  for (const nonsense of [
    "#scene=../x", "#eye=1,2&target=0,0,0", "#eye=1,1,1&target=1,1,1", "#camera=-1", "#eye=a,b,c&target=1,2,3",
  ]) {
    assert.deepEqual(parse_hash(nonsense), {});
  }
});

test("names of files become names of scenes, and what cannot be opened is said beforehand", () => {
  assert.equal(scene_name_of("My Schöner Raum (2).GLB"), "my-schoner-raum-2");
  assert.equal(scene_name_of("日本.glb"), "model");
  assert.equal(scene_name_of(`${"x".repeat(90)}.glb`).length, 64);
  assert.equal(refusal_of({ name: "a.glb", size: 10 }, 100), null);
  assert.match(refusal_of({ name: "a.gltf", size: 10 }, 100), /\.glb/);
  assert.match(refusal_of({ name: "a.glb", size: 2e7 }, 1e7), /20 MB.*10 MB/);
});

test("words: problems, numbers, titles", () => {
  const problem = { title: "Not a model", detail: "the header is cut off", pointer: "/meshes/0" };
  assert.equal(words_of(problem, 422), "Not a model: the header is cut off (at /meshes/0).");
  assert.equal(words_of(null, 503), "The server answered 503.");
  assert.deepEqual([1522, 48210, 524288, 12.4e6].map(short_number), ["1,522", "48,210", "524k", "12.4M"]);
  assert.equal(scene_title("rigged-figure_2"), "Rigged figure 2");
});

test("a key's parameter sets name its codec; without them it is none", () => {
  const supplement = [0, 0, 1, 6, 5, 1, 7, 128];
  const parameters = [0, 0, 0, 1, 0x67, 0x42, 0xc0, 0x0d, 0xd9];
  assert.equal(codec_name(Uint8Array.from([...supplement, ...parameters])), "avc1.42C00D");
  for (const bytes of [[], supplement, [0, 0, 1, 0x67, 0x42, 0xc0]]) {
    assert.throws(() => codec_name(Uint8Array.from(bytes)), /parameter sets/);
  }
});
