#include "report/explanations.h"

namespace gnomon::compare {
namespace {

// In the order of the label's values, from uncertain (-4) on.
constexpr std::array<LabelText, 5 + class_count> labels{{
    {"uncertain", "?", "the exact answer lies within its own error bound", "", ""},
    {"silhouette", "o", "the two renderers see different surfaces here", "", ""},
    {"facing away", "/",
     "turned away from the light, or outside a spot light's cone: dark whatever shadows say", "", ""},
    {"background", "\u00b7", "no surface", "", ""},
    {"right", "\u2713", "both renderers agree", "", ""},
    {"acne", "A", "the surface shadows itself",
     "A texel holds one depth, but the surface slopes across it. The part of the surface that lies behind "
     "that depth "
     "takes itself for an occluder, in stripes that follow the texels.",
     "A bias of at least the depth by which the surface falls over half a texel; a slope bias of 1 is "
     "exactly that on "
     "planes. A finer map needs proportionally less."},
    {"precision", "P", "the stored depth is not the depth the light sees",
     "The depth was rounded to the map's format or interpolated across the triangle, or the fill rule gave "
     "the texel to "
     "a neighbour: with the exact depth the same test, with the same bias, would be right.",
     "A format with more bits (d32f), a depth range fitted closer to the scene, or a slightly larger bias."},
    {"peter-panning", "D", "the shadow has come loose from its caster",
     "The bias reaches past a true occluder that lies close to the surface, so the shadow starts too late "
     "and the "
     "object seems to float.",
     "Less bias. A finer map, or a bias that grows only with the slope, makes less of it enough."},
    {"light leak", "L", "light gets through where the bias or the filter looked past the occluder",
     "The map knows that something stands in the light's way, and the test let light through all the same: "
     "typical "
     "behind thin walls and in corners.",
     "Less bias, a narrower filter, or walls that are thicker than the bias."},
    {"aliasing", "S", "the shadow's edge follows the texels",
     "Beside a true shadow edge the texel's centre falls on the other side of the edge than the pixel does, "
     "so the edge "
     "turns into stairs of about a texel. No bias mends that: where the map misses an occluder, a surface "
     "that shadows "
     "itself may hide the gap until a bias cures its acne.",
     "Smaller texels where the camera looks: a larger map or one fitted closer. A filter hides the stairs, "
     "but blurs."},
    {"missed feature", "M", "the shadow of something thinner than a texel is missing",
     "None of the four texel centres around the pixel meets the occluder, so the map does not know it there.",
     "A larger map, or exact rays where texels hold more than one surface."},
    {"false feature", "F", "a thin occluder darkens a whole texel",
     "The texel's centre happens to meet an occluder that ends before the next texels' centres; every pixel "
     "that looks "
     "the texel up is dark.",
     "A larger map, or exact rays where texels hold more than one surface."},
    {"blur", "B", "the filter's penumbra is not the light's",
     "The technique averages over neighbouring texels, which softens edges that are sharp.",
     "A smaller filter radius."},
    {"light size", "Z", "the light is larger than the point that the map takes it for",
     "A depth map sees the scene from one point; a light with a size has a penumbra.",
     "A technique that estimates the penumbra, or a smaller light."},
    {"outside the map", "X", "the depth map does not reach this far",
     "The surface lies outside the part of the scene that the map covers.",
     "A map fitted to the whole scene."},
    {"custom shader", "C", "a shader of your own drew other than the map's test says",
     "With --shader-dir a file of yours stands in for the program's own; up to its last step the ladder is "
     "that of the "
     "hard test with the map, and the rest is the shader's.",
     "Whatever the shader is meant to show."},
    {"unexplained", "U",
     "another renderer drew this, and what the capture says of its map does not explain it",
     "A capture without its depth map shows where the shadow is wrong, not which step of the depth test "
     "made it so. With the map, the test that the capture describes is not the one that was drawn here, or "
     "the map does not hold what the scene holds here.",
     "A capture with the map, its matrix and its bias as they were drawn with; or, without a map, `gnomon "
     "judge "
     "--identify`, which looks for the setting that comes nearest."},
}};

constexpr std::array<StepText, cause_count> steps{{
    {"light size", "the light shrinks to a point"},
    {"sampling", "one ray per texel instead of one per pixel"},
    {"slope", "one depth for the whole texel"},
    {"precision", "the depth as stored in the map"},
    {"bias", "the depth test with its bias"},
    {"filter", "the technique's filter"},
}};

constexpr std::array<RungText, rung_count> rungs{{
    {"V0", "truth", "exact rays to the light as it is"},
    {"V1", "point", "exact rays to the light's centre"},
    {"V2", "texel", "the exact ray through the texel's centre"},
    {"V3", "flat", "the same, with one depth for the whole texel"},
    {"V4", "stored", "compared with the depth that the map stores"},
    {"V5", "biased", "the same, with the bias"},
    {"V6", "drawn", "what the rasterizer drew"},
}};

}  // namespace

const LabelText& label_text(Label label) {
  const int place = static_cast<int>(label) + 4;
  return labels[static_cast<std::size_t>(place)];
}
const StepText& step_text(Cause cause) {
  return steps[static_cast<std::size_t>(cause)];
}
const RungText& rung_text(Rung rung) {
  return rungs[static_cast<std::size_t>(rung)];
}

}  // namespace gnomon::compare
