// The frame round the picture: title and status, the switch of light shown, the tools, the panel's door, the help.
import { scene_title } from "./session_model.js";

const kPhone = "(max-width: 720px), (max-height: 480px)";
const kPanelKey = "lightwell.panel";
const kConnecting = { connecting: "Connecting", waiting: "Waiting for the server", stopped: "Not connected" };

/**
 * @param {object} model a SessionModel @param {object} stats a Stats
 * @param {object} owner `push(input)`, `screenshot()`
 */
export function connect_chrome(model, stats, owner) {
  const title = document.getElementById("scene-title");
  const status = document.getElementById("status-text");
  const curtain = document.getElementById("curtain");
  const help = document.getElementById("help");
  const panel = document.getElementById("panel");
  const panel_button = document.getElementById("panel-button");
  const radios = [...document.querySelectorAll("#view-switch input")];
  const watches = document.body.classList.contains("watching");  // and changes nothing: no settings
  let connection = "connecting";

  function set_panel(open) {
    document.body.classList.toggle("panel-closed", !open);
    panel.inert = !open;
    panel_button.setAttribute("aria-expanded", String(open));
  }

  function toggle_panel() {
    if (watches) return;
    const open = document.body.classList.contains("panel-closed");
    localStorage.setItem(kPanelKey, open ? "open" : "closed");
    set_panel(open);
  }

  function show_status() {
    if (connection === "open" && stats.frame) curtain.hidden = true;
    const text = connection === "open" ? stats.summary() : kConnecting[connection];
    if (status.textContent !== text) status.textContent = text;
  }

  function show_connection(state, was_open) {
    connection = state;
    if (!was_open) curtain.querySelector("p").textContent = kConnecting[state] ?? "Making the first picture";
    show_status();
  }

  model.subscribe((changed) => {
    if (changed.has("scene")) {
      title.textContent = scene_title(model.scene);
      document.title = `${title.textContent} · Lightwell`;
    }
    if (changed.has("settings")) radios.forEach((radio) => (radio.checked = radio.value === model.settings.view));
  });
  radios.forEach((radio) => radio.addEventListener("change", () => owner.push({ settings: { view: radio.value } })));
  panel_button.addEventListener("click", toggle_panel);
  document.getElementById("screenshot-button").addEventListener("click", owner.screenshot);
  const open_help = () => help.showModal();
  document.getElementById("help-button").addEventListener("click", open_help);
  help.addEventListener("click", (event) => event.target === help && help.close());  // a click beside it
  setInterval(show_status, 250);

  const stored = localStorage.getItem(kPanelKey);
  const is_phone = matchMedia(kPhone).matches;
  set_panel(!is_phone && stored !== "closed" && !watches);
  return { show_connection, show_status, toggle_panel, open_help };
}
