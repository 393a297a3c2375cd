// Build a structure over a few discs split by split, and walk a ray through it step by step, with what is on the stack. The discs can
// be dragged: what becomes of the structure is seen at once.
import { grouped } from "../number_text";
import { html, number } from "../svg";
import { add, length, sub, unit, type Circle, type Vec2 } from "./flatland";
import type { FigureJson } from "./figures";
import { frame } from "./flatland_figure";
import {
  boxOfOutline,
  countedNodes,
  expectedNodes,
  overlap,
  SmallTree,
  walkTree,
  type Kind,
  type Rule,
  type SmallNode,
} from "./small_tree";
import { whenPrinted } from "./printed";
import { fillCells, walkCells } from "./small_grid";
import { Sliders, Stage } from "./stage";
import { many, say } from "./say";

interface BuildJson {
  discs: [number, number, number][];
  checks: { from: Vec2; to: Vec2; t: number | null }[];
}
const names: Record<Kind, string> = {
  grid: say("uniform grid"),
  octree: say("octree"),
  kd: say("kd-tree"),
  bsp: say("BSP tree"),
  bvh: say("hierarchy of boxes"),
};
/** What a ray meets, one and several. */
const metBy = (kind: Kind): [string, string] => (kind === "grid" || kind === "bsp" ? ["cell", "cells"] : ["box", "boxes"]);
const window: [number, number, number, number] = [-3, 3, -1.5, 1.5];

const circleOf = ([x, y, radius]: [number, number, number]): Circle => ({ center: [x, y], radius });
const firstHit = (kind: Kind, rule: Rule, discs: Circle[], from: Vec2, to: Vec2): number => {
  const way = unit(sub(to, from));
  return (kind === "grid" ? walkCells(discs, 2, from, way) : walkTree(new SmallTree(kind, rule, discs), from, way)).at(-1)?.t ?? Infinity;
};

declare global {
  var gnomonSmallHits: ((json: BuildJson, kind: Kind, rule: Rule) => number[]) | undefined; // eslint-disable-line no-var
}
/** For the rays that the program traced through the same discs: where they hit here. */
globalThis.gnomonSmallHits = (json, kind, rule) =>
  json.checks.map(({ from, to }) => firstHit(kind, rule, json.discs.map(circleOf), from, to));

export function buildFigure({ settings, data }: FigureJson, id: string): HTMLElement {
  const json = data as BuildJson,
    kind = settings.kind as Kind,
    discs = json.discs.map(circleOf),
    ruled = kind === "kd" || kind === "bvh";
  let from: Vec2 = [-2.7, 0.3],
    to: Vec2 = [1.45, 0.6];
  const handles = (): Record<string, Vec2> => ({ from, to, ...Object.fromEntries(discs.map(({ center }, i) => [`disc${i}`, center])) });
  const stage = new Stage(
    window,
    say`A ${names[kind]} over discs, and a ray on its way through it`,
    (at, handle) => {
      if (handle === "from") from = at;
      else if (handle === "to") to = at;
      else discs[Number(handle.slice(4))] = { ...discs[Number(handle.slice(4))]!, center: at };
      show();
    },
    handles,
  );
  const said = html("p", { class: "bias-counts", role: "status" });
  const share = (name: string, value: number) => ({
    name,
    from: 0,
    to: 1,
    step: 0.001,
    value,
    text: (v: number) => `${Math.round(100 * v)} %`,
  });
  const sliders: Sliders<string> = new Sliders<string>(
    {
      built: share(say("Built"), Number(settings.built ?? 0)),
      ...(kind === "grid"
        ? {
            cells: {
              name: say("Cells for each disc"),
              from: 0,
              to: 16,
              step: 1,
              value: 4,
              text: (v: number) => (v === 0 ? say("one cell in all") : String(v)),
            },
          }
        : {}),
      walk: share(say("Ray's way"), 0),
      ...(ruled
        ? {
            rule: {
              name: say("Split"),
              from: 0,
              to: 1,
              step: 1,
              value: 0,
              text: (v: number) => (v === 1 ? say("by area") : kind === "bvh" ? say("the middle disc") : say("in the middle")),
            },
          }
        : {}),
      seventh: {
        name: say("A disc, left and right"),
        from: -2.9,
        to: 2.9,
        step: 0.01,
        value: discs[6]!.center[0],
        text: (v: number) => number(v, 3),
        drags: true,
      },
    },
    () => {
      discs[6] = { ...discs[6]!, center: [sliders.value("seventh"), discs[6]!.center[1]] };
      show();
    },
  );
  const stepNames: Record<string, [string, string]> = {
    built: kind === "grid" ? [say("Build back"), say("Build on")] : [say("Split before"), say("Next split")],
    walk: [say("Step before"), say("Next step")],
  };
  const step = (key: string, by: -1 | 1) => {
    const button = html("button", { type: "button" }, stepNames[key]![by > 0 ? 1 : 0]!);
    button.addEventListener("click", () => {
      const n = Math.max(1, key === "built" ? splits : steps);
      sliders.set(key, Math.min(Math.max((Math.round(sliders.value(key) * n) + by) / n, 0), 1));
    });
    return button;
  };
  let [splits, steps] = [1, 1];
  const show = () => {
    const way = length(sub(to, from)) > 0 ? unit(sub(to, from)) : ([1, 0] as Vec2),
      tree = new SmallTree(kind, kind === "bsp" || (ruled && sliders.value("rule") === 1) ? "area" : "middle", discs);
    const perAxis = kind === "grid" ? Math.sqrt(sliders.value("cells")) : 0,
      grid = kind === "grid" ? walkCells(discs, perAxis, from, way) : null,
      walk = grid ?? walkTree(tree, from, way);
    // A grid is built by cutting the box, and by entering one disc after the other.
    splits = grid ? 1 + discs.length : tree.splits.length;
    steps = walk.length;
    const done = Math.round(sliders.value("built") * splits),
      made = grid ? [] : tree.splits.slice(0, done),
      filled = fillCells(discs, perAxis),
      entered = grid ? filled.lists.slice(0, Math.max(0, done - 1)) : [],
      held = new Map(entered.flat().map((cell) => [cell.name, cell.outline])),
      seen = walk.slice(0, Math.round(sliders.value("walk") * steps)),
      last = seen.at(-1),
      all = seen.length === steps;
    const closed = ({ outline }: SmallNode): Vec2[] => [...outline, outline[0]!],
      middleOf = ({ outline }: SmallNode): Vec2 => outline.reduce<Vec2>((sum, p) => add(sum, p, 1 / outline.length), [0, 0]);
    const shownNodes = kind === "bvh" ? made.flatMap((node) => node.children) : [],
      tests = new Set(seen.flatMap((s) => s.tested));
    const hit = last && all && isFinite(last.t) ? add(from, way, last.t) : null;
    stage.put(
      stage.path("cells bold", [
        ...(grid && done > 0 ? grid.lines : [closed(tree.root)]),
        ...made.flatMap((node) => node.cut),
        ...shownNodes.map(closed),
      ]),
      stage.path("held", held.values()),
      ...(entered.at(-1) ?? []).map(({ outline }) => stage.path("held last", [[...outline, outline[0]!]])),
      ...seen.map((s) => stage.path(`visited${s.tested.length > 0 ? " tests" : ""}${s === last ? " last" : ""}`, [closed(s.node)])),
      ...discs.map((disc, i) => stage.circle(`disc${tests.has(i) ? " tested" : ""}`, disc.center, stage.units(disc.radius))),
      stage.path("ray", [[from, hit ?? add(from, way, 9)]]),
      stage.circle("point", from, 11),
      stage.circle("moved", to, 9),
      ...(hit ? [stage.circle("hit", hit, 8)] : []),
      ...(grid || !last
        ? []
        : tree
            .nodes()
            .filter(({ name }) => last.stack.includes(name))
            .map((node) => stage.label("middle", middleOf(node), node.name, 6))),
    );
    const met = last?.boxes ?? 0,
      testedInAll = last?.discs ?? 0, // a disc in several cells, in each
      tried = made.reduce((sum, node) => sum + node.tried, 0);
    Object.assign(said.dataset, {
      splits: String(grid ? done : made.length),
      held: String(held.size),
      cells: String(filled.all),
      tried: String(tried),
      boxes: String(met),
      discs: String(tests.size),
      tests: String(testedInAll),
      t: String(last?.t ?? Infinity),
      stack: (last?.stack ?? []).join(" "),
    });
    said.textContent = say`${
      grid
        ? done === 0
          ? say("Around everything a box. ")
          : say`${many(filled.all, "cell", "cells")}; ${many(entered.length, "disc", "discs")} of ${discs.length} entered, into the lists of ${held.size}. `
        : say`${many(made.length, "split", "splits")} of ${splits}${tried > 0 ? say`, the cheapest of ${grouped(tried)} tried` : ""}. `
    }The ray has met ${many(met, ...metBy(kind))} and tested ${many(tests.size, "disc", "discs")} of ${discs.length}${
      testedInAll > tests.size ? say`, in ${testedInAll} tests: a disc in several cells is tested in each` : ""
    }. ${
      grid || !last ? "" : last.stack.length > 0 ? say`On the stack: ${last.stack.join(", ")}. ` : say("The stack is empty. ")
    }${grid ? "" : done === splits ? costs(tree, said) : noCosts(said)}`;
  };
  const bar = sliders.bar;
  show();
  bar.prepend(html("div", { class: "steps" }, step("built", -1), step("built", 1), step("walk", -1), step("walk", 1)));
  let shown = { built: 0, walk: 0 };
  const setBoth = (both: typeof shown) => {
    sliders.set("built", both.built);
    sliders.set("walk", both.walk);
    show();
  };
  whenPrinted(
    () => {
      shown = { built: sliders.value("built"), walk: sliders.value("walk") };
      setBoth({ built: 1, walk: 1 });
    },
    () => setBoth(shown),
  );
  return frame(
    id,
    stage,
    bar,
    said,
    say("Drag a disc or either end of the ray. Filled: what the ray came to, darker where discs were tested; their outlines are bold."),
  );
}

/** Before it is built nothing is told of what it costs. */
function noCosts(said: HTMLElement): string {
  for (const key of ["expected", "counted", "overlap"]) delete said.dataset[key];
  return "";
}

/** What the whole tree costs a line: foretold by perimeters, and counted. */
function costs(tree: SmallTree, said: HTMLElement): string {
  const expected = expectedNodes(tree),
    met = countedNodes(tree, 60),
    over =
      tree.kind === "bvh"
        ? tree.splits.reduce((sum, { children: [a, b] }) => sum + overlap(boxOfOutline(a!.outline), boxOfOutline(b!.outline)), 0)
        : 0;
  Object.assign(said.dataset, { expected: String(expected), counted: String(met), overlap: String(over) });
  return say`A line meets Σ perimeters/perimeter = ${number(expected, 3)} of its ${tree.nodes().length} ${say(
    metBy(tree.kind)[1],
  )}; counted: ${number(met, 3)}.${tree.kind === "bvh" ? say` Boxes overlap by ${number(over, 2)} in all.` : ""}`;
}
