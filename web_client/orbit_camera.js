// A camera that turns about a point: pure state and arithmetic, no events and no clock of its own.
import { add, clamp, dot, length, mix, normalize, scale, subtract } from "./vector.js";
import { unproject, view_axes } from "./view_math.js";

const kHighestElevation = (89.5 * Math.PI) / 180;
const kGlideSeconds = 0.35;
const kCoastSeconds = 0.12;    // a let-go turn loses 1 - 1/e of its speed in this time
const kWheelSeconds = 0.06;    // the same for what is left of a wheel's zoom
const kNearest = 0.05;         // the least distance to the target, in scene radii
const kSlowestCoast = 0.02;    // radians per second, or picture heights per second

/** @typedef {{eye: number[], target: number[], yfov: number}} View */
/** @typedef {{min: number[], max: number[]}} Bounds */

export class OrbitCamera {
  constructor() {
    this.target = [0, 0, 0];
    this.distance = 5;
    this.azimuth = 0;      // radians; 0: the camera is on the target's +Z side
    this.elevation = 0.3;  // radians above the horizon
    this.yfov = 0.8;
    this.scene_radius = 5;
    this.turn_speed = [0, 0];  // radians per second, left after a turn was let go
    this.zoom_left = 0;        // logarithm of the zoom still to come
    this.zoom_point = null;
    this.glide = null;
  }

  /** What the server is asked for. @returns {View} */
  view() {
    const level = Math.cos(this.elevation);
    const outward = [level * Math.sin(this.azimuth), Math.sin(this.elevation), level * Math.cos(this.azimuth)];
    return { eye: add(this.target, scale(outward, this.distance)), target: [...this.target], yfov: this.yfov };
  }

  /**
   * Takes over `view`. With `keep_target` it turns about the view's own target; else about the point of its axis that
   * is nearest to the scene's middle, since a scene's camera says where it looks but not at what.
   * @param {View} view @param {Bounds=} bounds @param {boolean=} keep_target
   */
  adopt(view, bounds, keep_target = false) {
    const offset = subtract(view.eye, view.target);
    const outward = normalize(offset, [0, 0, 1]);
    this.stop();
    this.yfov = view.yfov;
    this.elevation = clamp(Math.asin(clamp(outward[1], -1, 1)), -kHighestElevation, kHighestElevation);
    this.azimuth = Math.atan2(outward[0], outward[2]);
    this.distance = Math.max(length(offset), 1e-3);
    if (bounds) {
      const middle = mix(bounds.min, bounds.max, 0.5);
      this.scene_radius = Math.max(length(subtract(bounds.max, bounds.min)) / 2, 1e-3);
      if (!keep_target) {
        const along_axis = -dot(subtract(middle, view.eye), outward);
        this.distance = Math.max(along_axis, this.scene_radius * 0.25);
      }
    }
    this.target = subtract(view.eye, scale(outward, this.distance));
  }

  /** Stops every motion that goes on by itself. */
  stop() {
    this.turn_speed = [0, 0];
    this.zoom_left = 0;
    this.glide = null;
  }

  /** Turns by radians: to the right and up as the hand moves, so the scene follows it. */
  turn(right, up) {
    this.glide = null;
    this.azimuth -= right;
    this.elevation = clamp(this.elevation + up, -kHighestElevation, kHighestElevation);
  }

  /** Lets go of a turn at radians per second; it runs out by itself in `advance`. */
  coast(right, up) {
    this.turn_speed = [right, up];
  }

  /** Moves the scene by CSS pixels in the plane of the target: what was under the hand stays there. */
  pan(right_px, down_px, rect) {
    this.glide = null;
    const axes = view_axes(this.view());
    const metres = (2 * this.distance * Math.tan(this.yfov / 2)) / rect.height;
    this.target = add(this.target, add(scale(axes.right, -right_px * metres), scale(axes.up, down_px * metres)));
  }

  /**
   * Brings the scene nearer by `factor` (above 1: nearer), keeping what is at the CSS pixel `point` in the target's
   * plane where it is. At the nearest the camera goes on forwards, so that one can enter a room.
   * @param {number} factor @param {{x: number, y: number}} point @param {object} rect
   */
  zoom(factor, point, rect) {
    this.glide = null;
    const view = this.view();
    const nearest = this.scene_radius * kNearest;
    const held = unproject(point.x, point.y, this.distance, view, rect);
    const wanted = clamp(this.distance / factor, 1e-6, this.scene_radius * 30);
    this.target = add(held, scale(subtract(this.target, held), wanted / this.distance));
    this.distance = Math.max(wanted, nearest);
    if (wanted < nearest) {
      const { forward } = view_axes(view);
      this.target = add(this.target, scale(forward, nearest - wanted + (factor - 1) * nearest));
    }
  }

  /** As `zoom`, spread over the next moments so that a wheel's steps are not felt. */
  zoom_softly(factor, point) {
    this.zoom_left += Math.log(factor);
    this.zoom_point = point;
  }

  /** Glides to where all of `bounds` is seen from the present side. @param {Bounds} bounds @param {number} aspect */
  fit(bounds, aspect) {
    const radius = Math.max(length(subtract(bounds.max, bounds.min)) / 2, 1e-3);
    const narrow_half = Math.min(this.yfov / 2, Math.atan(Math.tan(this.yfov / 2) * aspect));
    this.stop();
    this.scene_radius = radius;
    this.glide = {
      from: { target: this.target, distance: this.distance },
      to: { target: mix(bounds.min, bounds.max, 0.5), distance: radius / Math.sin(narrow_half) },
      seconds: 0,
    };
  }

  /** True while something moves by itself. */
  moving() {
    return this.glide !== null || this.zoom_left !== 0 || this.turn_speed[0] !== 0 || this.turn_speed[1] !== 0;
  }

  /** Lets `seconds` pass over what moves by itself. @param {number} seconds @param {object} rect the picture's */
  advance(seconds, rect) {
    if (this.glide) {
      const glide = this.glide;
      glide.seconds += seconds;
      const t = clamp(glide.seconds / kGlideSeconds, 0, 1);
      const eased = 1 - (1 - t) ** 3;
      this.target = mix(glide.from.target, glide.to.target, eased);
      this.distance = Math.exp(Math.log(glide.from.distance) * (1 - eased) + Math.log(glide.to.distance) * eased);
      if (t === 1) this.glide = null;
    }
    if (this.turn_speed[0] || this.turn_speed[1]) {
      const [right, up] = this.turn_speed;
      const left = Math.exp(-seconds / kCoastSeconds);
      this.turn(right * kCoastSeconds * (1 - left), up * kCoastSeconds * (1 - left));
      this.turn_speed = Math.hypot(right, up) * left < kSlowestCoast ? [0, 0] : [right * left, up * left];
    }
    if (this.zoom_left) {
      const share = 1 - Math.exp(-seconds / kWheelSeconds);
      const step = Math.abs(this.zoom_left) < 0.002 ? this.zoom_left : this.zoom_left * share;
      this.zoom_left -= step;
      this.zoom(Math.exp(step), this.zoom_point, rect);
    }
  }
}
