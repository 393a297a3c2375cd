// The words of the live figures in the page's language. In the code they are English, and a key at the same time; another language's
// figures.json (docs/lectures/README.md) has its words for each key, and the program puts it into the page's data.
import { counted } from "../number_text";
import { pageData } from "../parts";

const table = pageData<{ figure_words?: Record<string, string> }>().figure_words ?? {};

/** say("Ray's way"), or say`${made} of ${all} splits` with the key "{0} of {1} splits": English where the language has no words for it. */
export function say(words: string | TemplateStringsArray, ...values: (number | string)[]): string {
  const key = typeof words === "string" ? words : words.reduce((all, part, i) => `${all}{${i - 1}}${part}`);
  return (table[key] ?? key).replace(/\{(\d+)\}/g, (whole, i) => String(values[Number(i)] ?? whole));
}

/** "1 split", "4 splits", in the page's language. */
export const many = (count: number, one: string, several: string): string => counted(count, say(one), say(several));
