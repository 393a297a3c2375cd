// The usual mistakes in the description of a shadow test (test_suspects.h), each tried against the picture.
#include <fmt/core.h>

#include <algorithm>

#include "compare/bias/bias_curve.h"
#include "judge/described_test.h"
#include "judge/outside_map.h"
#include "judge/test_suspects.h"
#include "scene/base/parallel.h"
#include "scene/light.h"

namespace gnomon::judge {
namespace {

using compare::Label;
using compare::LightComparison;

/// The test must then be drawn nearly everywhere, on most of the pixels where it was not. Likewise on most of those that are
/// drawn dark, and of those that are drawn lit.
constexpr double least_drawn = 0.98, most_not_drawn = 1.0 / 3.0, least_of_either = 0.7;
/// A picture with fewer dark or lit pixels tells of signs alone, and of a constant that lights all: much else draws it.
constexpr std::size_t few_of_either = 20;

/// The receivers with the normals of their triangles' fronts; none where no back is seen.
std::optional<raytrace::RayTracedFrame> receivers_by_fronts(const FrameInput& in) {
  raytrace::RayTracedFrame turned;
  turned.lights = in.traced.lights, turned.receiver = in.traced.receiver;
  bool any = false;
  for (raytrace::SurfacePoint& point : turned.receiver.data) {
    if (point.primitive == no_id || !in.world.is_triangle(point.primitive)) continue;
    const Vec3 front = outward_normal(in.world, point.primitive, point.position);
    if (glm::dot(front, point.normal) < 0.0) point.normal = -point.normal, any = true;
  }
  if (!any) return std::nullopt;
  return turned;
}

/// What a test makes of the pixels that are asked.
struct Fit {
  std::size_t asked = 0, not_drawn = 0, wrong = 0;
  std::array<std::size_t, 2> of{}, as_drawn{};  ///< pixels that are drawn dark, and lit

  double drawn() const { return 1.0 - double(not_drawn) / double(std::max<std::size_t>(1, asked)); }
  bool has_both() const { return std::min(of[0], of[1]) >= few_of_either; }
};

/// What a test draws of a pixel: nothing is known of what lies beyond the map's border, the renderer's own choice.
enum class Drawn : std::uint8_t { lit, dark, unknown };

Drawn drawn_by(const raster::LightRecord& record, std::size_t i) {
  // What looks nothing up is lit.
  if (!captured_test(record).looks_up(i)) return Drawn::lit;
  if (record.outside_map.data[i] != 0) return Drawn::unknown;
  return double{record.gap.data[i]} > record.bias_constant_world ? Drawn::dark : Drawn::lit;
}

/// What is drawn beyond the border is taken for light, or for shadow where most of it is that. `swapped`: the test lights what
/// it would darken.
Fit fit_of(const raster::LightRecord& record, const LightComparison& light, bool swapped = false) {
  Fit out;
  std::size_t beyond = 0, beyond_dark = 0;
  const auto take = [&](std::size_t i, bool dark) {
    const float test = dark ? 0.0f : 1.0f, drawn = light.rungs[6].data[i];
    const std::size_t kind = drawn > 0.5f ? 1 : 0, same = std::abs(test - drawn) <= 0.5f ? 1 : 0;
    ++out.asked, ++out.of[kind], out.as_drawn[kind] += same, out.not_drawn += 1 - same;
    out.wrong += std::abs(test - light.rungs[0].data[i]) > 0.5f ? 1 : 0;
  };
  for (std::size_t i = 0; i < light.labels.data.size(); ++i) {
    if (!compare::is_compared(light.labels.data[i])) continue;
    const Drawn by = drawn_by(record, i);
    if (by != Drawn::unknown)
      take(i, (by == Drawn::dark) != swapped);
    else
      ++beyond, beyond_dark += light.rungs[6].data[i] < 0.5f ? 1 : 0;
  }
  for (std::size_t i = 0; beyond > 0 && i < light.labels.data.size(); ++i)
    if (compare::is_compared(light.labels.data[i]) && drawn_by(record, i) == Drawn::unknown)
      take(i, 2 * beyond_dark > beyond);
  return out;
}

bool fits(const Fit& fit, const Fit& now) {
  for (std::size_t kind = 0; kind < 2; ++kind)
    if (fit.of[kind] >= few_of_either && double(fit.as_drawn[kind]) < least_of_either * double(fit.of[kind]))
      return false;
  return fit.drawn() >= least_drawn && double(fit.not_drawn) < most_not_drawn * double(now.not_drawn);
}

/// The pixels by which a test is told: labels, truth and picture alone. What is drawn behind the far plane tells nothing of it.
LightComparison asked_pixels(const FrameInput& in, const raster::LightRecord& record, Image<Label> labels,
                             Image<float> truth, Image<float> picture) {
  LightComparison out;
  out.labels = std::move(labels), out.rungs[0] = std::move(truth), out.rungs[6] = std::move(picture);
  for (std::size_t i = 0; i < out.labels.data.size(); ++i)
    if (compare::is_compared(out.labels.data[i]) &&
        lies_behind_far_plane(record, in.traced.receiver.data[i].position, i))
      out.labels.data[i] = Label::background;
  return out;
}

/// Mistakes made one by one and together; the best explanation, of equally good ones the one with the fewest.
class Search {
 public:
  Search(const FrameInput& in, const raster::RasterFrame& drawn, const LightComparison& light)
      : in_(in),
        bias_(drawn.options.map.bias),
        described_(drawn.lights.front()),
        light_(light),
        now_(fit_of(described_, light)) {
    if (captured_test(described_).normal_offset_world > 0.0) by_fronts_ = receivers_by_fronts(in);
  }

  void try_suspects(std::initializer_list<const TestSuspect*> suspects) {
    raster::LightRecord record = described_;
    raster::Bias bias = bias_;
    bool by_fronts = false, swapped = false;
    std::size_t least_evidence = few_pixels;
    for (const TestSuspect* suspect : suspects) {
      if (!suspect->change(record) || (suspect->of_slope != 1.0 && bias_.slope == 0.0)) return;
      bias.slope *= suspect->of_slope;
      by_fronts = by_fronts || suspect->by_fronts, swapped = swapped || suspect->swapped;
      if (suspect->turns_map) least_evidence = few_of_turned;
    }
    // What slopes are along a normal that faces away is not defined.
    if (by_fronts && (!by_fronts_ || bias.slope != 0.0 || bias.receiver_plane)) return;
    const FrameInput turned{in_.capture,   in_.pictures, in_.world,
                            in_.tracer,    in_.camera,   by_fronts ? *by_fronts_ : in_.traced,
                            in_.elsewhere, in_.exposure, in_.facts};
    fill_record(turned, bias, record);
    const Fit fit = fit_of(record, light_, swapped);
    OtherTest found{"", fit.drawn(), suspects.size() == 1, record.bias_constant_world};
    for (const TestSuspect* suspect : suspects) {
      const bool renderer = !suspect->of_renderer.empty() && fit.wrong > now_.wrong;
      found.what +=
          (found.what.empty() ? "" : ", and ") + (renderer ? suspect->of_renderer : suspect->of_capture);
      found.of_constant &= suspect->of_constant && !renderer;
    }
    consider(std::move(found), fit, least_evidence);
  }
  /// Another constant, found as the best bias is: with the picture in the place of the truth.
  void try_constant() {
    raster::LightRecord record = described_;
    record.bias_constant_world =
        compare::find_best_bias(compare::sort_gaps(described_, light_.rungs[6], light_.labels))
            .constant_world;
    const Fit fit = fit_of(record, light_);
    if (fit.of[1] < few_of_either) return;
    const double stored = record.bias_constant_world / captured_test(described_).unit_world;
    // It is the least of those that draw the picture, which may have no end.
    raster::LightRecord larger = record;
    larger.bias_constant_world = infinity;
    const bool or_more = stored > 0.0 && fit_of(larger, light_).not_drawn <= fit.not_drawn;
    consider({fmt::format("`constant_depth` is {}{:.2g}{}", or_more ? "" : "about ", stored,
                          or_more ? " or more" : ""),
              fit.drawn(), true, record.bias_constant_world},
             fit, few_pixels);
  }
  /// What is tried from here on is less usual: it needs evidence, and has to leave half of what the best one leaves.
  void go_on_to_less_usual() { ++rank_; }
  const std::optional<OtherTest>& best() const { return best_; }

 private:
  static constexpr double clearly = 2e-4;  ///< share of the pixels: borders of texels differ by rounding
  /// A map that reads alike both ways is told by hardly any pixel, and then by what is special about these.
  static constexpr std::size_t few_pixels = 10, few_of_turned = 50;

  /// `least_evidence`: pixels that it has to draw beside those of the described test.
  void consider(OtherTest found, const Fit& fit, std::size_t least_evidence) {
    if (!fits(fit, now_)) return;
    if (rank_ > 0 && (!fit.has_both() || fit.not_drawn + least_evidence > now_.not_drawn)) return;
    if (best_ && !(double(fit.not_drawn) + clearly * double(fit.asked) < double(best_left_))) return;
    const bool is_less_usual = best_ && rank_ > best_rank_;
    if (is_less_usual && std::max(fit.not_drawn + few_pixels, 2 * fit.not_drawn) > best_left_) return;
    best_ = std::move(found), best_left_ = fit.not_drawn, best_rank_ = rank_;
  }

  const FrameInput& in_;
  const raster::Bias& bias_;
  const raster::LightRecord& described_;
  const LightComparison& light_;
  Fit now_;
  std::optional<raytrace::RayTracedFrame> by_fronts_;
  std::optional<OtherTest> best_;
  std::size_t best_left_ = 0;
  int rank_ = 0, best_rank_ = 0;
};

/// Mistakes by how usual they are: a sign or a constant, another one, two together.
std::optional<OtherTest> search(const FrameInput& in, const raster::RasterFrame& drawn,
                                const LightComparison& light) {
  Search search(in, drawn, light);
  const std::vector<TestSuspect> suspects = test_suspects(in, drawn.lights.front(), light);
  const auto try_each = [&](bool of_sign) {
    for (const TestSuspect& one : suspects)
      if (one.of_sign == of_sign) search.try_suspects({&one});
  };
  try_each(true);
  search.try_constant();
  search.go_on_to_less_usual();
  try_each(false);
  search.go_on_to_less_usual();
  for (std::size_t i = 0; i < suspects.size(); ++i)
    for (std::size_t k = i + 1; k < suspects.size(); ++k)
      if (suspects[i].with_others && suspects[k].with_others)
        search.try_suspects({&suspects[i], &suspects[k]});
  return search.best();
}

}  // namespace

std::optional<OtherTest> find_drawn_test(const FrameInput& in, const raster::RasterFrame& drawn,
                                         const LightComparison& light) {
  return search(in, drawn,
                asked_pixels(in, drawn.lights.front(), light.labels, light.rungs[0], light.rungs[6]));
}

bool is_drawn_but_for_a_mistake(const FrameInput& in, const raster::RasterFrame& drawn) {
  const raster::LightRecord& record = drawn.lights.front();
  const Light& light = in.world.scene->lights[record.light];
  const ImageSize size = in.capture.size;
  Image<Label> labels(size, Label::background);
  Image<float> truth(size, 0.0f);
  for (std::size_t i = 0; i < labels.data.size(); ++i) {
    const raytrace::SurfacePoint& point = in.traced.receiver.data[i];
    if (point.primitive == no_id || drawn.primitive.data[i] != point.primitive ||
        light_cannot_reach(light, point.position, point.normal))
      continue;
    labels.data[i] = Label::right;
    truth.data[i] =
        in.traced.lights.front().centre.data[i] == raytrace::PointVisibility::shadowed ? 0.0f : 1.0f;
  }
  return search(in, drawn, asked_pixels(in, record, std::move(labels), std::move(truth), record.visibility))
      .has_value();
}

}  // namespace gnomon::judge
