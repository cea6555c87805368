// Watching a session that someone else drives: an address with #watch=SESSION. The picture is the driver's until the
// watcher moves the camera; then it is the watcher's own, in the size of the watcher's window, until given back.
import { input, look } from "./protocol.js";

export class Watching {
  /**
   * @param {string | undefined} session which one; undefined: this page drives a session of its own
   * @param {object} owner `size()`: pixels to ask for; `push(input)`; `copy_link()`; `returned()`: sees the driver's again
   */
  constructor(session, owner) {
    this.session = session;
    this.owner = owner;
    this.camera = undefined;  // the watcher's own
    this.button = document.getElementById("watch-button");
    this.button.addEventListener("click", () => (this.session ? this.give_back() : owner.copy_link()));
    document.body.classList.toggle("watching", Boolean(session));
    this.show();
  }

  get role() {
    return this.session ? "viewer" : "driver";
  }

  /** Whether the user may ask for this: watchers move a camera, and nothing else. */
  allows(change) {
    return !this.session || Object.keys(change).every((member) => member === "camera");
  }

  /** The message that asks for a change: a driver's input, or a watcher's look, which takes no more than a camera. */
  message(seq, change) {
    if (!this.session) return input(seq, change);
    if (change.give_back) this.camera = undefined;
    else if ("camera" in change) this.camera = change.camera;
    this.show();
    return look(seq, this.camera === undefined ? {} : { camera: this.camera, ...this.owner.size() });
  }

  give_back() {
    this.owner.push({ give_back: true });
    this.owner.returned();
  }

  /** The server has no room for another look, or the scene has changed. */
  lost() {
    this.camera = undefined;
    this.show();
  }

  show() {
    const text = !this.session ? "Copy a link for watchers" : "See what the driver sees";
    this.button.title = text;
    this.button.setAttribute("aria-label", text);
    this.button.disabled = Boolean(this.session) && this.camera === undefined;
  }
}

/** The address under which others watch a session. @param {URL} base @param {string} session */
export function watch_link(base, session) {
  return new URL(`#watch=${session}`, base).href;
}
