// The address keeps the scene and the camera, so that it can be sent to someone:
// #scene=atrium&eye=1,2,3&target=0,1,0&yfov=0.8

const digits = (value) => Number(value.toFixed(3));

/** @param {string} scene @param {object | null} camera as a session has it @returns {string} without the # */
export function hash_of(scene, camera) {
  const parts = scene ? [`scene=${scene}`] : [];
  if (camera && "index" in camera) parts.push(`camera=${camera.index}`);
  if (camera?.eye) {
    parts.push(`eye=${camera.eye.map(digits)}`, `target=${camera.target.map(digits)}`, `yfov=${digits(camera.yfov)}`);
  }
  return parts.join("&");
}

/** The inverse; what is missing or makes no sense is left out. @returns {{scene?: string, camera?: object, watch?: string}} */
export function parse_hash(hash) {
  const query = new URLSearchParams(hash.replace(/^#/, ""));
  const result = {};
  if (/^[a-z0-9_-]{1,64}$/.test(query.get("scene") ?? "")) result.scene = query.get("scene");
  if (/^[A-Za-z0-9_-]{1,64}$/.test(query.get("watch") ?? "")) result.watch = query.get("watch");
  const index = query.get("camera");
  if (/^\d{1,4}$/.test(index ?? "")) result.camera = { index: Number(index) };
  const point = (name) => (query.get(name) ?? "").split(",").map((text) => (text.trim() === "" ? NaN : Number(text)));
  const [eye, target, yfov] = [point("eye"), point("target"), Number(query.get("yfov") ?? 0.8)];
  const is_point = (numbers) => numbers.length === 3 && numbers.every(Number.isFinite);
  const differ = is_point(eye) && is_point(target) && eye.some((value, i) => value !== target[i]);
  if (differ && yfov > 0 && yfov < Math.PI) result.camera = { eye, target, yfov };
  return result;
}
