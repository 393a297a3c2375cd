// One row of a panel: a name, a control for its kind, and a note that is shown while the row is looked at.
import "./controls.css";
import { pageData } from "../parts";
import { html } from "../svg";
import type { LabFacts } from "./engine";
import { packed } from "./one_file";

let rows = 0;

/** What a slider's place means, and back: places are whole numbers from 0 to `steps`. */
export interface SliderScale {
  steps: number;
  valueAt(place: number): number;
  placeOf(value: number): number;
}

export const linearScale = (from: number, to: number, steps = 400): SliderScale => ({
  steps,
  valueAt: (place) => from + ((to - from) * place) / steps,
  placeOf: (value) => Math.round((steps * (value - from)) / (to - from)),
});
export const logarithmicScale = (from: number, to: number, steps = 400): SliderScale => ({
  steps,
  valueAt: (place) => from * (to / from) ** (place / steps),
  placeOf: (value) => Math.round((steps * Math.log(Math.max(value, from) / from)) / Math.log(to / from)),
});
export const powersOfTwo = (from: number, to: number): SliderScale => ({
  steps: Math.round(Math.log2(to / from)),
  valueAt: (place) => from * 2 ** place,
  placeOf: (value) => Math.round(Math.log2(value / from)),
});

/** Four significant digits: what a slider gives is read and typed again. */
export const tidy = (value: number): number => Number(value.toPrecision(4));

const { manual } = pageData<LabFacts>();

/** A panel, and a question mark that leads to the manual's paragraph on its first option, where there is a manual. */
export function panel(name: string, option: string, ...rows: HTMLElement[]): HTMLFieldSetElement {
  const legend = html("legend", {}, name);
  if (manual)
    legend.append(
      " ",
      html(
        "a",
        {
          href: new URL(`${manual}#--${option}`, packed?.from ?? location.href).href,
          target: "_blank",
          class: "manual",
          "aria-label": `${name} in the manual`,
        },
        "?",
      ),
    );
  return html("fieldset", {}, legend, ...rows);
}

export interface Row {
  element: HTMLElement;
  show(value: string): void;
}

function row(name: string, note: string, ...controls: HTMLElement[]): { element: HTMLElement; id: string } {
  const id = `row-${++rows}`,
    label = html("label", { for: id }, name);
  const words = html("p", { class: "note", id: `${id}-note` }, note);
  controls[0]!.id = id;
  controls[0]!.setAttribute("aria-describedby", words.id);
  return { element: html("div", { class: "row" }, label, html("div", { class: "controls" }, ...controls), words), id };
}

/** A number by a slider and by typing; `changed` has it as text. */
export function sliderRow(name: string, unit: string, note: string, scale: SliderScale, changed: (text: string) => void): Row {
  const box = html("input", { type: "text", inputmode: "decimal", autocomplete: "off" });
  const slider = html("input", { type: "range", min: "0", max: String(scale.steps), step: "1" });
  const made = row(unit === "" ? name : `${name}, ${unit}`, note, box, slider);
  slider.setAttribute("aria-label", `${name}, slider`);
  slider.addEventListener("input", () => {
    box.value = String(tidy(scale.valueAt(Number(slider.value))));
    changed(box.value);
  });
  box.addEventListener("change", () => changed(box.value.trim()));
  return {
    element: made.element,
    show: (value) => {
      if (document.activeElement !== box) box.value = value;
      if (document.activeElement === slider && slider.matches(":active")) return;
      slider.value = String(scale.placeOf(parseFloat(value)));
      slider.setAttribute("aria-valuetext", unit === "" ? value : `${value} ${unit}`);
    },
  };
}

export function textRow(name: string, unit: string, note: string, changed: (text: string) => void): Row {
  const box = html("input", { type: "text", autocomplete: "off", class: "wide" });
  box.addEventListener("change", () => changed(box.value.trim()));
  return {
    element: row(unit === "" ? name : `${name}, ${unit}`, note, box).element,
    show: (value) => {
      if (document.activeElement !== box) box.value = value;
    },
  };
}

export function switchRow(name: string, note: string, changed: (on: boolean) => void): Row {
  const box = html("input", { type: "checkbox" });
  box.addEventListener("change", () => changed(box.checked));
  const { element } = row(name, note, box);
  element.classList.add("switch");
  return {
    element,
    show: (value) => {
      box.checked = value === "on";
    },
  };
}

export function choiceRow(name: string, note: string, choices: readonly string[], changed: (choice: string) => void): Row {
  const select = html("select", { class: "wide" }, ...choices.map((choice) => html("option", { value: choice }, choice)));
  select.addEventListener("change", () => changed(select.value));
  return {
    element: row(name, note, select).element,
    show: (value) => {
      select.value = value;
    },
  };
}
