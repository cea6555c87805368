// Lights as the user handles them, and the edits that make them so on the server.
import { normalize, shortest_rotation, transform_direction, transform_point } from "./vector.js";

export const kLightKinds = {
  directional: { label: "Sun", unit: "lx" },
  point: { label: "Point light", unit: "cd" },
  spot: { label: "Spot light", unit: "cd" },
};

/** What to call a light that may have no name. */
export const light_title = (light) => light.name || `${kLightKinds[light.kind]?.label ?? "Light"} ${light.index + 1}`;

/**
 * The JSON Patch that gives `light` the members of `change`: position and direction in world space, color linear,
 * intensity in the light's unit. @param {object} light as the server describes it @param {object} change
 * @returns {{op: string, path: string, value: any}[]}
 */
export function edits_of_light(light, change) {
  const into_parent = light.parent_from_world;
  const edits = [];
  const replace = (path, value) => edits.push({ op: "replace", path, value });
  if (change.position) {
    const translation = into_parent ? transform_point(into_parent, change.position) : change.position;
    replace(`/nodes/${light.node}/translation`, translation);
  }
  if (change.direction) {
    const direction = into_parent ? transform_direction(into_parent, change.direction) : change.direction;
    replace(`/nodes/${light.node}/rotation`, shortest_rotation([0, 0, -1], normalize(direction)));
  }
  const properties = `/extensions/KHR_lights_punctual/lights/${light.index}`;
  if (change.color) replace(`${properties}/color`, change.color);
  if (change.intensity !== undefined) replace(`${properties}/intensity`, change.intensity);
  return edits;
}

const encode_srgb = (value) => (value <= 0.0031308 ? 12.92 * value : 1.055 * value ** (1 / 2.4) - 0.055);
const decode_srgb = (value) => (value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4);

/** A linear colour as #rrggbb; brighter than 1 is scaled down to keep its hue. @param {number[]} color */
export function hex_of_color(color) {
  const brightest = Math.max(...color, 1);
  const bytes = color.map((value) => Math.round(255 * encode_srgb(Math.max(value, 0) / brightest)));
  return `#${bytes.map((byte) => Math.min(byte, 255).toString(16).padStart(2, "0")).join("")}`;
}

/** #rrggbb as a linear colour. @param {string} hex */
export const color_of_hex = (hex) => [1, 3, 5].map((at) => decode_srgb(parseInt(hex.slice(at, at + 2), 16) / 255));

/**
 * Where a sun that shines along `direction` stands on a dial with the zenith in its middle and the horizon at its rim,
 * up being where the camera looks: [x, y] in -1..1, y down. Below the horizon it stands on the rim.
 * @param {number[]} direction unit @param {number} heading the camera's, radians from -Z towards +X
 */
export function dial_from_direction(direction, heading) {
  const towards = [-direction[0], -direction[1], -direction[2]];
  const radius = Math.min(Math.acos(Math.max(-1, Math.min(1, towards[1]))) / (Math.PI / 2), 1);
  const angle = Math.atan2(towards[0], -towards[2]) - heading;
  return [radius * Math.sin(angle), -radius * Math.cos(angle)];
}

/** The inverse of `dial_from_direction`; beyond the rim counts as the rim. */
export function direction_from_dial(x, y, heading) {
  const polar = Math.min(Math.hypot(x, y), 1) * (Math.PI / 2);
  const angle = Math.atan2(x, -y) + heading;
  const level = Math.sin(polar);
  return [-level * Math.sin(angle), -Math.cos(polar), level * Math.cos(angle)];
}
