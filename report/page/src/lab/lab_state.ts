// What the lab is set to: a scene and the options of a command line. It is the page's address, too.

/** By name, without dashes; "" of an option that is on by its name alone. */
export type Options = Map<string, string>;

export interface LabState {
  scene: string;
  options: Options;
}

/** "--bias 1texel --snap --slope-bias=-1" as options. */
export function optionsOf(words: readonly string[]): Options {
  const options: Options = new Map();
  for (let i = 0; i < words.length; ++i) {
    const word = words[i]!,
      equals = word.indexOf("="),
      next = words[i + 1];
    if (!word.startsWith("--")) continue;
    if (equals >= 0) options.set(word.slice(2, equals), word.slice(equals + 1));
    else if (next !== undefined && !next.startsWith("--")) options.set(word.slice(2), words[++i]!);
    else options.set(word.slice(2), "");
  }
  return options;
}

export const wordsOf = (options: Options): string[] =>
  [...options].flatMap(([name, value]) =>
    value === "" ? [`--${name}`] : value.startsWith("-") ? [`--${name}=${value}`] : [`--${name}`, value],
  );

/** "#scene=fence&technique=pcf" */
export function addressOf({ scene, options }: LabState): string {
  return `#${new URLSearchParams([["scene", scene], ...options]).toString().replaceAll("%2C", ",").replaceAll("+", "%20")}`;
}

/** The state of an address; null where it has none. */
export function stateAt(hash: string): LabState | null {
  const all = new URLSearchParams(hash.replace(/^#/, "")),
    scene = all.get("scene");
  if (scene === null) return null;
  const options: Options = new Map([...all].filter(([name]) => name !== "scene" && /^[a-z][a-z0-9-]*$/.test(name)));
  return { scene, options };
}
