// Keys that work anywhere on the page, save where the focused control has a use for them itself.

const kTyping = "input:not([type=range]):not([type=radio]):not([type=checkbox]), select, textarea, [contenteditable]";
const kPressing = "button, summary, select, a[href], input[type=checkbox]";

/** @param {Object<string, () => void>} actions by `event.key`, letters in lower case */
export function listen_for_shortcuts(actions) {
  addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.repeat || event.defaultPrevented) return;
    if (document.querySelector("dialog[open]")) return;
    const focused = document.activeElement;
    if (focused?.matches(kTyping)) return;
    if (event.key === " " && focused?.matches(kPressing)) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (!(key in actions)) return;
    event.preventDefault();
    actions[key]();
  });
  // After a click the keys belong to the picture again; a control that was reached by Tab keeps them.
  addEventListener("click", (event) => {
    const was_pointer = event.detail > 0;
    const pressed = event.target.closest?.("button, .segmented label");
    if (!was_pointer || !pressed || pressed.closest("dialog")) return;
    setTimeout(() => document.getElementById("picture").focus({ preventScroll: true }));  // after the click's own focus
  });
}
