// The panel's list of lights: switch, colour and intensity of each.
import { color_of_hex, edits_of_light, hex_of_color, kLightKinds, light_title } from "./lights.js";
import { make } from "./controls.js";

const kSliderSpan = 3;      // decades below and above the intensity a light came with
const kSliderSteps = 600;

export class LightPanel {
  /**
   * @param {HTMLElement} section the panel's place for it @param {object} model a SessionModel
   * @param {(input: object, at_ms?: number) => void} push as Inputs has it
   */
  constructor(section, model, push) {
    this.section = section;
    this.model = model;
    this.push = push;
    this.rows = new Map();
    this.scene = null;
    model.subscribe((changed) => changed.has("lights") && this.show());
  }

  show() {
    const { lights } = this.model;
    if (this.scene !== this.model.scene) this.clear();
    this.scene = this.model.scene;
    for (const light of lights) this.row_of(light).show(light);
    for (const [index, row] of this.rows) {
      if (lights.some((light) => light.index === index)) continue;
      row.element.remove();
      this.rows.delete(index);
    }
    this.section.classList.toggle("is-empty", lights.length === 0);
  }

  clear() {
    this.rows.forEach((row) => row.element.remove());
    this.rows.clear();
  }

  row_of(light) {
    if (!this.rows.has(light.index)) this.rows.set(light.index, this.make_row(light));
    return this.rows.get(light.index);
  }

  make_row(first) {
    const title = light_title(first);
    const { unit } = kLightKinds[first.kind] ?? { unit: "" };
    const middle = first.intensity > 0 ? first.intensity : 100;
    let last_on = middle;
    const power = make("input", { type: "checkbox", class: "toggle", role: "switch", ariaLabel: `${title} on` });
    const color = make("input", { type: "color", ariaLabel: `Colour of ${title}` });
    const slider = make("input", {
      type: "range", min: -kSliderSteps, max: kSliderSteps, ariaLabel: `Intensity of ${title}`,
    });
    const number = make("output");
    const name = make("span", { class: "light-name", textContent: title, title });
    const element = make("div", { class: "light-row" }, color, name, power, slider, number);
    const change = (members, event) => {
      const light = this.model.lights.find((entry) => entry.index === first.index);
      this.push({ edits: edits_of_light(light, members) }, event.timeStamp);
      this.model.change_light(first.index, members);
    };
    const intensity_of = (position) => middle * 10 ** ((kSliderSpan * position) / kSliderSteps);
    slider.addEventListener("input", (event) => change({ intensity: intensity_of(Number(slider.value)) }, event));
    power.addEventListener("change", (event) => change({ intensity: power.checked ? last_on : 0 }, event));
    color.addEventListener("input", (event) => change({ color: color_of_hex(color.value) }, event));
    const show = (light) => {
      if (light.intensity > 0) last_on = light.intensity;
      power.checked = light.intensity > 0;
      element.classList.toggle("is-off", !power.checked);
      if (document.activeElement !== color) color.value = hex_of_color(light.color);
      slider.value = (Math.log10(last_on / middle) * kSliderSteps) / kSliderSpan;
      slider.style.setProperty("--filled", `${50 + (50 * slider.value) / kSliderSteps}%`);
      number.textContent = power.checked ? `${digits(light.intensity)} ${unit}` : "Off";
      slider.setAttribute("aria-valuetext", number.textContent);
    };
    this.section.append(element);
    return { element, show };
  }
}

/** Three digits that matter, without an exponent. */
const digits = (value) => Number(value.toPrecision(3)).toLocaleString("en", { maximumSignificantDigits: 3 });
