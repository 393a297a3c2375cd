// SVG elements and numbers as text.

type Attributes = Record<string, string | number>;

export function svg(name: string, attributes: Attributes = {}, ...children: (Node | string)[]): SVGElement {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes))
    element.setAttribute(key, typeof value === "number" ? String(Math.round(value * 100) / 100) : value);
  element.append(...children);
  return element;
}

export function html<K extends keyof HTMLElementTagNameMap>(
  name: K,
  attributes: Record<string, string> = {},
  ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children);
  return element;
}

/** Four significant digits, a true minus sign. */
export function number(value: number, digits = 4): string {
  if (!isFinite(value)) return value > 0 ? "∞" : value < 0 ? "−∞" : "–";
  const text = value === 0 ? "0" : String(Number(value.toPrecision(digits)));
  return text.replaceAll("-", "−");
}

/** Beside ticks: as many digits as tell them apart, and a power of ten where that is shorter. */
export function tickTexts(ticks: number[]): string[] {
  const largest = Math.max(...ticks.map(Math.abs)),
    step = ticks.length > 1 ? ticks[1]! - ticks[0]! : largest;
  const digits = Math.min(Math.max(4, Math.ceil(Math.log10(largest / step)) + 1), 15);
  return ticks.map((tick) => {
    const long = number(tick, digits),
      short = Number(tick.toPrecision(digits)).toExponential().replace("e+", "e").replaceAll("-", "−");
    return long.length > 6 && short.length < long.length ? short : long;
  });
}

/** Ticks at 1, 2 or 5 times a power of ten inside [min, max], about `wanted` of them. */
export function niceTicks(min: number, max: number, wanted: number): number[] {
  if (!(max > min)) return [];
  const rough = (max - min) / wanted,
    power = 10 ** Math.floor(Math.log10(rough)),
    lead = rough / power;
  const step = power * (lead < 1.5 ? 1 : lead < 3.5 ? 2 : lead < 7.5 ? 5 : 10);
  const ticks = [];
  for (let k = Math.ceil(min / step); k * step <= max; ++k) ticks.push(k * step);
  return ticks;
}
