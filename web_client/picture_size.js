// How many pixels to ask the server for: the shape of the window, and as many as the chosen quality and the limits
// allow.

/** The user's choices: the picture's longer side, or the window's own pixels. */
export const kPictureSizes = [
  ["auto", "Automatic"],
  ["512", "Fast, 512 pixels"],
  ["1280", "1280 pixels (720p)"],
  ["1920", "1920 pixels (1080p)"],
  ["window", "Every pixel of the window"],
];

const kSmallest = 16;
const kAutoOnProcessor = 512;
const kAutoOnGpu = 1920;

/**
 * The size to ask for, in whole even pixels, in the shape of the window up to rounding.
 * @param {string} choice one of kPictureSizes
 * @param {{width: number, height: number}} stage the window's picture area in CSS pixels
 * @param {number} device_pixel_ratio
 * @param {{max_width: number, max_height: number}} limits the server's
 * @param {boolean} is_software true if the server renders without a GPU
 * @returns {{width: number, height: number}}
 */
export function wanted_size(choice, stage, device_pixel_ratio, limits, is_software) {
  const width = Math.max(stage.width, 1) * device_pixel_ratio;
  const height = Math.max(stage.height, 1) * device_pixel_ratio;
  const longer = Math.max(width, height);
  const automatic = Math.min(longer, is_software ? kAutoOnProcessor : kAutoOnGpu);
  const wanted = choice === "auto" ? automatic : choice === "window" ? longer : Number(choice);
  const factor = Math.min(wanted / longer, limits.max_width / width, limits.max_height / height);
  const even = (value, most) => Math.max(Math.min(2 * Math.round((value * factor) / 2), most - (most % 2)), kSmallest);
  return { width: even(width, limits.max_width), height: even(height, limits.max_height) };
}
