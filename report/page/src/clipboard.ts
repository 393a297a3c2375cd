// Commands to copy.
import { html } from "./svg";

async function copy(text: string): Promise<void> {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    // no permission, or a page from disk: the old way
    const area = html("textarea", { "aria-hidden": "true" }, text),
      focused = document.activeElement;
    Object.assign(area.style, { position: "fixed", top: "0" }); // where selecting it scrolls nothing
    document.body.append(area);
    area.select();
    document.execCommand("copy");
    area.remove();
    if (focused instanceof HTMLElement) focused.focus({ preventScroll: true });
  }
}

/** A button that copies a command and says so. */
export function copyButton(code: HTMLElement, name: string): HTMLButtonElement {
  const button = html("button", { type: "button", class: "copy" }, name);
  button.addEventListener("click", async () => {
    await copy(code.textContent!);
    button.textContent = "Copied";
    window.setTimeout(() => {
      button.textContent = name;
    }, 2000);
  });
  return button;
}

export function addCopyButtons(): void {
  for (const code of document.querySelectorAll<HTMLElement>(".command code")) code.after(copyButton(code, "Copy the command"));
  for (const code of document.querySelectorAll<HTMLElement>(".run code")) {
    const button = copyButton(code, "Copy");
    button.setAttribute("aria-label", "Copy the command");
    code.before(button);
  }
}
