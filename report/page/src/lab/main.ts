// The lab's page: panels made from the settings table, pictures to turn, and what the engine says of every state. The state is
// the address.
import "../report.css";
import "./lab.css";
import { copyButton } from "../clipboard";
import { pageData } from "../parts";
import { html } from "../svg";
import { markup, flowing } from "../template";
import { choiceRow, panel, tidy } from "./controls";
import { isDrawn, servedEngine, workerEngine, type CameraPose, type Drawn, type LabFacts, type Named, type Reading } from "./engine";
import { addressOf, optionsOf, stateAt, wordsOf, type LabState, type Options } from "./lab_state";
import { LightControls, type PoseChange } from "./light_controls";
import { listenToOpener } from "./opener";
import { biasAt, pixelMarkup, resultsMarkup } from "./results";
import { asOneFile, packed } from "./one_file";
import { SettingsPanel } from "./settings_panel";
import { Stage } from "./stage";

const facts = pageData<LabFacts>();
const poseOptions = [
  "camera",
  "camera-orbit",
  "camera-distance",
  "camera-target",
  "camera-up",
  "camera-height",
  "light",
  "light-azimuth",
  "light-elevation",
  "light-distance",
  "light-size",
  "size",
  "precision",
];

const patience = 20_000; // milliseconds without news before the page says what may take so long
const long =
  "This takes long: without a GPU a browser may need minutes for this scene's shaders. It goes on. To stop it, reload the page with another scene; its address keeps what is set here.";

class Lab {
  private state: LabState = stateAt(location.hash) ?? stateAt(packed?.state ?? "") ?? { scene: facts.scene, options: new Map() };
  private readonly engine = facts.worker
    ? workerEngine(facts.scenes.some(({ name }) => name === this.state.scene) ? this.state.scene : facts.scene, facts.size)
    : servedEngine();
  private asked = 0; // the moment from which readings are of this page's wish
  private asking = false;
  private again = false; // something was changed meanwhile
  private refused = ""; // why the newest wish was not taken; empty: it was
  private waits = 0; // the timer of patience
  private preset: number | undefined;
  private seen = 0;
  private newest: Reading | null = null;
  private reading: (Reading & Drawn) | null = null; // the newest with something drawn
  private drawn: Options = new Map(); // the options that it was drawn with
  private readonly files = new Set<string>();

  private readonly part = (id: string): HTMLElement => document.getElementById(id)!;
  private readonly stage: Stage;
  private readonly settings: SettingsPanel;
  private readonly light: LightControls;
  private readonly precision = choiceRow(
    "Arithmetic of the rays",
    "fast is float, robust has error bounds, exact has no rounding at all. --precision",
    ["fast", "robust", "exact"],
    (value) => this.change({ precision: value }),
  );

  constructor() {
    document.getElementById("main")!.innerHTML = layout.text;
    document.querySelector("nav ul")!.innerHTML = "";
    this.stage = new Stage(this.part("lab-stage"), this.engine, facts, {
      turnCamera: (pose) => this.turnCamera(pose),
      turnLight: (azimuth, elevation) => this.change({ "light-azimuth": String(azimuth), "light-elevation": String(elevation) }),
      pin: (x, y) => void this.explain(x, y),
      unpin: () => {
        this.part("lab-pixel").replaceChildren();
      },
    });
    this.settings = new SettingsPanel(this.part("lab-settings"), facts.settings, (options) => this.changeMap(options));
    this.light = new LightControls(this.part("lab-settings"), (pose) => this.change(pose));
    this.part("lab-settings").append(panel("Ray tracer", "precision", this.precision.element));
    this.sceneMenu();
    this.presetButtons();
    this.part("lab-reset").after(copyButton(this.part("lab-command"), "Copy the command line"));
    this.listen();
  }

  private sceneMenu(): void {
    const menu = this.part("lab-scene") as HTMLSelectElement,
      group = (label: string, all: Named[]): HTMLElement =>
        html("optgroup", { label }, ...all.map(({ name, what }) => html("option", { value: name, title: what }, name)));
    menu.append(group("Scenes", facts.scenes), group("Lessons", facts.lessons));
    this.offer(facts.scene);
    this.offer(this.state.scene);
    menu.addEventListener("change", () => this.go({ scene: menu.value, options: new Map() }));
  }

  // A scene that is none of the program's own.
  private offer(name: string): void {
    const menu = this.part("lab-scene") as HTMLSelectElement;
    if (![...menu.options].some(({ value }) => value === name)) menu.prepend(html("option", { value: name }, name));
    menu.value = name;
  }

  private presetButtons(): void {
    facts.presets.forEach(({ title, what }, i) => {
      const button = html("button", { type: "button", title: what }, title);
      button.addEventListener("click", () => {
        this.preset = i;
        this.ask();
      });
      this.part("lab-presets").append(button);
    });
  }

  private listen(): void {
    window.addEventListener("hashchange", () => {
      const state = stateAt(location.hash);
      if (state && addressOf(state) !== addressOf(this.state)) this.go(state);
    });
    this.part("lab-reset").addEventListener("click", () => this.go({ scene: this.state.scene, options: new Map() }));
    this.part("lab-report").addEventListener("click", () => this.showReport());
    if (this.engine.makesReports) {
      this.part("lab-report").hidden = true;
      this.part("lab-save").addEventListener("click", (event) => {
        event.preventDefault();
        void this.saveReport();
      });
    }
    this.part("lab-one-file").hidden = !facts.worker || packed !== null;
    this.part("lab-one-file").addEventListener("click", () => void this.saveLab());
    this.part("lab-results").addEventListener("click", (event) => {
      const chart = (event.target as Element).closest<SVGElement>(".chart"),
        light = this.reading?.result?.lights[0];
      const texels = chart && light ? biasAt(chart, event.clientX, light) : null;
      if (texels !== null) this.change({ bias: `${tidy(texels)}texel` });
    });
    const drop = this.part("lab-file") as HTMLInputElement;
    drop.addEventListener("change", () => void this.open([...(drop.files ?? [])]));
    document.addEventListener("dragover", (event) => event.preventDefault());
    document.addEventListener("drop", (event) => {
      event.preventDefault();
      void this.open([...(event.dataTransfer?.files ?? [])]);
    });
    listenToOpener(({ file, options, words }) => void this.open([file], options, words));
  }

  // Of several files the first that is a scene is opened; the others lie beside it.
  private async open(files: File[], options: Options = new Map(), from = ""): Promise<void> {
    if (files.length === 0) return;
    this.say(`Reading ${files.map(({ name }) => name).join(", ")}…`);
    try {
      const names = [];
      for (const file of files) names.push(await this.engine.take(file));
      const scene = names.find((name) => facts.extensions.some((extension) => name.toLowerCase().endsWith(extension))) ?? names[0]!;
      this.files.add(scene);
      this.offer(scene);
      this.go({ scene, options });
      this.part("lab-from").textContent = from;
    } catch (error) {
      this.fail((error as Error).message);
    }
  }

  private go(state: LabState): void {
    if (state.scene !== this.state.scene) this.part("lab-from").textContent = "";
    this.state = state;
    this.offer(state.scene);
    this.part("lab-pixel").replaceChildren();
    this.ask();
  }

  /** "" takes an option away. */
  private change(options: PoseChange): void {
    for (const [name, value] of Object.entries(options)) {
      if (name === "light") for (const other of poseOptions) if (other.startsWith("light-")) this.state.options.delete(other);
      if (value === "") this.state.options.delete(name);
      else this.state.options.set(name, value);
    }
    // Which light is turned has to be said where there are several.
    if (Object.keys(options).some((name) => name.startsWith("light-")) && this.reading && this.reading.scene.lights.length > 1)
      this.state.options.set("light", this.reading.light.name);
    this.ask();
  }

  private turnCamera({ azimuth, elevation, distance }: CameraPose): void {
    this.change({ "camera-orbit": `${azimuth.toFixed(2)},${elevation.toFixed(2)}`, "camera-distance": String(distance) });
  }

  /** All options of the map: what it is not told any longer goes. */
  private changeMap(options: Options): void {
    const rest = [...this.state.options].filter(([name]) => poseOptions.includes(name));
    this.state.options = new Map([...options, ...rest]);
    this.ask();
  }

  // One wish at a time: of those that come meanwhile the newest is asked for next.
  private ask(): void {
    history.replaceState(null, "", addressOf(this.state)); // at once: an engine that is lost answers no more
    if (this.asking) {
      this.again = true;
      return;
    }
    this.asking = true;
    this.again = false;
    const preset = this.preset;
    this.preset = undefined;
    document.body.dataset.busy = "true";
    this.say("");
    this.wait();
    this.engine
      .ask({ scene: this.state.scene, words: wordsOf(this.state.options), ...(preset !== undefined && { preset }) })
      .then(
        (number) => {
          this.asked = number;
          this.fail((this.refused = ""));
        },
        (error: Error) => {
          this.fail((this.refused = error.message));
          if (this.reading) this.settings.show(this.reading);
        },
      )
      .finally(() => {
        this.asking = false;
        if (this.again) this.ask();
        else if (this.newest) this.take(this.newest); // it may have come before the answer
      });
  }

  // A browser without a GPU translates some shaders for minutes, in which its engine hears nothing.
  private wait(): void {
    clearTimeout(this.waits);
    this.waits = window.setTimeout(() => {
      if (document.body.dataset.busy === "true") this.say(long);
    }, patience);
  }

  /** A state of the address, or one that was saved with the page, is asked for; else the engine's own is shown. */
  start(): void {
    if (location.hash.length > 1 || packed) this.ask();
    void this.listenToEngine();
    document.documentElement.dataset.ready = "true";
  }

  // Until the page is left.
  private async listenToEngine(): Promise<void> {
    for (;;) {
      try {
        const reading = await this.engine.news(this.seen);
        this.part("lab-gone").hidden = true;
        if (reading.number !== this.seen) this.take(reading);
        this.seen = reading.number;
      } catch (error) {
        this.part("lab-gone").textContent = `${this.engine.makesReports ? `${(error as Error).message} ` : ""}${this.engine.lost}`;
        this.part("lab-gone").hidden = false;
        if (this.seen === 0) this.part("lab-verdict").replaceChildren(); // nothing is being drawn
        await new Promise((done) => setTimeout(done, 1000));
      }
    }
  }

  private take(reading: Reading): void {
    this.newest = reading;
    if (this.part("lab-note").textContent === long) this.say("");
    this.wait();
    const isOther = this.asked > 0 && reading.client !== this.engine.client; // a page that has asked for nothing shows what is there
    this.part("lab-other").hidden = !isOther;
    this.part("lab-opening").hidden = !reading.opening;
    if (reading.number >= this.asked && !this.asking) this.fail(this.refused || reading.error);
    if (reading.note !== "") this.say(reading.note);
    if (!isDrawn(reading) || reading.opening) return;
    this.reading = reading;
    const isOwn = !isOther && reading.number >= this.asked && !this.asking;
    if (isOwn) this.adopt(reading);
    this.stage.show(reading);
    const isNow = reading.compared === reading.revision && !reading.preview;
    document.body.dataset.busy = String(!(isNow && isOwn));
    document.body.dataset.revision = String(isNow ? reading.revision : 0);
    if (reading.verdict)
      this.part("lab-verdict").innerHTML = markup`<p class="verdict">${flowing(reading.verdict.headline)}</p>${
        reading.verdict.detail && markup`<p class="verdict-detail">${flowing(reading.verdict.detail)}</p>`
      }`.text;
    const details = [...this.part("lab-results").querySelectorAll("details")].map(({ open }) => open);
    this.part("lab-results").innerHTML = resultsMarkup(reading, facts).text;
    this.part("lab-results")
      .querySelectorAll("details")
      .forEach((element, i) => {
        element.open = details[i] ?? false;
      });
    const pinned = this.stage.pinned();
    if (pinned && isNow) void this.explain(...pinned);
    this.markReport(reading.revision);
  }

  // What the engine made of the wish: as a command line would say it. A scene that cannot be opened leaves the state that is drawn.
  private adopt(reading: Reading & Drawn): void {
    if (this.state.scene !== reading.scene.asked_as) {
      this.state = { scene: reading.scene.asked_as, options: this.drawn };
      this.offer(this.state.scene);
    }
    const own = new Set(poseOptions),
      kept = [...this.state.options].filter(([name]) => own.has(name));
    this.state.options = optionsOf(reading.words);
    for (const [name, value] of kept) if (!this.state.options.has(name) && name !== "light") this.state.options.set(name, value);
    this.drawn = new Map(this.state.options);
    history.replaceState(null, "", addressOf(this.state));
    this.settings.show(reading);
    this.light.show(reading);
    this.precision.show(reading.precision);
    document.title = `${reading.scene.name} – Gnomon lab`;
    this.part("lab-command").textContent = reading.command;
  }

  private async explain(x: number, y: number): Promise<void> {
    const story = await this.engine.pixel(x, y).catch(() => null);
    if (story) this.part("lab-pixel").innerHTML = pixelMarkup(story, facts).text;
  }

  // What the page makes itself is a file to be saved: a page in it would have this page's policy, not its own.
  private async save(file: Promise<Blob>, name: string, before: string, after: string): Promise<void> {
    this.say(before);
    try {
      html("a", { href: URL.createObjectURL(await file), download: name }).click();
      this.say(after);
    } catch (error) {
      this.fail((error as Error).message);
    }
  }
  private async saveReport(): Promise<void> {
    if (this.reading)
      await this.save(
        this.engine.report(this.reading.command.split(" ").slice(1)),
        "report.html",
        "Writing the report…",
        "The report is saved as report.html.",
      );
  }
  private saveLab(): Promise<void> {
    return this.save(
      asOneFile(),
      "gnomon-lab.html",
      "Packing the lab…",
      "The lab is saved as gnomon-lab.html, which opens from the disk and begins with what is set here.",
    );
  }

  private showReport(): void {
    if (!this.reading) return;
    const frame = html("iframe", {
      title: "The report of this state",
      src: `report?revision=${this.reading.revision}`,
      "data-revision": String(this.reading.revision),
    });
    this.part("lab-frame").replaceChildren(html("p", { role: "status" }, "Writing the report…"), frame);
    frame.addEventListener("load", () => {
      this.part("lab-frame").firstElementChild!.textContent = "";
      this.markReport(this.reading!.revision);
    });
  }

  private markReport(revision: number): void {
    const frame = this.part("lab-frame").querySelector("iframe");
    const isOld = frame !== null && frame.dataset.revision !== String(revision);
    this.part("lab-report").textContent =
      frame === null ? "Show the whole report" : isOld ? "Show the report of the settings as they are now" : "Show the report again";
  }

  private say(text: string): void {
    this.part("lab-note").textContent = text;
  }
  private fail(text: string): void {
    this.part("lab-error").textContent = text;
    this.part("lab-error").hidden = text === "";
  }
}

const layout = markup`<div class="lab">
<header class="lab-top"><h1 class="quiet">Shadow lab</h1><label>Scene <select id="lab-scene"></select></label>
<label class="file">Open a file… <input type="file" id="lab-file" class="quiet" multiple></label>
<span class="modes" id="lab-presets" role="group" aria-label="Settings that show an artifact"></span>
<button type="button" id="lab-reset">Reset</button></header>
<section class="lab-words" aria-label="Verdict"><div id="lab-verdict" role="status"><p class="verdict">Drawing…</p></div>
<p id="lab-error" role="alert" hidden></p><p id="lab-note" class="hint" role="status"></p>
<p id="lab-from" class="hint"></p>
<p id="lab-opening" class="hint" hidden>Opening the scene…</p>
<p id="lab-other" class="hint" hidden>Another page has set this lab to something else; any change here takes it back.</p>
<p id="lab-gone" role="alert" hidden></p></section>
<div id="lab-settings" class="lab-settings" role="form" aria-label="Settings"></div>
<div id="lab-stage" class="lab-stage"></div>
<div class="lab-side"><div id="lab-pixel" class="lab-pixel" aria-live="polite"></div><div id="lab-results" class="lab-results"></div></div>
<section class="lab-report" aria-label="Report"><p><button type="button" id="lab-report">Show the whole report</button> <a id="lab-save" href="report" download="report.html">Save the report</a> <button type="button" id="lab-one-file">Save the lab as one file</button> <code id="lab-command"></code></p><div id="lab-frame"></div></section>
</div>`;

const lab = new Lab();
lab.start();
