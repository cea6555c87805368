// Words to the user that come and go: the banner while there is no connection, and short notes.
import { make, make_icon } from "./controls.js";

const kNoteMs = 3500;
const kTroubleMs = 12000;

/** Shows a note; trouble stays longer and can be sent away. @param {string} text @param {'good' | 'trouble'} kind */
export function show_note(text, kind = "good") {
  const note = make("div", { class: `toast is-${kind}` }, make("span", { textContent: text }));
  const timer = setTimeout(() => note.remove(), kind === "trouble" ? kTroubleMs : kNoteMs);
  const close = make("button", { type: "button", class: "icon-button", ariaLabel: "Dismiss" }, make_icon("close"));
  close.addEventListener("click", () => {
    clearTimeout(timer);
    note.remove();
  });
  note.append(close);
  const shelf = document.getElementById("toasts");
  [...shelf.children].filter((other) => other.firstChild.textContent === text).forEach((other) => other.remove());
  shelf.append(note);
  return note;
}

/** A note with a progress bar, until `done()`. @param {string} text */
export function show_progress(text) {
  const bar = make("progress", { max: 1, ariaLabel: text });
  const words = make("span", { textContent: text });
  const note = make("div", { class: "toast is-progress" }, words, bar);
  document.getElementById("toasts").append(note);
  return {
    set(share, new_text) {
      if (share === null) bar.removeAttribute("value");
      else bar.value = share;
      if (new_text) words.textContent = new_text;
    },
    done: () => note.remove(),
  };
}

/** The line across the top that says why the picture stands still. */
export class Banner {
  /** @param {() => void} on_try_now */
  constructor(on_try_now) {
    this.element = document.getElementById("banner");
    this.text = document.getElementById("banner-text");
    this.button = document.getElementById("banner-button");
    this.button.addEventListener("click", on_try_now);
    this.timer = 0;
  }

  hide() {
    clearInterval(this.timer);
    this.element.hidden = true;
  }

  /** @param {string} text @param {boolean} can_try */
  show(text, can_try) {
    clearInterval(this.timer);
    if (this.text.textContent !== text) this.text.textContent = text;
    this.button.hidden = !can_try;
    this.element.hidden = false;
  }

  /** Counts down to the next try. */
  count_down(text, wait_ms) {
    const until_ms = performance.now() + wait_ms;
    const tick = () => {
      const seconds = Math.ceil((until_ms - performance.now()) / 1000);
      this.text.textContent = seconds > 1 ? `${text} Trying again in ${seconds} s.` : `${text} Trying again.`;
    };
    this.show(text, wait_ms > 1500);
    tick();
    this.timer = setInterval(tick, 1000);
  }
}
