// The panel's controls: a labelled row each, made from a description. A control shows what it is given with `set` and
// tells only what the user does.

let last_id = 0;

/** An element with properties and children; `class` and `data-*` as in HTML. */
export function make(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name === "class" || name.includes("-")) element.setAttribute(name, value);
    else element[name] = value;
  }
  element.append(...children);
  return element;
}

/** An icon of icons.svg, hidden from screen readers. */
export function make_icon(name) {
  const kSvg = "http://www.w3.org/2000/svg";
  const icon = document.createElementNS(kSvg, "svg");
  icon.setAttribute("class", "icon");
  icon.setAttribute("aria-hidden", "true");
  const use = document.createElementNS(kSvg, "use");
  use.setAttribute("href", `icons.svg#${name}`);
  icon.append(use);
  return icon;
}

function labelled_row(kind, label, hint, input, ...others) {
  input.id = `control-${(last_id += 1)}`;
  const text = make("label", { htmlFor: input.id, textContent: label, title: hint ?? "" });
  return make("div", { class: `row row-${kind}` }, text, input, ...others);
}

/**
 * A slider over numbers.
 * @param {object} options `label`, `hint`; `values` (the numbers it can have, ascending) or `min`, `max`, `step`;
 *   `format(value)`: the text beside it; `on_input(value, at_ms)`: the user moved it
 * @returns {{row: HTMLElement, set: (value: number) => void, enable: (enabled: boolean) => void,
 *   limit: (max: number) => void}} `limit` takes away the values above `max`
 */
export function make_slider({ label, hint, values, min, max, step, format = String, on_input }) {
  const range = values ? { min: 0, max: values.length - 1, step: 1 } : { min, max, step };
  const input = make("input", { type: "range", ...range });
  const output = make("output");
  const row = labelled_row("slider", label, hint, input, output);
  const show = (value) => {
    output.textContent = format(value);
    input.setAttribute("aria-valuetext", format(value));
    const share = (input.value - input.min) / (input.max - input.min || 1);
    input.style.setProperty("--filled", `${100 * share}%`);
  };
  const current = () => (values ? values[Number(input.value)] : Number(input.value));
  input.addEventListener("input", (event) => {
    show(current());
    on_input(current(), event.timeStamp);
  });
  return {
    row,
    set(value) {
      input.value = values ? nearest_index(values, value) : value;
      show(value);
    },
    enable(enabled) {
      input.disabled = !enabled;
      row.classList.toggle("is-disabled", !enabled);
    },
    limit(highest) {
      input.max = values ? Math.max(values.filter((value) => value <= highest).length - 1, 0) : Math.min(max, highest);
    },
  };
}

/**
 * A drop-down list. @param {object} options `label`, `hint`, `options` [[value, text]], `on_change(value)`
 * @returns {{row: HTMLElement, set: (value: string) => void, offer: (options: string[][]) => void}}
 */
export function make_choice({ label, hint, options, on_change }) {
  const select = make("select");
  const row = labelled_row("choice", label, hint, select);
  let value_now = "";
  const offer = (offered) => {
    const key = JSON.stringify(offered);
    if (select.dataset.offered === key) return;
    select.dataset.offered = key;
    select.replaceChildren(...offered.map(([value, text]) => make("option", { value, textContent: text })));
    select.value = value_now;
  };
  offer(options);
  select.addEventListener("change", () => on_change((value_now = select.value)));
  const set = (value) => {
    value_now = value;
    select.value = value;
  };
  return { row, set, offer };
}

/** A switch. @param {object} options `label`, `hint`, `on_change(checked)` */
export function make_toggle({ label, hint, on_change }) {
  const input = make("input", { type: "checkbox", class: "toggle", role: "switch" });
  input.addEventListener("change", () => on_change(input.checked));
  return { row: labelled_row("toggle", label, hint, input), set: (checked) => (input.checked = checked) };
}

/** The index of the value nearest to `wanted` on a logarithmic scale. */
export function nearest_index(values, wanted) {
  const away = values.map((value) => Math.abs(Math.log(value / wanted)));
  return away.indexOf(Math.min(...away));
}
