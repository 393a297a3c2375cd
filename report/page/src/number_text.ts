// Numbers as people read them (twin: ../../../compare/result/number_text.cpp).

/** So many decimals; what lies in the middle between two goes to the even digit, as in C++. */
function withDecimals(value: number, decimals: number): string {
  const exact = value.toFixed(Math.min(decimals + 60, 100)),
    cut = exact.indexOf(".") + 1 + decimals,
    kept = exact.slice(0, cut).replace(/\.$/, "");
  return /^50*$/.test(exact.slice(cut)) && Number(kept.at(-1)) % 2 === 0 ? kept : value.toFixed(decimals);
}

/** At most so many significant digits, as "%g" writes them: 0.0123, 1.2e-05, 1e+06. */
export function general(value: number, digits: number): string {
  if (value === 0) return "0";
  const [mantissa, power] = value.toExponential(digits - 1).split("e") as [string, string],
    exponent = Number(power);
  const short = mantissa.includes(".") ? mantissa.replace(/\.?0+$/, "") : mantissa;
  if (exponent < -4 || exponent >= digits) return `${short}e${exponent < 0 ? "-" : "+"}${String(Math.abs(exponent)).padStart(2, "0")}`;
  return withDecimals(value, Math.max(0, digits - 1 - exponent))
    .replace(/(\.\d*?)0+$/, "$1")
    .replace(/\.$/, "");
}

// From here on three digits would round to a thousand, which has an exponent.
const firstOfFourDigits = 999.5;

export const grouped = (count: number): string => String(count).replace(/\B(?=(\d{3})+$)/g, ",");

/** "1 pixel", "12,713 pixels" */
export const counted = (count: number, unit: string, units = `${unit}s`): string => `${grouped(count)} ${count === 1 ? unit : units}`;

/** "0.42 %", "4.1 %", "12.3 %"; never 100 % of less than all. */
export function percent(share: number): string {
  const p = 100 * share;
  if (!isFinite(p)) return "unknown";
  if (p === 0 || p === 100) return `${p} %`;
  if (p > 0 && p < 0.001) return "less than 0.001 %";
  if (p > 99.99 && p < 100) return "more than 99.99 %";
  return `${p > 99 ? withDecimals(p, 2) : p < 1 ? general(p, 2) : withDecimals(p, 1)} %`;
}

export function plainNumber(value: number): string {
  if (Number.isNaN(value)) return "unknown";
  if (!isFinite(value)) return "unlimited";
  const size = Math.abs(value);
  return size >= firstOfFourDigits && size < 1e6 ? withDecimals(value, 0) : general(value, 3);
}

/** Four decimals, or as many more as the first digit needs. */
export function unsignedNumber(value: number): string {
  if (value === 0) return "0";
  return withDecimals(value, value < 5e-5 ? Math.ceil(-Math.log10(value)) : 4);
}

export const signedNumber = (value: number): string => (value === 0 ? "0" : `${value < 0 ? "−" : "+"}${unsignedNumber(Math.abs(value))}`);

/** "0.8 texel", "1 texel", "1.6 texels", "150 texels" */
export function texelsText(texels: number): string {
  const size = Math.abs(texels),
    text = size < 99.5 ? general(texels, 2) : withDecimals(texels, 0);
  if (size > 0 && size < 0.001) return "less than 0.001 texel";
  return `${text.replace("-", "−")} texel${size <= 1 || text === "1" || text === "-1" ? "" : "s"}`;
}

export function milliseconds(ms: number): string {
  if (!(ms >= 0)) return "not timed";
  if (ms < 10) return `${general(ms, 2)} ms`;
  if (ms < 1000) return `${withDecimals(ms, 0)} ms`;
  const seconds = ms / 1000;
  return `${seconds < firstOfFourDigits ? general(seconds, 3) : withDecimals(seconds, 0)} s`;
}

/** What a pass takes beyond another one, with the interval that its runs leave it (twin: scene/base/time_difference.h). */
export interface TimeDifference {
  low: number;
  median: number;
  high: number;
  told: boolean; // the interval does not hold 0
}

/** "4.9 to 8.2 ms", "0 to 30 ms", "900 ms to 1.2 s"; where the difference is told, "6 ms (4.9 to 8.2 ms)". */
export function timeDifference({ low, median, high, told }: TimeDifference): string {
  const to = milliseconds(high),
    unit = to.slice(to.indexOf(" "));
  let from = low > 0 ? milliseconds(low) : "0";
  if (from.endsWith(unit)) from = from.slice(0, -unit.length);
  const middle = milliseconds(median);
  if (!told) return `${from} to ${to}`;
  return middle === milliseconds(low) && middle === to ? middle : `${middle} (${from} to ${to})`;
}

export function byteCount(bytes: number): string {
  const units = ["bytes", "kB", "MB", "GB", "TB"];
  let value = bytes,
    unit = 0;
  for (; value >= firstOfFourDigits && unit + 1 < units.length; ++unit) value /= 1000;
  return `${unit === 0 ? bytes : general(value, 3)} ${units[unit]}`;
}
