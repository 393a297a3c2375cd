// The rows of labels, steps and rungs. The colours are Okabe and Ito's colour-blind-safe set (Okabe & Ito 2008, "Color
// Universal Design") and, for the labels beyond its size, some of Paul Tol's "muted" and "dark" schemes (2021). Right and
// uncounted pixels stay grey, so that colour always means an error.
#include "compare/ladder/labels.h"

#include <array>

#include "compare/result/outputs.h"
#include "raster/technique_traits.h"

namespace gnomon::compare {
namespace {

constexpr int first_label = static_cast<int>(Label::uncertain);

// In the order of the label's values.
constexpr std::array<LabelText, 1 + class_count - first_label> labels{{
    {"uncertain",
     "uncertain",
     "?",
     {0xb5, 0xd3, 0xa8},
     std::nullopt,
     "error-budget",
     "the exact answer lies within its own error bound",
     "",
     ""},
    {"silhouette",
     "silhouette",
     "o",
     {0x1c, 0x1e, 0x22},
     std::nullopt,
     "error-budget",
     "the two renderers see different surfaces here",
     "",
     ""},
    {"facing_away",
     "facing away",
     "/",
     {0x8f, 0x93, 0x9b},
     std::nullopt,
     "error-budget",
     "turned away from the light, or outside a spot light's cone: dark whatever shadows say",
     "",
     ""},
    {"background",
     "background",
     "\u00b7",
     {0x3c, 0x42, 0x4c},
     std::nullopt,
     "error-budget",
     "no surface",
     "",
     ""},
    {"right",
     "right",
     "\u2713",
     {0xf2, 0xf2, 0xef},
     std::nullopt,
     "error-budget",
     "both renderers agree",
     "",
     ""},
    {"acne",
     "acne",
     "A",
     {0xd5, 0x5e, 0x00},
     Cause::slope,
     "acne",  // vermillion
     "the surface shadows itself",
     "A texel holds one depth, but the surface slopes across it. The part of the surface that lies behind "
     "that depth takes itself for an occluder, in stripes that follow the texels.",
     "A bias of at least the depth by which the surface falls over half a texel; a slope bias of 1 is "
     "exactly that on planes. A finer map needs proportionally less.",
     "a surface shadows itself because the map holds one depth per texel: at the slope step, or at the bias "
     "or the filter step where the map holds the receiver's own sheet or a filter reaches it"},
    {"precision",
     "precision",
     "P",
     {0xf0, 0xe4, 0x42},
     Cause::precision,
     "precision",  // yellow
     "the stored depth is not the depth the light sees",
     "The depth was rounded to the map's format or interpolated across the triangle, or the fill rule gave "
     "the texel to a neighbour: with the exact depth the same test, with the same bias, would be right.",
     "A format with more bits (d32f), a depth range fitted closer to the scene, or a slightly larger bias.",
     "the precision step, or the biased test is wrong with the stored depth and right with the exact one, or "
     "a technique without a filter draws other than its test says"},
    {"peter_panning",
     "peter-panning",
     "D",
     {0x00, 0x72, 0xb2},
     Cause::bias,
     "peter-panning",  // blue
     "the shadow has come loose from its caster",
     "The bias reaches past a true occluder that lies close to the surface, so the shadow starts too late "
     "and the object seems to float.",
     "Less bias. A finer map, or a bias that grows only with the slope, makes less of it enough.",
     "the bias step, missed shadow, and the stored primitive is a true occluder"},
    {"light_leak",
     "light leak",
     "L",
     {0x56, 0xb4, 0xe9},
     std::nullopt,
     "light-leaks",  // sky blue
     "light gets through where the bias or the filter looked past the occluder",
     "The map knows that something stands in the light's way, and the test let light through all the same: "
     "typical behind thin walls and in corners.",
     "Less bias, a narrower filter, or walls that are thicker than the bias.",
     "missed shadow by bias or filter otherwise"},
    {"aliasing",
     "aliasing",
     "S",
     {0xcc, 0x79, 0xa7},
     Cause::sampling,
     "aliasing",  // reddish purple
     "the shadow's edge follows the texels",
     "Beside a true shadow edge the texel's centre falls on the other side of the edge than the pixel does, "
     "so the edge turns into stairs of about a texel. No bias mends that: where the map misses an occluder, "
     "a surface that shadows itself may hide the gap until a bias cures its acne.",
     "Smaller texels where the camera looks: a larger map or one fitted closer. A filter hides the stairs, "
     "but blurs.",
     "the sampling step, and the caster lies under a texel centre nearby"},
    {"missed_feature",
     "missed feature",
     "M",
     {0x00, 0x9e, 0x73},
     Cause::sampling,
     "aliasing",  // bluish green
     "the shadow of something thinner than a texel is missing",
     "None of the four texel centres around the pixel meets the occluder, so the map does not know it there.",
     "A larger map, or exact rays where texels hold more than one surface.",
     "the sampling step, missed shadow, and the caster lies under no texel centre nearby"},
    {"false_feature",
     "false feature",
     "F",
     {0xe6, 0x9f, 0x00},
     Cause::sampling,
     "aliasing",  // orange
     "a thin occluder darkens a whole texel",
     "The texel's centre happens to meet an occluder that ends before the next texels' centres; every pixel "
     "that looks the texel up is dark.",
     "A larger map, or exact rays where texels hold more than one surface.",
     "the sampling step, false shadow, and the caster lies under this texel's centre alone"},
    {"blur",
     "blur",
     "B",
     {0x99, 0x99, 0x33},
     Cause::filter,
     "filtering",  // olive (Tol)
     "the filter's penumbra is not the light's",
     "The technique averages over neighbouring texels, or a denoiser over neighbouring pixels, which "
     "softens edges that are sharp.",
     "A smaller filter radius; of few rays a denoiser that is as wide as the penumbra.",
     "the filter step, within its reach of a true shadow edge"},
    {"light_size",
     "light size",
     "Z",
     {0x33, 0x22, 0x88},
     Cause::light_size,
     "soft-shadows",  // indigo (Tol)
     "the light is larger than the point that the map takes it for",
     "A depth map sees the scene from one point; a light with a size has a penumbra.",
     "A technique that estimates the penumbra, or a smaller light.",
     "the light shrunk to its centre"},
    {"outside_map",
     "outside the map",
     "X",
     {0x88, 0x22, 0x55},
     Cause::sampling,
     "cascades",  // wine (Tol)
     "the depth map does not reach this far",
     "The surface lies outside the part of the scene that the map covers: beside its window, or before or "
     "behind "
     "its depths.",
     "A map fitted to the whole scene; where what lies outside is dark, light for it.",
     "the lookup falls outside the map"},
    {"custom_shader",
     "custom shader",
     "C",
     {0x66, 0x33, 0x33},
     Cause::filter,
     "filtering",  // dark red (Tol, "dark")
     "a shader of your own drew other than the map's test says",
     "With --shader-dir a file of yours stands in for the program's own; up to its last step the ladder is "
     "that of the hard test with the map, and the rest is the shader's.",
     "Whatever the shader is meant to show.",
     "the filter step, drawn by a shader of --shader-dir; all wrong pixels where it reads neither bias nor "
     "gap"},
    {"unexplained",
     "unexplained",
     "U",
     {0x00, 0x00, 0x00},
     std::nullopt,
     "error-budget",
     "another renderer drew this, and what the capture says of its map does not explain it",
     "A capture without its depth map shows where the shadow is wrong, not which step of the depth test made "
     "it so. With the map, the test that the capture describes is not the one that was drawn here, or the "
     "map does not hold what the scene holds here.",
     "A capture with the map, its matrix and its bias as they were drawn with; or, without a map, `gnomon "
     "judge --identify`, which looks for the setting that comes nearest.",
     "gnomon judge: of a capture without its depth map no step is known; with it, the test that it describes "
     "is not the one that was drawn there"},
    {"caster_bias",
     "caster bias",
     "H",
     {0x44, 0xaa, 0x99},
     Cause::bias,
     "peter-panning",  // teal (Tol)
     "the map holds its casters farther from the light than they are",
     "What was drawn into the map was moved or shrunk: a polygon offset (--caster-bias, "
     "--caster-slope-bias), a "
     "depth or normal bias of casters. The shadow test then has that much bias, whatever it adds itself.",
     "Less of that offset, or a bias of the opposite sign in the test.",
     "gnomon judge: the map holds casters farther from the light than they are: a polygon offset, or casters "
     "moved or shrunk"},
    {"missing_caster",
     "missing caster",
     "N",
     {0x11, 0x77, 0x33},
     Cause::caster,
     "shadow-map",  // green (Tol)
     "what casts the shadow is not in the map",
     "At this texel the light first meets an object that the map does not hold: it was not drawn into the "
     "map.",
     "Draw the object into the map: let it cast shadows, and do not leave it out by what the camera sees.",
     "gnomon judge: the map does not hold the object that the light meets first"},
    {"moved_caster",
     "moved caster",
     "V",
     {0xaa, 0x44, 0x99},
     Cause::caster,
     "shadow-map",  // purple (Tol)
     "the map holds a caster where the scene has none",
     "The map was drawn before something moved, or with something that the scene does not have.",
     "Draw the map again when a caster or the light moves.",
     "gnomon judge: the map holds a caster where the scene has none"},
    {"clipped_caster",
     "clipped caster",
     "K",
     {0x66, 0x11, 0x00},
     Cause::caster,
     "cascades",  // brown (Tol)
     "the caster lies before the map's near plane, or behind its far one",
     "What lies outside the map's depths is not drawn into it, and casts no shadow.",
     "A nearer near plane (or a farther far one), or depths clamped to the planes.",
     "gnomon judge: the caster lies before the map's near plane or behind its far one"},
    {"culled_caster",
     "culled caster",
     "Q",
     {0xdd, 0xcc, 0x77},
     Cause::caster,
     "shadow-map",  // sand (Tol)
     "the side of the caster that faces the light was culled",
     "Faces of one side are left out of the map, and here the caster has no other side behind them.",
     "Draw both sides of such objects into the map, or give them a thickness.",
     "gnomon judge: the caster's side that faces the light was culled, and it has no other there"},
    {"ignored_alpha",
     "ignored alpha",
     "T",
     {0x88, 0xcc, 0xee},
     Cause::caster,
     "shadow-map",  // cyan (Tol)
     "a hole of the caster's alpha mask is filled in the map",
     "The pass that draws the map does not test alpha, so that the whole triangle casts a shadow.",
     "Test alpha in the map's pass, too.",
     "gnomon judge: the map holds a caster where its alpha mask has a hole"},
    {"noise",
     "noise",
     "\u2234",
     {0xee, 0x66, 0x77},
     Cause::rays_noise,
     "one-ray",  // red (Tol, "bright")
     "so few rays met the light by chance",
     "One ray sees one point of the light. How many of few arrive is chance, and where the filter is narrow, "
     "or takes the noise for a shadow's edge, it stays.",
     "More rays, a longer history, or a denoiser with a wider filter.",
     "technique rays: the noise step, the rays in place of the truth"},
    {"lag",
     "lag",
     "G",
     {0x44, 0x77, 0xaa},
     Cause::rays_lag,
     "one-ray",  // blue (Tol, "bright")
     "the history holds what was true before",
     "Earlier frames are mixed in, and the shadow was elsewhere then, or the pixel was.",
     "A shorter history, or one that is given up sooner where something moves.",
     "technique rays: the lag step, earlier frames' truths in place of this one's"},
    {"remap",
     "remap",
     "R",
     {0x22, 0x55, 0x55},
     Cause::rays_remap,
     "one-ray",  // teal (Tol, "dark")
     "the denoiser's last touch changed what its filter had made",
     "A clamp of the history or a contrast in the end is no mean of what the rays saw.",
     "The denoiser without that touch, or another one.",
     "technique rays: the remap step, with the denoiser's clamps and contrast"},
}};

constexpr std::array<StepText, cause_count + 1> steps{{
    {"light_size", "light size", "the light shrinks to a point", Label::light_size},
    {"sampling", "sampling", "one ray per texel instead of one per pixel", Label::aliasing},
    {"slope", "slope", "one depth for the whole texel", Label::acne},
    {"precision", "precision", "the depth as stored in the map", Label::stored_depth},
    {"bias", "bias", "the depth test with its bias", Label::peter_panning},
    {"filter", "filter", "the technique's filter", Label::blur},
    {"caster", "caster", "casters that the map does not hold where the scene has them",
     Label::missing_caster},
}};

// Of few rays; Cause::rays_blur and the following.
constexpr std::array<StepText, cause_count> ray_steps{{
    {"light_size", "light size", "nothing: rays go to the light as it is", Label::light_size},
    {"sampling", "sampling", "nothing: there is no texel", Label::aliasing},
    {"blur", "blur", "the truth through the denoiser's weights", Label::blur},
    {"lag", "lag", "earlier frames' truths through the history", Label::lag},
    {"noise", "noise", "the rays in place of the truth", Label::noise},
    {"remap", "remap", "the denoiser's clamps and contrast", Label::remap},
}};

constexpr std::array<RungText, rung_count> ray_rungs{{
    {"V0", "truth", "exact rays to the light as it is"},
    {"V1", "point", "the same: rays go to the light as it is"},
    {"V2", "texel", "the same: there is no texel"},
    {"V3", "blurred", "the truth through the denoiser's weights"},
    {"V4", "lagged", "the same, with earlier frames' truths in the history"},
    {"V5", "sampled", "the rays that were cast, through the same weights"},
    {"V6", "drawn", "what the denoiser drew"},
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
  return labels[static_cast<std::size_t>(static_cast<int>(label) - first_label)];
}
const StepText& step_text(Cause cause, Ladder ladder) {
  const auto place = static_cast<std::size_t>(cause);
  return ladder == Ladder::rays && place < ray_steps.size() ? ray_steps[place] : steps[place];
}
const RungText& rung_text(Rung rung, Ladder ladder) {
  return (ladder == Ladder::rays ? ray_rungs : rungs)[static_cast<std::size_t>(rung)];
}

Ladder ladder_of(raster::Technique technique) {
  return raster::samples_rays(technique) ? Ladder::rays : Ladder::map;
}

std::string_view cause_name(Cause cause, Ladder ladder) {
  return step_text(cause, ladder).key;
}
std::string_view label_name(Label label) {
  return label_text(label).key;
}
glm::u8vec3 label_colour(Label label) {
  return label_text(label).colour;
}

}  // namespace gnomon::compare
