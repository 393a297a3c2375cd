// The settings of the shadow map, made from the program's own table (raster/settings.h): below the technique only what it
// reads.
import { choiceRow, linearScale, panel, logarithmicScale, powersOfTwo, sliderRow, switchRow, textRow, tidy, type Row } from "./controls";
import type { Drawn, SettingFacts } from "./engine";
import type { Options } from "./lab_state";

const noteOf = ({ what, acne, peter_panning, name, allowed }: SettingFacts): string =>
  allowed === undefined ? what : `${what} Acne: ${acne} Peter-panning: ${peter_panning} --${name} [${allowed}]`;

/** What a panel shows. */
export type Panelled = Pick<Drawn, "values" | "bias_world" | "texel_world">;

/** "0.5texel" -> 0.5 texels; "0.02" -> in texels of that width; "auto" -> what it came to. */
function biasInTexels(text: string, drawn: Panelled): string {
  if (text.endsWith("texel")) return text.slice(0, -"texel".length);
  const world = text === "auto" ? drawn.bias_world : Number(text);
  return drawn.texel_world > 0 ? String(tidy(world / drawn.texel_world)) : "0";
}

/** Whether the technique of these values reads the setting; what is none of the map's is always read. */
function isRead({ readers }: SettingFacts, values: Record<string, string>): boolean {
  if (!readers) return true;
  return (
    readers.techniques.includes(values.technique!) &&
    (values.technique !== "pcf" || readers.kernels.includes(values["filter-kernel"] ?? readers.kernels[0]!))
  );
}

export class SettingsPanel {
  private readonly rows = new Map<string, Row>();
  private readonly groups = new Map<string, HTMLFieldSetElement>();
  private drawn: Panelled | null = null;

  /** `changed`: with the options that then hold, all of them. */
  constructor(
    root: HTMLElement,
    private readonly facts: SettingFacts[],
    private readonly changed: (options: Options) => void,
  ) {
    const technique = facts.find(({ name }) => name === "technique");
    if (technique) root.append(this.rowOf(technique).element);
    for (const setting of facts) {
      if (setting.name === "technique") continue;
      let group = this.groups.get(setting.group);
      if (!group) {
        group = panel(setting.group, setting.name);
        this.groups.set(setting.group, group);
        root.append(group);
      }
      group.append(this.rowOf(setting).element);
    }
  }

  private rowOf(setting: SettingFacts): Row {
    const row = this.control(setting);
    row.element.dataset.setting = setting.name;
    this.rows.set(setting.name, row);
    return row;
  }

  private control(setting: SettingFacts): Row {
    const { name, title, unit = "", from = 0, to = 1 } = setting,
      note = noteOf(setting),
      set = (text: string): void => this.set(setting, text);
    switch (setting.control) {
      case "choice":
        return choiceRow(title, note, setting.choices!, set);
      case "switch":
        return switchRow(title, note, (on) => set(on ? "on" : "off"));
      case "text":
        return textRow(title, unit, note, set);
      case "bias":
        return sliderRow(title, unit, note, linearScale(from, to), (text) =>
          set(Number.isNaN(Number(text)) || text === "" ? text : `${text}texel`),
        );
      case "integer":
        return sliderRow(title, unit, note, setting.powers_of_two ? powersOfTwo(from, to) : linearScale(from, to, to - from), (text) =>
          set(name && text),
        );
      default:
        return sliderRow(title, unit, note, setting.logarithmic && from > 0 ? logarithmicScale(from, to) : linearScale(from, to), set);
    }
  }

  private set(setting: SettingFacts, text: string): void {
    if (!this.drawn) return;
    const values = { ...this.drawn.values, [setting.name]: text };
    this.drawn.values[setting.name] = text;
    this.changed(this.optionsOf(values));
  }

  /** What the technique of these values reads of them, as options. */
  private optionsOf(values: Record<string, string>): Options {
    const options: Options = new Map();
    for (const setting of this.facts) {
      const value = values[setting.name];
      if (value === undefined || !isRead(setting, values)) continue;
      if (setting.control === "switch" && setting.flag) {
        if (value === "on") options.set(setting.name, "");
      } else options.set(setting.name, value);
    }
    return options;
  }

  show(drawn: Panelled): void {
    this.drawn = drawn;
    for (const setting of this.facts) {
      const row = this.rows.get(setting.name)!,
        value = drawn.values[setting.name];
      row.element.hidden = value === undefined;
      if (value !== undefined) row.show(setting.control === "bias" ? biasInTexels(value, drawn) : value);
    }
    for (const group of this.groups.values()) group.hidden = [...group.querySelectorAll<HTMLElement>(".row")].every((row) => row.hidden);
  }
}
