// A figure that begins with nothing, so that the question comes before the answer, is printed with all that it has.

/** `whole` shows all of it, `back` what was shown before. */
export function whenPrinted(whole: () => void, back: () => void): void {
  window.addEventListener("beforeprint", whole);
  window.addEventListener("afterprint", back);
}
