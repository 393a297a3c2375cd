// Whitted's tree of rays, one ray after the other, in the upright plane through the centres of both balls of the scene. There
// every ray that begins in the plane stays in it.
import { percent } from "../number_text";
import { html, number, svg } from "../svg";
import { add, dot, length, meetCircle, meetSegment, sub, unit, type Circle, type Segment, type Vec2 } from "./flatland";
import type { FigureJson } from "./figures";
import { frame, world2, type FlatlandJson } from "./flatland_figure";
import { whenPrinted } from "./printed";
import { Sliders, Stage } from "./stage";
import { many, say } from "./say";

interface MaterialJson {
  name: string;
  mirror: number;
  transmission: number;
  ior: number;
}
export interface WhittedJson extends FlatlandJson {
  materials: MaterialJson[]; // of the circles
  least_share: number; // a ray that counts for less of its pixel is not followed
  fresnel: { cosine: number; ratio: number; reflected: number }[]; // by the program
}

/** Fresnel's share of the reflected light, the mean of both polarisations (Born and Wolf, section 1.5.2). `ratio`: the index of
    refraction before the surface over that behind it. */
export function fresnel(cosine: number, ratio: number): number {
  const k = 1 - ratio * ratio * (1 - cosine * cosine);
  if (k < 0) return 1;
  const behind = Math.sqrt(k),
    s = (ratio * cosine - behind) / (ratio * cosine + behind),
    p = (cosine - ratio * behind) / (cosine + ratio * behind);
  return 0.5 * (s * s + p * p);
}

type Kind = "eye" | "reflected" | "refracted" | "shadow";
interface Ray {
  kind: Kind;
  from: Vec2;
  to: Vec2;
  share: number; // of the pixel
  depth: number;
  parent: number; // among the rays; -1 of the eye's
  blocked: boolean; // a shadow ray that does not reach the lamp
  story: string;
}

interface Hit {
  t: number;
  at: Vec2;
  normal: Vec2; // outwards
  material: MaterialJson | null; // null: the floor
}

declare global {
  var gnomonFresnel: typeof fresnel | undefined; // eslint-disable-line no-var
}
globalThis.gnomonFresnel = fresnel;

/** What of a light's straight way a surface lets through: as seen from the thinner side. */
function passing({ normal, material }: Hit, direction: Vec2): number {
  return material && material.transmission > 0
    ? material.transmission * (1 - fresnel(Math.abs(dot(direction, normal)), 1 / material.ior))
    : 0;
}

export class Tracer2 {
  readonly rays: Ray[] = [];
  constructor(
    private readonly json: WhittedJson,
    private readonly floor: Segment[],
    private readonly balls: Circle[],
    private readonly lamp: Vec2,
    private readonly far: number,
  ) {}

  meet(from: Vec2, direction: Vec2, own: boolean): Hit | null {
    let hit: Hit | null = null;
    const nearer = (t: number, normal: (at: Vec2) => Vec2, material: MaterialJson | null) => {
      if (!(t > (own ? 1e-9 : 0)) || t >= (hit?.t ?? Infinity)) return;
      const at = add(from, direction, t);
      hit = { t, at, normal: normal(at), material };
    };
    for (const segment of this.floor) nearer(meetSegment(from, direction, segment), () => segment.normal, null);
    this.balls.forEach((ball, i) => {
      const span = meetCircle(from, direction, ball);
      for (const t of span ?? []) nearer(t, (at) => unit(sub(at, ball.center)), this.json.materials[i]!);
    });
    return hit;
  }

  /** Breadth first: every ray before those that it calls for. */
  trace(eye: Vec2, aim: Vec2): void {
    const waiting: { kind: Kind; from: Vec2; direction: Vec2; share: number; depth: number; parent: number; why: string }[] = [
      { kind: "eye", from: eye, direction: unit(sub(aim, eye)), share: 1, depth: 0, parent: -1, why: say("From the eye through a pixel") },
    ];
    for (let next = waiting.shift(); next && this.rays.length < 120; next = waiting.shift()) {
      const { kind, from, direction, share, depth, parent, why } = next,
        hit = this.meet(from, direction, depth > 0),
        own = this.rays.length;
      this.rays.push({
        kind,
        from,
        to: hit?.at ?? add(from, direction, this.far),
        share,
        depth,
        parent,
        blocked: false,
        story: `${why}: ${
          hit
            ? say`it meets the ${hit.material?.name ?? say("floor")} after ${number(hit.t, 3)}`
            : say("it meets nothing and takes the background")
        }.`,
      });
      if (!hit) continue;
      const inside = dot(direction, hit.normal) > 0,
        n: Vec2 = inside ? [-hit.normal[0], -hit.normal[1]] : hit.normal;
      if (!inside) this.shadow(hit.at, n, share, depth, own);
      const { mirror, transmission, ior } = hit.material ?? { mirror: 0, transmission: 0, ior: 1 },
        c = -dot(direction, n),
        ratio = inside ? ior : 1 / ior;
      const degrees = (cosine: number) => `${number((Math.acos(Math.min(1, cosine)) * 180) / Math.PI, 3)}°`;
      const follow = (to: Kind, way: Vec2, part: number, words: string) => {
        if (part * share >= this.json.least_share)
          waiting.push({ kind: to, from: hit.at, direction: way, share: part * share, depth: depth + 1, parent: own, why: words });
      };
      const reflected = add(direction, n, 2 * c),
        mirrored = say`Reflected at ${degrees(c)}`;
      if (transmission > 0) {
        const R = fresnel(c, ratio),
          k = 1 - ratio * ratio * (1 - c * c);
        follow(
          "reflected",
          reflected,
          transmission * R,
          k < 0 ? say`${mirrored}, all of it: total reflection` : say`${mirrored}, Fresnel's ${percent(R)}`,
        );
        if (k >= 0)
          follow(
            "refracted",
            unit(add([ratio * direction[0], ratio * direction[1]], n, ratio * c - Math.sqrt(k))),
            transmission * (1 - R),
            say`Refracted ${
              inside ? say("out of") : say("into")
            } the glass, from ${degrees(c)} to ${degrees(Math.sqrt(k))}, ${percent(1 - R)} of it`,
          );
      } else if (mirror > 0) follow("reflected", reflected, mirror, say`${mirrored}, ${percent(mirror)} by the mirror`);
    }
  }

  /** Straight to the lamp: glass lets light through, less at each of its surfaces, and one ray more goes on behind it. */
  private shadow(at: Vec2, normal: Vec2, share: number, depth: number, parent: number): void {
    const direction = unit(sub(this.lamp, at));
    if (dot(direction, normal) <= 0) return; // turned away: dark without asking
    for (let from = at, light = 1; ;) {
      const hit = this.meet(from, direction, true),
        blocker = hit && hit.t < length(sub(this.lamp, from)) ? hit : null;
      const passes = blocker ? passing(blocker, direction) : 0,
        glass = passes > 0;
      light *= blocker ? passes : 1;
      const what = !blocker
        ? light < 1
          ? say`nothing more is in its way, the surfaces of the glass let ${percent(light)} of the light through`
          : say("nothing is in its way, the point is lit")
        : glass
          ? say`the ${blocker.material!.name} is in its way and lets ${percent(passes)} through`
          : say`the ${blocker.material?.name ?? say("floor")} is in its way, the point is in shadow`;
      this.rays.push({
        kind: "shadow",
        from,
        to: blocker?.at ?? this.lamp,
        share,
        depth: depth + 1,
        parent,
        blocked: blocker !== null && !glass,
        story: say`Shadow ray to the lamp: ${what}.`,
      });
      if (!blocker || !glass) return;
      from = blocker.at;
    }
  }
}

/** The tree beside the scene: each ray below the one that called for it, and the share of the pixel with which it goes on. */
function treeOf(rays: readonly Ray[], last: Ray | undefined): SVGElement {
  const rows = Math.max(...rays.map((ray) => ray.depth), 0) + 1,
    width = 960,
    height = 60 * rows + 10,
    levels = Array.from({ length: rows }, (_, depth) => rays.filter((ray) => ray.depth === depth));
  const places = new Map<Ray, Vec2>(),
    place = (ray: Ray): Vec2 => places.get(ray)!;
  for (const row of levels) {
    row.sort((a, b) => (a.parent < 0 ? 0 : place(rays[a.parent]!)[0] - place(rays[b.parent]!)[0])); // below their parents
    row.forEach((ray, i) => places.set(ray, [((i + 0.5) / row.length) * width, 60 * ray.depth + 30]));
  }
  const drawing = svg("svg", {
    class: "flatland ray-tree",
    viewBox: `0 0 ${width} ${height}`,
    role: "img",
    "aria-label": say("The tree of rays: each below the one that called for it"),
  });
  for (const ray of rays.filter(({ parent }) => parent >= 0)) {
    const [x1, y1] = place(rays[ray.parent]!),
      [x2, y2] = place(ray);
    drawing.append(
      svg("path", {
        class: `tree ${ray.kind}${ray.blocked ? " blocked" : ""}`,
        d: `M${x1.toFixed(1)},${y1}L${x2.toFixed(1)},${y2}`,
        "stroke-width": 2,
      }),
    );
  }
  for (const ray of rays) {
    const [x, y] = place(ray),
      crowded = levels[ray.depth]!.length > 9;
    drawing.append(svg("circle", { class: `node ${ray.kind}`, cx: x, cy: y, r: ray === last ? 13 : 9 }));
    if (ray.kind !== "shadow" && !crowded) drawing.append(svg("text", { x: x + 16, y: y + 6 }, percent(ray.share)));
  }
  return drawing;
}

export function whittedFigure({ settings, data }: FigureJson, id: string): HTMLElement {
  const json = data as WhittedJson,
    { segments: floor, circles: balls } = world2(json),
    { window } = json,
    [left, right, bottom, top] = window;
  const shareX = (x: number) => (x - left) / (right - left),
    shareY = (y: number) => (y - bottom) / (top - bottom);
  let handles: Record<"eye" | "aim" | "lamp", Vec2>;
  const stage = new Stage(
    window,
    say("A glass ball and a mirror ball over a floor, and the tree of rays of one pixel"),
    (at, handle) => {
      sliders.set(`${handle}X`, shareX(at[0]));
      sliders.set(`${handle}Y`, shareY(at[1]));
    },
    () => handles,
  );
  const said = html("p", { class: "bias-counts", role: "status" });
  const slider = (name: string, value: number) => ({
    name,
    from: 0,
    to: 1,
    step: 0.001,
    value,
    text: (v: number) => number(v, 3),
    drags: true,
  });
  const sliders: Sliders<string> = new Sliders<string>(
    {
      step: { name: say("Rays"), from: 0, to: 1, step: 0.001, value: Number(settings.step ?? 1), text: (v) => percent(v) },
      eyeX: slider(say("Eye, left and right"), 0.05),
      eyeY: slider(say("Eye, up and down"), 0.45),
      aimX: slider(say("Aim, left and right"), shareX(balls[0]!.center[0] - 0.2)),
      aimY: slider(say("Aim, up and down"), shareY(balls[0]!.center[1] + 0.35)),
      lampX: slider(say("Lamp, left and right"), 0.3),
      lampY: slider(say("Lamp, up and down"), 0.93),
    },
    () => show(),
  );
  const step = (by: number) => {
    const button = html("button", { type: "button", class: by > 0 ? "next-ray" : "" }, by > 0 ? say("Next ray") : say("Ray before"));
    button.addEventListener("click", () => {
      const n = total,
        at = Math.round(sliders.value("step") * n);
      sliders.set("step", Math.min(Math.max((at + by) / n, 0), 1));
    });
    return button;
  };
  let total = 1;
  const tree = html("div", { class: "live-tree" });
  const show = () => {
    const point = (key: string): Vec2 => [
      left + sliders.value(`${key}X`) * (right - left),
      bottom + sliders.value(`${key}Y`) * (top - bottom),
    ];
    handles = { eye: point("eye"), aim: point("aim"), lamp: point("lamp") };
    const tracer = new Tracer2(json, floor, balls, handles.lamp, 2 * (right - left));
    tracer.trace(handles.eye, handles.aim);
    total = tracer.rays.length;
    const rays = tracer.rays.slice(0, Math.round(sliders.value("step") * total)),
      last = rays.at(-1);
    const outline = balls.map(({ center, radius }) =>
      Array.from({ length: 121 }, (_, i): Vec2 => add(center, [Math.cos((i * Math.PI) / 60), Math.sin((i * Math.PI) / 60)], radius)),
    );
    stage.put(
      stage.path(
        "profile",
        floor.map((s) => [s.from, s.to]),
      ),
      ...outline.map((o, i) => stage.path(`ball ${json.materials[i]!.transmission > 0 ? "glass" : "mirror"}`, [o])),
      ...rays.map((ray) => {
        const path = stage.path(`tree ${ray.kind}${ray.blocked ? " blocked" : ""}${ray === last ? " last" : ""}`, [[ray.from, ray.to]]);
        path.setAttribute("stroke-width", String(1.5 + 4.5 * Math.sqrt(ray.share)));
        return path;
      }),
      ...balls.map(({ center }, i) => stage.label("middle", center, json.materials[i]!.transmission > 0 ? say("glass") : say("mirror"), 6)),
      stage.circle("sun", handles.lamp, 13),
      stage.circle("point", handles.eye, 11),
      stage.circle("moved", handles.aim, 9),
      stage.label("middle", handles.eye, say("eye"), -18),
      stage.label("middle", handles.lamp, say("lamp"), -20),
    );
    tree.replaceChildren(treeOf(rays, last));
    Object.assign(said.dataset, { rays: String(rays.length), total: String(total), share: String(last?.share ?? 0) });
    said.textContent = say`${rays.length} of ${many(total, "ray", "rays")}. ${
      last ? say`${last.story} It counts for ${percent(last.share)} of the pixel.` : ""
    }`;
  };
  show();
  let shown = 1;
  const setStep = (value: number) => {
    sliders.set("step", value);
    show();
  };
  whenPrinted(
    () => {
      shown = sliders.value("step");
      setStep(1);
    },
    () => setStep(shown),
  );
  sliders.bar.prepend(html("div", { class: "steps" }, step(-1), step(1)));
  const figure = frame(
    id,
    stage,
    sliders.bar,
    said,
    say`Drag the eye, what it looks at, and the lamp. Orange: the eye's ray; violet: reflected; blue: refracted; gold: a shadow ray that reaches the lamp; dotted: one that does not. The wider, the more it counts; below ${percent(
      json.least_share,
    )} of the pixel a ray is not followed.`,
  );
  said.after(tree);
  return figure;
}
