// Where a point of the scene stands in the picture, and back. A view is {eye, target, yfov}: metres and radians, up is
// +Y. A rectangle is {x, y, width, height} in CSS pixels, y down.
import { add, cross, dot, normalize, scale, subtract } from "./vector.js";

/** The camera's axes in world space: unit vectors to the right, up and into the picture. */
export function view_axes(view) {
  const forward = normalize(subtract(view.target, view.eye));
  // A camera that looks straight up or down has no up of +Y: its right is then +X.
  const right = normalize(cross(forward, [0, 1, 0]), [1, 0, 0]);
  return { right, up: cross(right, forward), forward };
}

/** CSS pixels per metre at one metre before the camera. */
export const pixels_per_tangent = (view, rect) => rect.height / (2 * Math.tan(view.yfov / 2));

/**
 * Where `point` is seen: {x, y} in CSS pixels, and its depth in metres along the view's axis. Not in front of the
 * camera where the depth is not positive; x and y are then without meaning.
 */
export function project(point, view, rect) {
  const { right, up, forward } = view_axes(view);
  const offset = subtract(point, view.eye);
  const depth = dot(offset, forward);
  const pixels = pixels_per_tangent(view, rect) / depth;
  return {
    x: rect.x + rect.width / 2 + dot(offset, right) * pixels,
    y: rect.y + rect.height / 2 - dot(offset, up) * pixels,
    depth,
  };
}

/** The point seen at CSS pixel (x, y) at `depth` metres along the view's axis: the inverse of `project`. */
export function unproject(x, y, depth, view, rect) {
  const { right, up, forward } = view_axes(view);
  const metres = depth / pixels_per_tangent(view, rect);
  const across = scale(right, (x - rect.x - rect.width / 2) * metres);
  const upwards = scale(up, (rect.y + rect.height / 2 - y) * metres);
  return add(view.eye, add(scale(forward, depth), add(across, upwards)));
}

/**
 * Where a picture of `aspect` (width over height) lies in `box`, centred: filling it when the shapes all but agree
 * (sizes are whole pixels, so they never agree quite), else whole inside it.
 */
export function picture_rect(aspect, box) {
  const fill = shapes_agree(aspect, box);
  const wider = aspect > box.width / box.height;
  const by_width = wider !== fill;
  const width = by_width ? box.width : box.height * aspect;
  const height = by_width ? box.width / aspect : box.height;
  return { x: box.x + (box.width - width) / 2, y: box.y + (box.height - height) / 2, width, height };
}

/** True when a picture of `aspect` may fill `box` with at most 2 % cut off. */
export const shapes_agree = (aspect, box) => Math.abs(Math.log((aspect * box.height) / box.width)) < 0.02;
