// Lights in the picture: a handle on each point and spot light, and a dial of the sky for the suns. A handle is dragged
// in the plane that faces the camera; shift or the wheel moves it in depth; arrow keys do the same for the focused one.
import { add, dot, scale } from "./vector.js";
import { edits_of_light, dial_from_direction, direction_from_dial, hex_of_color, light_title } from "./lights.js";
import { project, unproject, view_axes } from "./view_math.js";

const kMostHandles = 48;
const kNearestDepth = 0.01;   // metres
const kKeyStep = 0.02;        // of the depth, for an arrow key
const kDepthPerPx = 0.004;    // logarithm of the depth for a pixel of a shift-drag or of the wheel
const kDialStep = 0.04;       // of the dial's radius, for an arrow key
const kArrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

export class LightHandles {
  /**
   * @param {HTMLElement} layer holds the handles; lies over the picture
   * @param {HTMLElement} dial the sky's disc; hidden without a sun
   * @param {object} model a SessionModel
   * @param {object} owner `rect()`: the picture relative to `layer`; `push(input, at_ms)`: as Inputs has it
   */
  constructor(layer, dial, model, owner) {
    this.layer = layer;
    this.dial = dial;
    this.model = model;
    this.owner = owner;
    this.handles = new Map();  // light index -> element
    this.held = null;          // {index, depth, offset}
    model.subscribe((changed) => {
      if (changed.has("lights")) this.place();
    });
  }

  /** Puts every handle where its light is seen. Call when the view or the picture's rectangle has changed. */
  place() {
    const { lights, view } = this.model;
    const shown = new Set();
    let has_sun = false;
    const rect = this.owner.rect();
    for (const light of lights.slice(0, kMostHandles)) {
      const is_sun = light.kind === "directional";
      const handle = this.handle_of(light, is_sun);
      shown.add(light.index);
      has_sun ||= is_sun;
      if (is_sun) this.place_on_dial(handle, light, view);
      else this.place_in_picture(handle, light, view, rect);
      handle.style.setProperty("--light", hex_of_color(light.color));
      handle.classList.toggle("is-off", light.intensity === 0);
    }
    for (const [index, handle] of this.handles) {
      if (shown.has(index)) continue;
      handle.remove();
      this.handles.delete(index);
    }
    this.dial.hidden = !has_sun;
  }

  handle_of(light, is_sun) {
    const parent = is_sun ? this.dial : this.layer;
    let handle = this.handles.get(light.index);
    if (handle?.parentElement === parent) return handle;
    handle?.remove();
    handle = document.createElement("button");
    handle.type = "button";
    handle.className = `light-handle is-${light.kind}`;
    handle.dataset.light = light.index;
    handle.ariaLabel = `${light_title(light)}: drag or use the arrow keys to ${is_sun ? "turn" : "move"} it`;
    handle.title = light_title(light);
    this.listen(handle, light.index, is_sun);
    parent.append(handle);
    this.handles.set(light.index, handle);
    return handle;
  }

  listen(handle, index, is_sun) {
    handle.addEventListener("pointerdown", (event) => this.grab(event, handle, index));
    handle.addEventListener("pointermove", (event) => {
      if (this.held?.index !== index) return;
      if (is_sun) this.drag_sun(event, index);
      else this.drag(event, index);
    });
    for (const name of ["pointerup", "pointercancel", "lostpointercapture"]) {
      handle.addEventListener(name, () => this.release(handle));
    }
    handle.addEventListener("keydown", (event) => this.key(event, index, is_sun));
    if (is_sun) return;
    handle.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.move_in_depth(index, -Math.sign(event.deltaY) * 20, event.timeStamp);
    }, { passive: false });
  }

  place_on_dial(handle, light, view) {
    const [x, y] = dial_from_direction(light.direction, heading_of(view));
    handle.style.left = `${50 + 50 * x}%`;
    handle.style.top = `${50 + 50 * y}%`;
    handle.classList.toggle("is-below", light.direction[1] > 0.02);
  }

  place_in_picture(handle, light, view, rect) {
    const place = view && project(light.position, view, rect);
    const seen = place && place.depth > 0 && Math.abs(place.x - rect.x - rect.width / 2) < rect.width / 2 &&
      Math.abs(place.y - rect.y - rect.height / 2) < rect.height / 2;
    handle.hidden = !seen;
    if (seen) handle.style.transform = `translate(${place.x.toFixed(1)}px, ${place.y.toFixed(1)}px)`;
  }

  grab(event, handle, index) {
    if (event.button !== 0) return;
    handle.setPointerCapture(event.pointerId);
    handle.classList.add("is-held");
    const light = this.light(index);
    const at = this.position_of(event);
    const place = light.kind === "directional" ? at : project(light.position, this.model.view, this.owner.rect());
    this.held = { index, depth: place.depth, offset: { x: place.x - at.x, y: place.y - at.y }, y: at.y };
  }

  drag(event, index) {
    const at = this.position_of(event);
    const { held } = this;
    if (event.shiftKey) {
      this.move_in_depth(index, held.y - at.y, event.timeStamp);
      const place = project(this.light(index).position, this.model.view, this.owner.rect());
      held.depth = place.depth;
      held.offset = { x: place.x - at.x, y: place.y - at.y };
    } else {
      const { view } = this.model;
      const position = unproject(at.x + held.offset.x, at.y + held.offset.y, held.depth, view, this.owner.rect());
      this.change(index, { position }, event.timeStamp);
    }
    held.y = at.y;
  }

  drag_sun(event, index) {
    const disc = this.dial.getBoundingClientRect();
    const x = (event.clientX - disc.x) / (disc.width / 2) - 1;
    const y = (event.clientY - disc.y) / (disc.height / 2) - 1;
    this.change(index, { direction: direction_from_dial(x, y, heading_of(this.model.view)) }, event.timeStamp);
  }

  release(handle) {
    this.held = null;
    handle.classList.remove("is-held");
  }

  move_in_depth(index, further_px, at_ms) {
    const { view } = this.model;
    const { position } = this.light(index);
    const { forward } = view_axes(view);
    const depth = dot(position, forward) - dot(view.eye, forward);
    const wanted = Math.max(depth * Math.exp(further_px * kDepthPerPx), kNearestDepth);
    const along_ray = add(view.eye, scale(add(position, scale(view.eye, -1)), wanted / depth));
    this.change(index, { position: along_ray }, at_ms);
  }

  key(event, index, is_sun) {
    const arrow = kArrows[event.key];
    const depth = { PageUp: 20, PageDown: -20 }[event.key];
    if (!arrow && !(depth && !is_sun)) return;
    event.preventDefault();
    event.stopPropagation();
    const light = this.light(index);
    const { view } = this.model;
    if (depth) return this.move_in_depth(index, depth, event.timeStamp);
    if (is_sun) {
      const [x, y] = dial_from_direction(light.direction, heading_of(view));
      const direction = direction_from_dial(x + arrow[0] * kDialStep, y + arrow[1] * kDialStep, heading_of(view));
      return this.change(index, { direction }, event.timeStamp);
    }
    const { right, up, forward } = view_axes(view);
    const step = kKeyStep * (dot(light.position, forward) - dot(view.eye, forward));
    const move = add(scale(right, arrow[0] * step), scale(up, -arrow[1] * step));
    return this.change(index, { position: add(light.position, move) }, event.timeStamp);
  }

  change(index, change, at_ms) {
    this.owner.push({ edits: edits_of_light(this.light(index), change) }, at_ms);
    this.model.change_light(index, change);
  }

  light(index) {
    return this.model.lights.find((light) => light.index === index);
  }

  position_of(event) {
    const box = this.layer.getBoundingClientRect();
    return { x: event.clientX - box.x, y: event.clientY - box.y };
  }
}

/** Where the camera looks on the compass: radians from -Z towards +X. */
function heading_of(view) {
  if (!view) return 0;
  const { forward, right } = view_axes(view);
  // Straight up or down there is no heading of its own; the picture's right is still to the right of it.
  const is_upright = Math.hypot(forward[0], forward[2]) < 1e-4;
  return is_upright ? Math.atan2(right[2], right[0]) : Math.atan2(forward[0], -forward[2]);
}
