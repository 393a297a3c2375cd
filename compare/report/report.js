// What the report page gains when scripts may run: the viewer that swipes, flips and enlarges two pictures and reads
// their pixels, and the label table that shows one label alone. Without it everything is still on the page.
"use strict";
(() => {
  const byId = (id) => document.getElementById(id);
  const clamp = (v, low, high) => Math.min(Math.max(v, low), high);

  // The pixels of an <img>, read once.
  const pixelCache = new Map();
  function pixelsOf(image) {
    if (!pixelCache.has(image.id)) {
      const canvas = document.createElement("canvas");
      canvas.width = image.naturalWidth;
      canvas.height = image.naturalHeight;
      const context = canvas.getContext("2d", { willReadFrequently: true });
      context.drawImage(image, 0, 0);
      pixelCache.set(image.id, { canvas, context, data: context.getImageData(0, 0, canvas.width, canvas.height) });
    }
    return pixelCache.get(image.id);
  }
  function colourAt(image, x, y) {
    const { data } = pixelsOf(image);
    const i = 4 * (y * data.width + x);
    return "#" + [0, 1, 2].map((k) => data.data[i + k].toString(16).padStart(2, "0")).join("");
  }

  // Colour to label, from a light's label table.
  function labelNames(section) {
    const names = new Map([["#c6c6c2", "right, in shadow"]]);
    for (const row of section.querySelectorAll("tr[data-colour]")) names.set(row.dataset.colour, row.dataset.label);
    return names;
  }

  // --- the viewer ---------------------------------------------------------------------------------------------------

  function startViewer(viewer) {
    const section = viewer.closest("section");
    const index = section.id.replace("light-", "");
    const stage = viewer.querySelector(".stage");
    const panes = [...stage.querySelectorAll(".pane")];
    const picks = [...viewer.querySelectorAll(".pick")];
    const slider = viewer.querySelector(".slider input");
    const probe = viewer.querySelector(".probe");
    const output = viewer.querySelector("output");
    const size = { x: byId("picture-raster").naturalWidth, y: byId("picture-raster").naturalHeight };
    const names = labelNames(section);
    // x and y: the picture's left and top edge in units of the pane; zoom 1 fits the pane.
    const state = { mode: "swipe", split: 0.5, zoom: 1, x: 0, y: 0, front: 0, probe: null };

    function draw() {
      state.x = clamp(state.x, 1 - state.zoom, 0);
      state.y = clamp(state.y, 1 - state.zoom, 0);
      stage.dataset.mode = state.mode;
      stage.classList.toggle("enlarged", state.zoom > 1);
      const move = `translate(${100 * state.x}%, ${100 * state.y}%) scale(${state.zoom})`;
      panes.forEach((pane, i) => {
        pane.firstElementChild.style.transform = move;
        pane.classList.toggle("away", i !== state.front);
      });
      panes[1].style.clipPath = state.mode === "swipe" ? `inset(0 0 0 ${100 * state.split}%)` : "";
      stage.querySelector(".divider").style.left = `${100 * state.split}%`;
      slider.value = 100 * state.split;
      slider.parentElement.hidden = state.mode !== "swipe";
      output.textContent = `${state.zoom < 10 ? state.zoom.toFixed(1).replace(".0", "") : Math.round(state.zoom)}×`;
      for (const button of viewer.querySelectorAll("[data-mode]"))
        if (button !== stage) button.setAttribute("aria-pressed", String(button.dataset.mode === state.mode));
    }

    function show() {
      picks.forEach((pick, i) => {
        panes[i].firstElementChild.src = byId(pick.value).src;
        panes[i].lastElementChild.textContent = pick.selectedOptions[0].textContent;
      });
      draw();
    }

    // Zooms about a point given in units of the pane.
    function zoomTo(zoom, at = { x: 0.5, y: 0.5 }) {
      const next = clamp(zoom, 1, 64);
      state.x = at.x - (at.x - state.x) * (next / state.zoom);
      state.y = at.y - (at.y - state.y) * (next / state.zoom);
      state.zoom = next;
      draw();
    }

    function paneAt(event) {
      const pane = panes.find((p) => {
        const box = p.getBoundingClientRect();
        return event.clientX >= box.left && event.clientX < box.right;
      }) || panes[0];
      const box = pane.getBoundingClientRect();
      return { x: (event.clientX - box.left) / box.width, y: (event.clientY - box.top) / box.height, box };
    }

    function readPixel(x, y) {
      state.probe = { x: clamp(x, 0, size.x - 1), y: clamp(y, 0, size.y - 1) };
      const colour = (id) => colourAt(byId(id), state.probe.x, state.probe.y);
      const label = names.get(colour(`picture-labels-${index}`)) || "unknown";
      probe.textContent = `Pixel ${state.probe.x}, ${state.probe.y}: ${label}; rasterized ${colour("picture-raster")}, ` +
        `ray traced ${colour("picture-raytraced")}`;
    }

    function readUnder(event) {
      const at = paneAt(event);
      const x = Math.floor(((at.x - state.x) / state.zoom) * size.x), y = Math.floor(((at.y - state.y) / state.zoom) * size.y);
      if (x >= 0 && y >= 0 && x < size.x && y < size.y) readPixel(x, y);
    }

    let drag = null;
    stage.addEventListener("pointerdown", (event) => {
      const at = paneAt(event);
      const nearDivider = Math.abs(at.x - state.split) * at.box.width < 16;
      const divider = state.mode === "swipe" && (state.zoom === 1 || nearDivider);
      drag = { divider, x: event.clientX, y: event.clientY };
      stage.setPointerCapture(event.pointerId);
      if (divider) { state.split = clamp(at.x, 0, 1); draw(); }
    });
    stage.addEventListener("pointermove", (event) => {
      if (!drag) { readUnder(event); return; }
      const at = paneAt(event);
      if (drag.divider) state.split = clamp(at.x, 0, 1);
      else {
        state.x += (event.clientX - drag.x) / at.box.width;
        state.y += (event.clientY - drag.y) / at.box.height;
        drag.x = event.clientX;
        drag.y = event.clientY;
      }
      draw();
    });
    for (const end of ["pointerup", "pointercancel"]) stage.addEventListener(end, () => { drag = null; });
    stage.addEventListener("dblclick", (event) => zoomTo(state.zoom * 2, paneAt(event)));
    stage.addEventListener("wheel", (event) => {
      if (!event.ctrlKey && !event.metaKey) return;  // plain scrolling stays the page's
      event.preventDefault();
      zoomTo(state.zoom * Math.exp(-0.01 * event.deltaY), paneAt(event));
    }, { passive: false });

    const steps = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    stage.addEventListener("keydown", (event) => {
      const step = steps[event.key];
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      if (step && event.shiftKey) {
        const from = state.probe || { x: Math.floor(size.x / 2), y: Math.floor(size.y / 2) };
        readPixel(from.x + step[0], from.y + step[1]);
      } else if (step && state.zoom > 1) {
        state.x -= 0.1 * step[0];
        state.y -= 0.1 * step[1];
        draw();
      } else if (step && state.mode === "swipe" && step[0] !== 0) {
        state.split = clamp(state.split + 0.02 * step[0], 0, 1);
        draw();
      } else if (event.key === "f" || event.key === "F") {
        state.mode = "flip";
        state.front = 1 - state.front;
        draw();
      } else if (event.key === "+" || event.key === "=") zoomTo(state.zoom * 1.5);
      else if (event.key === "-") zoomTo(state.zoom / 1.5);
      else if (event.key === "0") zoomTo(1);
      else return;
      event.preventDefault();
    });

    for (const button of viewer.querySelectorAll("button[data-mode]"))
      button.addEventListener("click", () => {
        if (button.dataset.mode === "flip" && state.mode === "flip") state.front = 1 - state.front;
        state.mode = button.dataset.mode;
        draw();
      });
    const zooms = { in: () => zoomTo(state.zoom * 1.5), out: () => zoomTo(state.zoom / 1.5), fit: () => zoomTo(1) };
    for (const button of viewer.querySelectorAll("[data-zoom]")) button.addEventListener("click", zooms[button.dataset.zoom]);
    slider.addEventListener("input", () => { state.split = slider.value / 100; draw(); });
    picks[1].selectedIndex = 1;
    for (const pick of picks) pick.addEventListener("change", show);
    show();
    viewer.hidden = false;
  }

  // --- one label alone ----------------------------------------------------------------------------------------------

  // The label picture with every other label faded towards white.
  function isolated(image, colour) {
    const { canvas, data } = pixelsOf(image);
    const shown = new ImageData(new Uint8ClampedArray(data.data), data.width, data.height);
    const wanted = [1, 3, 5].map((k) => parseInt(colour.slice(k, k + 2), 16));
    for (let i = 0; i < shown.data.length; i += 4) {
      if (wanted.every((v, k) => shown.data[i + k] === v)) continue;
      const grey = 0.3 * shown.data[i] + 0.6 * shown.data[i + 1] + 0.1 * shown.data[i + 2];
      for (let k = 0; k < 3; ++k) shown.data[i + k] = 200 + 0.2 * grey;
    }
    const copy = document.createElement("canvas");
    copy.width = canvas.width;
    copy.height = canvas.height;
    copy.getContext("2d").putImageData(shown, 0, 0);
    return copy.toDataURL("image/png");
  }

  function startLabels(section) {
    const image = section.querySelector("[id^=picture-labels]");
    const original = image.src;
    const buttons = [];
    for (const row of section.querySelectorAll(".labels tr[data-colour]")) {
      const heading = row.querySelector("th");
      const name = heading.firstChild;
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = name.textContent;
      button.title = "Show only this label in the picture";
      button.setAttribute("aria-pressed", "false");
      heading.replaceChild(button, name);
      buttons.push(button);
      button.addEventListener("click", () => {
        const on = button.getAttribute("aria-pressed") !== "true";
        pixelsOf(image);  // of the original, before it is replaced
        for (const other of buttons) other.setAttribute("aria-pressed", String(on && other === button));
        image.src = on ? isolated(image, row.dataset.colour) : original;
      });
    }
  }

  // Pictures must be decoded before their pixels and sizes are read.
  async function start() {
    await Promise.all([...document.images].filter((image) => image.id).map((image) => image.decode().catch(() => {})));
    for (const section of document.querySelectorAll("section[id^=light-]")) startLabels(section);
    for (const viewer of document.querySelectorAll(".viewer")) startViewer(viewer);
    document.documentElement.dataset.ready = "true";
  }
  start();
})();
