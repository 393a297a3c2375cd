// The result document that the page shows, whole, as it stands in the page.
import { markup, type Markup } from "./template";
import { grouped, signedNumber, unsignedNumber } from "./number_text";

const text = document.getElementById("result")?.textContent;
const result: unknown = text ? JSON.parse(text) : null;

export const resultDocument = <T>(): T => result as T;

/** "lights.0.error.wrong": a key of the document. */
function valueAt(key: string): unknown {
  let value = result;
  for (const part of key.split(".")) value = (value as Record<string, unknown> | null | undefined)?.[part];
  return value;
}

/** A number of the document, not a number where it has none there. */
export function numberAt(key: string): number {
  const value = valueAt(key);
  return typeof value === "number" ? value : NaN;
}

/** A number of the document as text, with its key: <data value="0.041" data-key="lights.0.error.wrong_fraction">4.1 %</data>.
    `shown`: what the text is made of where that is not the number itself. */
export function keyed(key: string, words: (value: number) => string, shown?: number): Markup {
  const value = numberAt(key);
  return markup`<data value="${isFinite(value) ? value : "null"}" data-key="${key}">${words(shown ?? value)}</data>`;
}

export const keyedCount = (key: string): Markup => keyed(key, grouped);

/** A number with what there is so much of: "1 pixel", "12,713 pixels", of plainNumber "1.73 texels". */
export const keyedThings = (key: string, thing: string, words = grouped): Markup =>
  markup`${keyed(key, words)} ${thing}${words(numberAt(key)) === "1" ? "" : "s"}`;

/** What something is less by, a number >= 0: shown with a minus sign before it. */
export const keyedDecrease = (key: string): Markup => markup`${numberAt(key) > 0 ? "−" : ""}${keyed(key, unsignedNumber)}`;

/** A difference of two means is shown as 0 where it is no more than what rounding leaves of `magnitude`
    (twin: ../../../compare/ladder/budget.h). */
export const beyondRounding = (difference: number, magnitude: number): number =>
  Math.abs(difference) <= 2 ** -37 * magnitude ? 0 : difference;
export const keyedSigned = (key: string, magnitude: number): Markup => keyed(key, signedNumber, beyondRounding(numberAt(key), magnitude));
