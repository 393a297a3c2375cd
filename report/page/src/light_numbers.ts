// The numbers of one light: who decided, the ladder, edges and gaps, the depth map.
import { beyondRounding, keyed, keyedCount, keyedDecrease, keyedSigned, keyedThings } from "./document";
import { picture, pictureNamed } from "./frame";
import { byteCount, grouped, milliseconds, percent, plainNumber, signedNumber, unsignedNumber } from "./number_text";
import { palette } from "./parts";
import { facts, lacksMap, lessonDetails, plain, result, stepName, type LightResult } from "./report_document";
import { markup, scrollRegion, swatch, type Markup } from "./template";

// How few rays were cast and denoised, and what a frame of them takes.
export function raysBlock({ map: { rays } }: LightResult, i: number): Markup | null {
  if (!rays) return null;
  const key = `lights.${i}.map.rays`;
  const time = (name: string): Markup => keyed(`${key}.times_ms.${name}.median`, milliseconds);
  const row = (name: string, value: Markup | string): Markup => markup`<tr><th scope="row">${name}</th><td class="n">${value}</td></tr>\n`;
  const per = (name: string): Markup => plain(`${key}.${name}`);
  return markup`<h3>The rays of a frame</h3>
<table><tbody>
${row("rays a pixel", rays.rays_per_pixel)}${row("sampler", rays.ray_sampler)}${row("denoiser", rays.denoiser)}${row(
    "frames in the history",
    keyedCount(`${key}.history`),
  )}${row("rays cast", keyedCount(`${key}.rays`))}${row("boxes tested a ray", per("boxes_per_ray"))}${row(
    "triangles and shapes tested a ray",
    per("primitives_per_ray"),
  )}${row("values that the denoiser read", keyedCount(`${key}.taps`))}${row(
    "kept from frame to frame",
    byteCount(rays.history_bytes),
  )}${row("time for the rays", time("rays"))}${row("time for the denoiser", time("denoiser"))}</tbody></table>
`;
}

// Which pixels the sheets decided, where rays were cast, and what it took.
export function hybridBlock({ map: { hybrid } }: LightResult, i: number): Markup | null {
  if (!hybrid) return null;
  const key = `lights.${i}.map.hybrid`,
    { receivers, surely_lit, surely_shadowed, rays, all_rays, bytes } = hybrid,
    traced = receivers - surely_lit - surely_shadowed;
  const share = (part: number, whole: number): string => (whole > 0 ? percent(part / whole) : "none");
  const row = (colour: string, name: string, pixels: Markup | string, count: number): Markup =>
    markup`<tr><td>${swatch(colour, "")}</td><th scope="row">${name}</th><td class="n">${pixels}</td><td class="n">${share(count, receivers)}</td></tr>\n`;
  const time = (name: string): Markup => keyed(`${key}.times_ms.${name}.median`, milliseconds);
  const decisions = pictureNamed(`decisions-${i}`);
  return markup`<h3>Who decided each pixel</h3>
<div class="columns">
<div><table><thead><tr><td></td><th scope="col">of the pixels that the light can reach</th><th scope="col"
class="n">pixels</th><th scope="col" class="n">share</th></tr></thead><tbody>
${row(palette.surely_lit, "surely lit", keyedCount(`${key}.surely_lit`), surely_lit)}${row(
    palette.surely_shadowed,
    "surely in shadow",
    keyedCount(`${key}.surely_shadowed`),
    surely_shadowed,
  )}${row(
    palette.traced,
    "ambiguous: traced",
    grouped(traced),
    traced,
  )}</tbody></table><p>${keyedThings(`${key}.rays`, "ray")} had to be cast where pure ray tracing asks for ${keyedCount(
    `${key}.all_rays`,
  )}: ${share(rays, all_rays)}. The sheets took ${time("build")} to build and hold ${byteCount(bytes)}
while light and scene stand still; each frame took ${time("receivers")} to find the receivers and ${time("shadow")} to decide and trace.</p>
${lessonDetails("hybrid")}</div>
${
  decisions &&
  markup`<figure>${picture(
    `decisions-${i}`,
    `picture-decisions-${i}`,
  )}<figcaption>Rays were cast for the dark red pixels alone.</figcaption></figure>\n`
}</div>
`;
}

/** The seven rungs and the six steps between them. */
export function ladderBlock({ ladder, budget }: LightResult, i: number): Markup {
  const key = `lights.${i}`,
    first = ladder[0]!.mean,
    last = ladder.at(-1)!.mean;
  const step = (k: number): Markup => {
    const of = `${key}.budget.${k}`;
    return markup`<td>${stepName(k)}</td><td class="n">${keyedDecrease(`${of}.darkened`)}</td><td class="n">${keyed(
      `${of}.lightened`,
      signedNumber,
    )}</td><td
class="n">${keyedSigned(`${of}.signed`, budget[k]!.absolute)}</td><td class="n">${keyed(`${of}.absolute`, unsignedNumber)}</td>`;
  };
  const rows = facts.rungs.map(
    ({ name, what }, k) => markup`<tr><th scope="row"><i>V</i><sub>${k}</sub> ${name}<small>${what}</small></th><td
class="n">${keyed(`${key}.ladder.${k}.mean`, (mean) => mean.toFixed(4))}</td>${
      k === 0 || k > budget.length ? markup`<td></td><td></td><td></td><td></td><td></td>` : step(k - 1)
    }</tr>\n`,
  );
  return markup`<h3>The ladder, from the truth to what was drawn</h3>
<p>Each rung changes one thing. The signed steps add up to the whole difference, exactly; an
absolute step much larger than its signed one is error that cancels out on average, but not in the
picture.</p>
${scrollRegion(
  `The ladder of light ${i + 1}`,
  markup`<table class="ladder"><thead><tr><th scope="col">visibility</th><th scope="col" class="n">mean</th>
<th scope="col">charged to</th><th scope="col" class="n">darker</th><th scope="col"
class="n">lighter</th><th scope="col" class="n">signed step</th>
<th scope="col" class="n">absolute</th></tr></thead><tbody>
${rows}<tr class="sum"><th scope="row">sum of the steps</th><td></td><td></td><td></td><td></td><td
class="n">${signedNumber(beyondRounding(last - first, last + first))}</td><td></td></tr>
</tbody></table>`,
)}${lessonDetails("error-budget")}`;
}

const fact = (name: string, value: Markup | string, what: Markup | string): Markup =>
  markup`<div><dt>${name}</dt><dd class="big">${value}</dd><dd>${what}</dd></div>\n`;

function edgeFacts({ edges }: LightResult, key: string): Markup | null {
  if (edges.count === 0) return null;
  if (edges.rms_texels === null)
    return fact(
      "Edge error",
      keyedThings(`${key}.edges.rms_pixels`, "pixel", plainNumber),
      markup`root mean square on the screen over ${keyedThings(`${key}.edges.count`, "pixel")} on true edges; ${plain(
        `${key}.edges.rms_world`,
      )} world units`,
    );
  return markup`${fact(
    "Edge error",
    keyedThings(`${key}.edges.rms_texels`, "texel", plainNumber),
    markup`root mean square over ${keyedThings(`${key}.edges.count`, "pixel")} on true edges; ${keyedThings(
      `${key}.edges.rms_pixels`,
      "pixel",
      plainNumber,
    )} on the screen`,
  )}${fact(
    "Edge offset",
    markup`${keyed(`${key}.edges.mean_texels`, signedNumber)} texels`,
    `on average the drawn shadow is ${edges.mean_texels! >= 0 ? "larger" : "smaller"} than the true one`,
  )}`;
}

function penumbraFacts({ penumbra, shadow_samples: samples }: LightResult, key: string): Markup | null {
  if (!penumbra || penumbra.edges === 0) return null;
  const of = (rest: string): string => `${key}.penumbra.${rest}`;
  const both = (what: string, drawn: number, edges: string): Markup =>
    markup`world units wide as drawn, ${plain(of(`true_${what}_world`))} in truth; medians over ${keyedThings(of(edges), "edge")}${
      drawn === 0 && "; the technique draws none"
    }`;
  return markup`${fact("Penumbra", plain(of("drawn_penumbra_world")), both("penumbra", penumbra.drawn_penumbra_world, "edges"))}${
    penumbra.umbra_edges > 0 && fact("Umbra", plain(of("drawn_umbra_world")), both("umbra", penumbra.drawn_umbra_world, "umbra_edges"))
  }${
    samples === 1
      ? fact("Standard error of the truth", "unknown", "of one sample it cannot be told")
      : fact(
          "Standard error of the truth",
          plain(of("standard_error_mean")),
          markup`mean over pixels that see a part of the light, from its samples; ${plain(of("standard_error_max"))} at most`,
        )
  }`;
}

// The closed forms beside what was found.
function theoryFacts({ theory }: LightResult, key: string): Markup | null {
  if (theory.acne_free_bias.count === 0) return null;
  const of = (rest: string): Markup => plain(`${key}.theory.${rest}`);
  return markup`${fact(
    "Bias that theory asks for",
    of("acne_free_bias.median"),
    markup`world units keep half of the pixels free of acne, ${of("acne_free_bias.p99")} keep 99 %`,
  )}${
    theory.aliasing.count > 0 &&
    fact(
      "A texel on the screen",
      markup`${of("aliasing.median")} pixels`,
      markup`wide in the median by its footprint${
        theory.measured_aliasing.count > 0 && markup`, ${of("measured_aliasing.median")} as measured`
      }; ${of("aliasing.p99")} at the worst
hundredth. Perspective makes ${of("perspective.median")} of it, the surface's tilt ${of("projection.median")}.`,
    )
  }`;
}

function texelFact(
  {
    map: {
      texel_world: { min, max },
    },
  }: LightResult,
  key: string,
): Markup {
  const of = (rest: string): Markup => plain(`${key}.map.texel_world.${rest}`);
  return fact(
    "Texel width",
    of("median"),
    min === max ? "world units, everywhere" : markup`world units, median; from ${of("min")} to ${of("max")} over the compared surface`,
  );
}

// Where a mesh's triangles show although their normals are smooth: no error of the map.
function terminatorFact({ terminator }: LightResult, key: string): Markup | null {
  if (!terminator || terminator.dark + terminator.unlit === 0) return null;
  return fact(
    "Shadow terminator",
    keyedThings(`${key}.terminator.dark`, "pixel"),
    markup`dark because the triangle faces away, though its smooth normal faces the light; ${keyedThings(
      `${key}.terminator.unlit`,
      "pixel",
    )} the other way round. No bias moves them: a finer mesh has fewer.`,
  );
}

// Where the edges lie wrong and how far shadows stand off: nothing where neither was measured.
function edgeMaps(i: number): Markup | null {
  if (!pictureNamed(`edges-${i}`)) return null;
  return markup`<div class="pair">
<figure>${picture(`edges-${i}`)}<figcaption>How far drawn shadow edges lie from the true ones, on the band between the two. White: not
at all. ${swatch(palette.false_shadow, "+")} the drawn shadow is larger, ${swatch(
    palette.missed_shadow,
    "−",
  )} smaller; full colour from ${facts.edge_scale_texels} texels on.</figcaption></figure>
<figure>${picture(`detachment-${i}`)}<figcaption>How far shadows stand off what casts them: black not at all, pale yellow ${
    facts.detachment_scale_texels
  } texels or
more.</figcaption></figure>
</div>
`;
}

/** Edges, detachment, texel width, FLIP, mean error. */
export function factsBlock(light: LightResult, i: number): Markup {
  const key = `lights.${i}`,
    known = !lacksMap(),
    { detachment, bleeding, error } = light;
  const alone = (of: "flip_compared" | "ssim_compared"): Markup | null =>
    error[of] === null ? null : markup`; over compared pixels alone ${plain(`${key}.error.${of}`)}`;
  return markup`<h3>How far, how visible</h3>
<dl class="facts">
${
  known &&
  light.seams &&
  fact(
    "Seams",
    keyedThings(`${key}.seams.changed`, "receiver"),
    markup`that the next ${
      light.light.type === "point" ? "face" : "cascade"
    } would draw otherwise, of ${keyedThings(`${key}.seams.at_border`, "receiver")} beside another ${
      light.light.type === "point" ? "face of the cube" : "cascade"
    }`,
  )
}${terminatorFact(light, key)}${known && edgeFacts(light, key)}${
    detachment.pixels > 0 &&
    fact(
      "Detachment",
      plain(`${key}.detachment.mean_world`),
      markup`world units from caster to drawn shadow on ${keyedThings(
        `${key}.detachment.pixels`,
        "pixel",
      )}, ${plain(`${key}.detachment.max_world`)} at most`,
    )
  }${
    bleeding &&
    bleeding.pixels > 0 &&
    fact(
      "Light bleeding",
      plain(`${key}.bleeding.mean`),
      markup`mean light that the filter lets into closed shadow, on ${keyedThings(
        `${key}.bleeding.pixels`,
        "pixel",
      )}; ${plain(`${key}.bleeding.max`)} at most`,
    )
  }${penumbraFacts(light, key)}${light.map.size !== null && texelFact(light, key)}${light.map.size !== null && theoryFacts(light, key)}${fact(
    "FLIP",
    plain(`${key}.error.flip`),
    markup`how visible the difference is when the two visibility pictures are flipped: 0 not at all, 1 entirely${alone("flip_compared")}`,
  )}${
    light.subpixel &&
    fact(
      "Within pixels",
      plain(`${key}.subpixel.mean_absolute`),
      markup`mean error of ${keyedThings(`${key}.subpixel.pixels`, "pixel")}, each a mean over ${light.subpixel.places} places, silhouettes too; ${keyed(
        `${key}.subpixel.unknown`,
        percent,
      )} of the places are unknown`,
    )
  }${
    result.shaded &&
    fact(
      "Finished pictures",
      keyed("shaded.mean_absolute", percent),
      markup`mean difference of the colours on a screen, of all lights together, where textures and other light hide a part; FLIP ${plain("shaded.flip")}`,
    )
  }${
    error.ssim !== null &&
    fact(
      "SSIM",
      plain(`${key}.error.ssim`),
      markup`how alike the structure of the two visibility pictures is: 1 the same${alone("ssim_compared")}`,
    )
  }${fact(
    "Mean error",
    plain(`${key}.error.mean_absolute`),
    markup`mean |<i>V</i><sub>6</sub> − <i>V</i><sub>0</sub>|; root mean square ${plain(`${key}.error.rms`)}`,
  )}</dl>
${edgeMaps(i)}`;
}

/** Viridis from far (left) to near (right). */
const depthScale = (id: string): Markup => markup`<svg class="scale" viewBox="0 0 200 12" preserveAspectRatio="none" aria-hidden="true"
focusable="false"><defs><linearGradient id="${id}">${palette.viridis.map(
  (colour, k) => markup`<stop offset="${k / 8}" stop-color="${colour}"/>`,
)}</linearGradient></defs><rect width="200"
height="12" fill="url(#${id})"/></svg>`;

export function depthMapBlock({ map }: LightResult, i: number): Markup | null {
  const { depth } = facts.light_facts[i]!;
  if (!depth) return null;
  const { near, far, perspective, texels_per_pixel: step } = depth;
  return markup`<h3>The depth map</h3>
<figure class="depth">${picture(`depth-map-${i}`)}<figcaption><span class="scale-row"><span>far ${plainNumber(far)}</span>${depthScale(
    `depth-scale-${i}`,
  )}<span>near ${plainNumber(near)}</span></span>
Depth from the light in world units${perspective && ", on a logarithmic scale"}; dark grey where nothing is stored.${
    map.faces! > 1 && (perspective ? " Six faces: +x, −x, +y above −y, +z, −z." : " Each cascade's own map, the finest first.")
  }${
    step > 1 && ` One pixel shows the nearest of ${step} × ${step} texels.`
  }${!facts.compares_depths && " This technique does not read it: it is what a hard test would look up."}</figcaption></figure>
`;
}
