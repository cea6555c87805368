// A model from the user's disk to the server: dropped on the page or chosen with the button.
import { show_note, show_progress } from "./notices.js";
import { words_of } from "./problem.js";

const kNameLength = 64;

/** A scene name the server takes, made from a file's name. @param {string} file_name */
export function scene_name_of(file_name) {
  const name = file_name
    .replace(/\.[^.]*$/, "")
    .normalize("NFKD")
    .replace(/[\u0300-\u036f]/g, "")
    .toLowerCase()
    .replace(/[^a-z0-9_-]+/g, "-")
    .replace(/^-+|-+$/g, "")
    .slice(0, kNameLength);
  return name || "model";
}

/**
 * Why a file cannot be opened, said before any of it is sent; null if it may.
 * @param {File} file @param {number} most_bytes @returns {string | null}
 */
export function refusal_of(file, most_bytes) {
  if (/\.gltf$/i.test(file.name)) {
    return `${file.name} keeps its data in other files. Export it as .glb, which holds everything.`;
  }
  if (!/\.glb$/i.test(file.name)) return `${file.name} is not a .glb file.`;
  if (file.size === 0) return `${file.name} is empty.`;
  if (file.size > most_bytes) {
    const size_in_mb = (bytes) => (bytes / 1e6).toFixed(bytes < 1e7 ? 1 : 0);
    return `${file.name} has ${size_in_mb(file.size)} MB; this server takes up to ${size_in_mb(most_bytes)} MB.`;
  }
  return null;
}

export class Uploader {
  /**
   * @param {URL} base the folder the viewer is served from
   * @param {import("./access.js").Access} access
   * @param {object} owner `most_bytes()`, `is_builtin(name)`, and `opened(name)`: the server has the scene now
   */
  constructor(base, access, owner) {
    this.base = base;
    this.access = access;
    this.owner = owner;
    this.drags = 0;
    this.zone = document.getElementById("drop-zone");
    this.input = document.getElementById("file-input");
    this.input.addEventListener("change", () => {
      this.take(this.input.files);
      this.input.value = "";
    });
    const has_files = (event) => event.dataTransfer?.types.includes("Files");
    const on = (name, act) => addEventListener(name, (event) => has_files(event) && act(event));
    on("dragenter", () => this.show_zone((this.drags += 1)));
    on("dragleave", () => this.show_zone((this.drags -= 1)));
    on("dragover", (event) => event.preventDefault());
    on("drop", (event) => {
      event.preventDefault();
      this.show_zone((this.drags = 0));
      this.take(event.dataTransfer.files);
    });
  }

  /** Opens the file dialogue. */
  choose() {
    this.input.click();
  }

  show_zone(drags) {
    this.zone.hidden = drags <= 0;
  }

  async take(files) {
    if (files.length === 0) return;
    const file = [...files].find((entry) => /\.glb$/i.test(entry.name)) ?? files[0];
    const refusal = refusal_of(file, this.owner.most_bytes());
    if (refusal) return show_note(refusal, "trouble");
    let name = scene_name_of(file.name);
    if (this.owner.is_builtin(name)) name = `${name.slice(0, kNameLength - 3)}-my`;
    const progress = show_progress(`Sending ${file.name}`);
    try {
      await this.put(name, file, (share) => {
        progress.set(share < 1 ? share : null, share < 1 ? undefined : `Reading ${file.name}`);
      });
      await this.owner.opened(name);
      show_note(`${file.name} is open.`);
    } catch (error) {
      show_note(`${file.name} was not opened. ${error.message}`, "trouble");
    } finally {
      progress.done();
    }
  }

  /** XMLHttpRequest, since fetch does not tell how far it is. */
  put(name, file, on_progress) {
    return new Promise((resolve, reject) => {
      const request = new XMLHttpRequest();
      request.open("PUT", new URL(`v1/scenes/${name}`, this.base));
      const headers = { "content-type": "model/gltf-binary", ...this.access.headers() };
      for (const [name, value] of Object.entries(headers)) request.setRequestHeader(name, value);
      request.upload.onprogress = (event) => event.lengthComputable && on_progress(event.loaded / event.total);
      request.onerror = () => reject(new Error("The connection broke off."));
      request.onload = () => {
        if (request.status < 300) return resolve();
        reject(new Error(words_of(parse_json(request.responseText), request.status)));
      };
      request.send(file);
    });
  }
}

function parse_json(text) {
  try {
    return JSON.parse(text);
  } catch {
    return null;
  }
}
