// Vectors as arrays of three numbers, quaternions as [x, y, z, w], matrices as 16 numbers column by column (glTF's
// order). Every function returns a new value and changes none.

/** @typedef {[number, number, number]} Vec3 */

export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scale = (a, factor) => [a[0] * factor, a[1] * factor, a[2] * factor];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const length = (a) => Math.hypot(a[0], a[1], a[2]);
export const mix = (a, b, t) => [0, 1, 2].map((i) => a[i] + (b[i] - a[i]) * t);
export const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

export const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];

/** The unit vector along `a`; `fallback` if `a` has no length. */
export function normalize(a, fallback = [0, 0, -1]) {
  const size = length(a);
  return size > 1e-12 ? scale(a, 1 / size) : fallback;
}

/** The point `p` through the affine matrix `m`. */
export const transform_point = (m, p) =>
  [0, 1, 2].map((i) => m[i] * p[0] + m[4 + i] * p[1] + m[8 + i] * p[2] + m[12 + i]);

/** The direction `v` through the matrix `m`: its translation is left out. */
export const transform_direction = (m, v) => [0, 1, 2].map((i) => m[i] * v[0] + m[4 + i] * v[1] + m[8 + i] * v[2]);

/** The rotation by the smallest angle that turns the unit vector `from` into the unit vector `to`. */
export function shortest_rotation(from, to) {
  const w = 1 + dot(from, to);
  if (w < 1e-6) {  // opposite: half a turn about any axis across `from`
    const across = Math.abs(from[0]) > 0.9 ? [0, 1, 0] : [1, 0, 0];
    return [...normalize(cross(from, across)), 0];
  }
  const [x, y, z] = cross(from, to);
  const size = Math.hypot(x, y, z, w);
  return [x / size, y / size, z / size, w / size];
}
