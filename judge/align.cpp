#include "judge/align.h"

#include <fmt/core.h>

#include "compare/result/number_text.h"
#include "judge/captured_map.h"
#include "scene/base/stages.h"

namespace gnomon::judge {
namespace {

using compare::Judged;
using compare::Mended;

/// Right captures agree on more than 0.98 of each (the rest are a rasterizer's own pixels along edges); half a
/// pixel off leaves 0.7 to 0.85 of the silhouettes and none of the positions.
constexpr double least_geometry = 0.93;
/// Are shares of silhouettes that are edges of a picture with other light in it: some have the colour of what is behind
/// them. Below the second it is another view.
constexpr double least_edges = 0.75, no_edges = 0.5;
/// A suspect's view without background, or with half of the silhouettes, proves nothing by those that agree, unless its
/// shadows do.
constexpr double least_kind = 0.05, least_outlines = 0.5;
/// A suspect must agree clearly better, and undo most of what did not agree; more of it where shadows alone tell, since
/// a picture that is some pixels off agrees a little better under many a wrong view.
constexpr double least_gain = 0.03, most_left = 0.5, most_left_alone = 1.0 / 3.0;
/// Are shares of shadows: above the first nobody is suspected; below the second nothing can be told from chance.
constexpr double good_shadows = 0.95, no_shadows = 0.6;
constexpr std::size_t few_samples = 50;
/// Pixels of a ratio above 1, and how many times those below it: what single pixels of a path tracer do not make.
constexpr std::size_t least_brighter = 20;
constexpr double times_darker = 10.0;

std::string hundredths_of_percent(double share) {
  return fmt::format("{:.2f} %", 100.0 * share);
}

/// An error without --fix.
Expected<void> accept_mended(const Capture& capture, bool fix, const Mended& mended, Judged& judged) {
  if (!fix)
    return capture_error(capture, "",
                         fmt::format("{}: {} of the {} agree, with that undone {} (--fix undoes it)",
                                     mended.what, hundredths_of_percent(mended.before), mended.evidence,
                                     hundredths_of_percent(mended.after)));
  judged.mended.push_back(mended);
  return {};
}

bool mends(double before, double after, double left = most_left) {
  return after > before + least_gain && 1.0 - after < left * (1.0 - before);
}

/// Shadows of another scene, camera or light; those that are inverted agree less.
bool at_chance(const std::optional<double>& shadows) {
  return shadows && std::abs(*shadows - 0.5) < no_shadows - 0.5;
}

std::optional<double> share_of(const Evidence& evidence, bool geometric) {
  if (!geometric) return evidence.visibility;
  const auto found = evidence.geometry();
  if (!found) return std::nullopt;
  return found->share;
}

struct Found {
  Suspect suspect;
  double share = 0.0;
  std::optional<double> shadows;  // the share of them that agrees
  std::size_t lit = 0;            // samples
};

bool proves_nothing(const Evidence& suspected, const Evidence& now) {
  const bool by_outlines = !suspected.positions && !suspected.depths;
  const bool by_shadows = suspected.visibility && *suspected.visibility >= good_shadows;
  return by_outlines && !by_shadows &&
         (suspected.least_kind < least_kind ||
          static_cast<double>(suspected.outlines) < least_outlines * static_cast<double>(now.outlines));
}

/// The suspect that agrees best; of alike ones the one whose shadows do.
std::optional<Found> best_suspect(const EvidenceInput& in, const Samples& samples,
                                  const std::vector<Suspect>& suspects, bool geometric, bool all) {
  const Evidence now = gather(in, samples, {});
  std::optional<Found> best;
  for (const Suspect& suspect : suspects) {
    if (all ? !suspect.by_shadows : suspect.geometric != geometric) continue;
    const Evidence evidence = gather(in, samples, suspect);
    const auto share = share_of(evidence, geometric);
    if (!share || (geometric && proves_nothing(evidence, now))) continue;
    const Found found{suspect, *share, evidence.visibility, evidence.lit};
    const bool alike = best && std::abs(found.share - best->share) < 0.002;
    const bool better = !best || (alike ? found.shadows.value_or(0.0) > best->shadows.value_or(0.0) + 0.002
                                        : found.share > best->share);
    if (better) best = found;
  }
  return best;
}

/// A camera that sees what the view does; none where no camera can.
std::optional<Camera> camera_of(const Camera& camera, const View& view) {
  Camera out = camera;
  const double reach = std::max(1e-6, glm::length(camera.target - camera.eye));
  out.eye = view.eye, out.target = view.eye + reach * view.forward, out.up = view.up;
  if (view.orthographic())
    out.orthographic_height = 2.0 * view.half_y;
  else
    out.vertical_fov = 2.0 * std::atan(view.tan_half_y);
  const View made = make_view(out, view.size);
  const double width = made.half_x + made.tan_half_x, wanted = view.half_x + view.tan_half_x;
  const bool same = glm::dot(made.right, view.right) > 1.0 - 1e-9 && std::abs(width - wanted) < 1e-9 * wanted;
  if (!same) return std::nullopt;
  return out;
}

class Aligner {
 public:
  Aligner(const AlignInput& in, Scene& scene, Sight& sight, CapturedPictures& pictures, Judged& judged)
      : in_(in), scene_(scene), sight_(sight), pictures_(pictures), judged_(judged), map_(in.map) {
    const Light& light = scene.lights[in.light];
    suspects_ = usual_suspects({scene.camera, in.capture.size, !pictures.position.data.empty(),
                                !pictures.depth.data.empty(), light.type != LightType::point});
    if (!pictures.position.data.empty())
      if (const auto world = find_world(pictures.position, in.frame)) {
        Suspect& suspect = suspects_.emplace_back();
        suspect.what = "the positions are " + world_words(*world);
        suspect.place_from_captured = *world;
        suspect.depth_scale = std::cbrt(std::abs(glm::determinant(*world)));
      }
    samples_ = choose_samples(input(), in.frame);
  }

  Expected<Aligned> run_geometry() {
    if (const auto geometry = check_geometry(); !geometry) return fail(geometry.error());
    return out_;
  }
  Expected<Aligned> run_shadows() {
    if (!in_.shadows_believed)
      if (const auto shadows = check_shadows(); !shadows) return fail(shadows.error());
    if (const auto encoding = check_encoding(); !encoding) return fail(encoding.error());
    note_range();
    note_resolution();
    judged_.agreement = gather(input(), samples_, {}).all();
    return out_;
  }

 private:
  EvidenceInput input() const { return {in_.tracer, in_.light, pictures_, sight_, map_}; }
  /// Of a ratio that holds other light, in which nothing is black.
  bool by_edges() const { return !samples_.neighbours.empty(); }
  Evidence shadow_evidence();
  Expected<void> check_geometry();
  Expected<void> check_shadows();
  Expected<void> check_encoding();
  void note_range();
  void note_resolution();
  Expected<void> accept(const Mended& mended);
  Expected<void> mend(const Mended& mended, const Suspect& suspect);
  Expected<void> mend_shadows(const Found& found, double before, bool alone);
  Expected<void> doubt_shadows(double share, bool alone);
  Expected<void> doubt_edges(double share);

  const AlignInput& in_;
  Scene& scene_;
  Sight& sight_;
  CapturedPictures& pictures_;
  Judged& judged_;
  const LightView* map_;
  std::vector<Suspect> suspects_;
  Samples samples_;
  Aligned out_;
};

Expected<void> Aligner::accept(const Mended& mended) {
  return accept_mended(in_.capture, in_.fix, mended, judged_);
}

Expected<void> Aligner::mend(const Mended& mended, const Suspect& suspect) {
  if (const auto accepted = accept(mended); !accepted) return accepted;
  undo(suspect, pictures_, sight_);
  out_.pictures_differ = true;
  out_.place_from_captured = suspect.place_from_captured;
  if (suspect.light_turned) {
    Light& light = scene_.lights[in_.light];
    light.direction = -light.direction;
    out_.trace_again = true;
  }
  if (suspect.shift != Vec2(0.0)) out_.everywhere = true;
  if (!suspect.view) return {};
  if (const auto camera = camera_of(scene_.camera, *suspect.view)) {
    scene_.camera = *camera;
    out_.trace_again = true;
  } else {
    out_.everywhere = true;
  }
  return {};
}

Expected<void> Aligner::check_geometry() {
  const auto now = gather(input(), samples_, {}).geometry();
  if (now) judged_.agreement = {*now};
  const double least = by_edges() ? least_edges : least_geometry;
  if (!now || now->share >= least) return {};
  const auto best = best_suspect(input(), samples_, suspects_, true, false);
  const bool likely = best && best->share >= least && mends(now->share, best->share);
  if (likely && (by_edges() || !at_chance(best->shadows)))
    return mend({best->suspect.what, now->what, now->share, best->share}, best->suspect);
  if (by_edges()) return doubt_edges(now->share);
  return capture_error(
      in_.capture, "",
      fmt::format(
          "the picture does not show this scene as Gnomon sees it: {} of the {} agree, and no usual "
          "difference of conventions mends that (nearest: {}, {}{}){}",
          hundredths_of_percent(now->share), now->what, best ? best->suspect.what : "none",
          best ? hundredths_of_percent(best->share) : "-",
          likely ? fmt::format("; its shadows agree by chance, {}", hundredths_of_percent(*best->shadows))
                 : "",
          judged_.of_ratio ? "; the two pictures of a ratio show this light alone, without ambient light"
                           : ""));
}

/// Silhouettes that are no edges of the picture, and no suspect that mends it: colours that are alike, fog, or another view.
Expected<void> Aligner::doubt_edges(double share) {
  const std::string words = fmt::format("{} of the scene's silhouettes are edges of the unshadowed picture",
                                        hundredths_of_percent(share));
  if (share < no_edges)
    return capture_error(in_.capture, "",
                         fmt::format("only {}, and no usual difference of conventions mends that: is it this "
                                     "scene, seen from this camera?",
                                     words));
  judged_.notes.push_back(
      fmt::format("{}: the others have the colour of what lies behind them, or the view is a "
                  "little off",
                  words));
  return {};
}

/// Where the light, turned, lights nothing, the picture is as dark as any picture without light. One that is lit in
/// places is no such picture, and judged as it is.
Expected<void> Aligner::mend_shadows(const Found& found, double before, bool alone) {
  const Mended mended{found.suspect.what, "shadows", before, found.share};
  if (found.lit >= few_samples) return mend(mended, found.suspect);
  if (found.share < good_shadows) return doubt_shadows(before, alone);
  return capture_error(
      in_.capture, "",
      fmt::format(
          "{}: {} of the shadows agree, with that undone {}; but then the light reaches nothing that the "
          "picture shows, and nothing is left to judge",
          mended.what, hundredths_of_percent(mended.before), hundredths_of_percent(mended.after)));
}

/// Shadows that agree badly, and no suspect that mends it: bad shadows, or those of something else.
Expected<void> Aligner::doubt_shadows(double share, bool alone) {
  if (share >= no_shadows) {
    if (alone)
      judged_.notes.push_back(fmt::format(
          "{} of the shadows agree with the truth; whether the rest are wrong or the picture is some "
          "pixels off, shadows alone cannot tell (positions or depths in the capture can)",
          hundredths_of_percent(share)));
    return {};
  }
  const std::string words = fmt::format(
      "the shadows agree with the truth no better than chance would ({}), and no usual difference "
      "of conventions mends that",
      hundredths_of_percent(share));
  if (alone) return capture_error(in_.capture, "", words + ": is it this scene, camera and light?");
  out_.doubt = words;
  return {};
}

/// Within the map, where there is one and enough is seen of it.
Evidence Aligner::shadow_evidence() {
  const Evidence within = gather(input(), samples_, {});
  if (map_ == nullptr || (within.lit >= few_samples && within.shadowed >= few_samples)) return within;
  map_ = nullptr;
  return gather(input(), samples_, {});
}

Expected<void> Aligner::check_shadows() {
  const Evidence now = shadow_evidence();
  if (!now.visibility || now.lit < few_samples || now.shadowed < few_samples) return {};
  if (*now.visibility >= good_shadows) return {};
  const bool alone = !now.geometry();
  const auto best = best_suspect(input(), samples_, suspects_, false, alone);
  const bool likely = best && best->share > no_shadows + least_gain &&
                      mends(*now.visibility, best->share, alone ? most_left_alone : most_left);
  // A mistake in the test speaks against no convention, but that one which is the same as a swapped comparison.
  const bool is_inverted = likely && best->suspect.inverted;
  if (!is_inverted && in_.drawn_by_mistake && in_.drawn_by_mistake()) return {};
  if (likely) return mend_shadows(*best, *now.visibility, alone);
  return doubt_shadows(*now.visibility, alone);
}

Expected<void> Aligner::check_encoding() {
  if (out_.trace_again || out_.everywhere) return {};  // the frame is not of this sight
  const auto found = find_encoding(pictures_, in_.frame);
  if (!found) return {};
  if (const auto accepted = accept(found->mended); !accepted) return accepted;
  for (float& v : pictures_.visibility.data) v = found->decode(v);
  out_.pictures_differ = true;
  return {};
}

/// Light of something else in the picture, or a shadow that is drawn lighter than it is, counts as error.
void Aligner::note_range() {
  if (has_size(scene_.lights[in_.light])) return;  // penumbrae may be all that is seen
  const Evidence found = gather(input(), samples_, {});
  constexpr float seen = 0.02f;  // five steps of eight bits
  if (found.shadowed >= few_samples && found.darkest > seen && found.darkest < 1.0f - seen)
    judged_.notes.push_back(
        fmt::format("the picture is nowhere darker than {:.3g}, where full shadow is 0: other light "
                    "in it, or a shadow's strength, counts as error",
                    found.darkest));
  if (found.lit >= few_samples && found.lightest < 1.0f - seen && found.lightest > seen)
    judged_.notes.push_back(fmt::format(
        "the picture is nowhere lighter than {:.3g}, where full light is 1: what is missing counts as error",
        found.lightest));
}

/// Its edges are coarser than the picture's pixels, which no setting of the shadow map mends.
void Aligner::note_resolution() {
  if (out_.trace_again || out_.everywhere) return;  // the frame is not of this sight
  const int block = shadow_block(pictures_, in_.frame);
  if (block == 1) return;
  judged_.notes.push_back(
      fmt::format("the shadow consists of blocks of {0} x {0} pixels, as if drawn at 1/{0} of the picture's "
                  "resolution and enlarged: edges are wrong by up to {1} for that reason alone",
                  block, compare::counted(static_cast<std::uint64_t>(block - 1), "pixel")));
}

}  // namespace

Expected<void> check_order(const Capture& capture, bool orthographic, bool fix, CapturedPictures& pictures,
                           Judged& judged) {
  const auto brighter = static_cast<double>(pictures.brighter), darker = static_cast<double>(pictures.darker);
  if (pictures.brighter < least_brighter) return {};
  if (brighter < times_darker * darker) {
    judged.notes.push_back(
        fmt::format("\"shadowed\" is clearly brighter than \"unshadowed\" in {} pixels, which count as lit: "
                    "other light, or another exposure, in one of the two",
                    pictures.brighter));
    return {};
  }
  const Mended mended{"\"shadowed\" and \"unshadowed\" are exchanged, or of different light",
                      "pixels in which they differ", darker / (brighter + darker),
                      brighter / (brighter + darker)};
  if (const auto accepted = accept_mended(capture, fix, mended, judged); !accepted) return accepted;
  Capture other = capture;
  std::swap(other.shadowed, other.unshadowed);
  auto read = read_pictures(other, orthographic);
  if (!read) return fail(read.error());
  pictures = std::move(*read);
  return {};
}

Expected<Aligned> align_geometry(const AlignInput& in, Scene& scene, Sight& sight, CapturedPictures& pictures,
                                 Judged& judged) {
  const TimedStage stage("alignment");
  return Aligner(in, scene, sight, pictures, judged).run_geometry();
}

Expected<Aligned> align_shadows(const AlignInput& in, Scene& scene, Sight& sight, CapturedPictures& pictures,
                                Judged& judged) {
  const TimedStage stage("alignment");
  return Aligner(in, scene, sight, pictures, judged).run_shadows();
}

Expected<Mat3> align_map(const AlignInput& in, const Error& error, const Light& light, Judged& judged) {
  for (const Mat3& world : usual_worlds()) {
    if (!check_map_matrices(in_world_of_scene(in.capture, world), light, in.tracer.world())) continue;
    const Mended mended{"the map's world is " + world_words(world), "map's rays", 0.0, 1.0};
    if (const auto accepted = accept_mended(in.capture, in.fix, mended, judged); !accepted)
      return fail(accepted.error());
    return world;
  }
  return fail(error);
}

}  // namespace gnomon::judge
