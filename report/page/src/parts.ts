// The large parts of the page's data: in the page itself, or in files beside it. A page from disk may fetch nothing, so
// that these files are scripts that leave their value in gnomonFiles (../../shell.h).

/** The fixed colours and scales of all pictures (compare/result/palette.h), as "#d55e00"; nine stops of each scale. */
export interface Palette extends Record<"false_shadow" | "missed_shadow" | "surely_lit" | "surely_shadowed" | "traced", string> {
  viridis: string[];
  magma: string[];
}

interface Parted {
  kind: "compare" | "judged" | "sheet" | "shimmer" | "sweep";
  parts?: Record<string, unknown>;
  folder?: string;
  palette: Palette;
}

const data = JSON.parse(document.getElementById("page-data")!.textContent!) as Parted;

/** What the page's data says beside its parts. */
export const pageData = <T>(): T => data as unknown as T;
export const palette = data.palette;
export const pageKind = data.kind;
/** The parts are files beside the page. */
export const isBeside = data.folder !== undefined;

declare global {
  var gnomonFiles: Record<string, unknown> | undefined; // eslint-disable-line no-var
}

/** Loads a data file; its value is forgotten by the page as soon as it is handed on. */
export function fromFile<T>(path: string, name: string): Promise<T> {
  return new Promise((resolve, reject) => {
    const script = document.createElement("script");
    script.src = path;
    script.onload = () => {
      const value = globalThis.gnomonFiles?.[name];
      delete globalThis.gnomonFiles?.[name];
      script.remove();
      if (value === undefined) reject(new Error(`${path} does not hold ${name}`));
      else resolve(value as T);
    };
    script.onerror = () => {
      script.remove();
      reject(new Error(`${path} is missing: it belongs beside this page`));
    };
    document.head.append(script);
  });
}

export function part<T>(name: string): Promise<T> {
  return data.parts ? Promise.resolve(data.parts[name] as T) : fromFile(`${data.folder}/${name}.js`, name);
}

/** Takes parts that came later, in the place of all whose names begin so. */
export function putParts(prefix: string, parts: Record<string, unknown>): void {
  for (const name of Object.keys(data.parts!)) if (name.startsWith(prefix)) delete data.parts![name];
  Object.assign(data.parts!, parts);
}
