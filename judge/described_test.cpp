#include "judge/described_test.h"

#include <fmt/core.h>

#include <algorithm>

#include "compare/ladder/biased_test.h"
#include "compare/metrics/pixel_list.h"
#include "compare/result/number_text.h"
#include "judge/identify.h"
#include "judge/outside_map.h"
#include "scene/base/parallel.h"
#include "scene/base/stages.h"

namespace gnomon::judge {
namespace {

using compare::BiasedLookup;
using compare::grouped;
using compare::Label;

using raytrace::SurfacePoint;

/// Pixels whose drawing the description does not explain, of which nothing is said: a share, and a number.
constexpr double few_share = 1e-3;
constexpr std::size_t few_pixels = 10;

class Checker {
  using Reads = CapturedTest::Reads;

 public:
  Checker(const FrameInput& in, const raster::RasterFrame& drawn)
      : in_(in),
        map_(drawn.options.map),
        record_(drawn.lights.front()),
        light_(in.world.scene->lights[record_.light]),
        slack_(record_.rounding_world + lookup_rounding_stored * captured_test(record_).unit_world),
        reads_(captured_test(record_).reads()) {
    using raster::Technique;
    const bool compares = map_.technique == Technique::pcf || map_.technique == Technique::pcss ||
                          is_hard() || reads_ != Reads::texel;
    // Far from the origin a receiver's floats lie that far apart, in whatever a renderer works out of them.
    place_ = lookup_rounding_texels + record_.rounding.float_world / record_.texel_world;
    // A tap that reads between texels lies one texel nearer than the farthest of the four.
    const double taps = std::max(0.0, map_.filter.radius_texels - (reads_ == Reads::between ? 1.0 : 0.0));
    reach_ = compares ? place_ + (is_hard() ? 0.0 : taps) : infinity;
  }

  bool may_draw(std::size_t pixel, float visibility, bool any_cascade) const;
  /// Whether it may leave a pixel neither lit nor dark: one comparison cannot, nor a `pcf` filter whose texels, and one more to
  /// each side, all agree.
  bool may_draw_partly_lit(std::size_t pixel) const;
  /// What a filter's average of comparisons makes of a pixel; none beyond the map's border. `weights`: scratch.
  std::optional<double> filtered_light(std::size_t pixel, const FilterKernel& kernel,
                                       std::vector<double>& weights) const;

 private:
  bool is_hard() const { return map_.technique == raster::Technique::hard; }
  std::optional<BiasedLookup> lookup_of(std::size_t pixel) const {
    const SurfacePoint& receiver = in_.traced.receiver.data[pixel];
    return compare::biased_lookup(record_, map_.bias, light_at(light_, receiver.position).to_light, receiver,
                                  pixel);
  }
  /// Whether the test draws it where the lookup reads this depth.
  bool draws(const BiasedLookup& lookup, const Vec3& normal, const std::optional<double>& depth,
             bool lit) const {
    const double gap = depth ? compare::gap_before(record_, map_.bias, normal, lookup, *depth) : -infinity;
    const double over = gap - record_.bias_constant_world;
    return lit ? over <= slack_ : over > -slack_;
  }
  bool read_between_draws(const BiasedLookup& lookup, const Vec3& normal, bool lit, double reach) const;
  bool some_texel_draws(const BiasedLookup& lookup, const Vec3& normal, bool lit, double reach) const;
  bool is_mixed(std::size_t pixel) const;

  const FrameInput& in_;
  const raster::MapOptions& map_;
  const raster::LightRecord& record_;
  const Light& light_;
  double slack_;  // world units
  Reads reads_;
  double place_ = 0.0, reach_ = 0.0;  // texels
};

/// Whether what is read between texels draws it, at the place or within `reach` of it.
bool Checker::read_between_draws(const BiasedLookup& lookup, const Vec3& normal, bool lit,
                                 double reach) const {
  constexpr double steps_in_texel = 2.0;
  const int steps = std::max(1, static_cast<int>(std::ceil(steps_in_texel * reach)));
  for (int j = -steps; j <= steps; ++j)
    for (int i = -steps; i <= steps; ++i) {
      BiasedLookup there = lookup;
      there.at.u += reach * i / steps, there.at.v += reach * j / steps;
      if (draws(lookup, normal, compare::compared_caster(record_, there), lit)) return true;
    }
  return false;
}

/// What lies beyond the map's border is the renderer's own choice.
bool Checker::some_texel_draws(const BiasedLookup& lookup, const Vec3& normal, bool lit, double reach) const {
  if (reads_ == Reads::elsewhere) {
    const auto depths = captured_test(record_).casters_within(record_, lookup, reach);
    return std::any_of(depths.begin(), depths.end(),
                       [&](const auto& depth) { return draws(lookup, normal, depth, lit); });
  }
  if (reads_ != Reads::texel)
    return read_between_draws(lookup, normal, lit, reads_ == Reads::between ? reach : place_);
  const auto texel = [](double place) { return static_cast<int>(std::floor(place)); };
  const int left = texel(lookup.at.u - reach), right = texel(lookup.at.u + reach);
  const int low = texel(lookup.at.v - reach), high = texel(lookup.at.v + reach);
  const int last = record_.map.view.size - 1;
  if (left < 0 || low < 0 || right > last || high > last) return true;
  for (int row = low; row <= high; ++row)
    for (int column = left; column <= right; ++column) {
      BiasedLookup there = lookup;
      there.key = raytrace::TexelKey::pack(lookup.at.face, column, row);
      if (draws(there, normal, compare::stored_caster(record_, there.key), lit)) return true;
    }
  return false;
}

bool Checker::may_draw(std::size_t pixel, float visibility, bool any_cascade) const {
  if (std::isinf(reach_)) return true;
  if (!captured_test(record_).looks_up(pixel)) return visibility > 0.5f;
  auto lookup = lookup_of(pixel);
  if (!lookup) return true;
  const Vec3& normal = in_.traced.receiver.data[pixel].normal;
  const bool lit = visibility > 0.5f;
  if (some_texel_draws(*lookup, normal, lit, reach_)) return true;
  const LightView& view = record_.map.view;
  const bool by_place = captured_test(record_).face_of(pixel) == CapturedTest::any_face;
  if (!any_cascade || !by_place || view.projection != LightProjection::orthographic) return false;
  for (int face = 0; face < view.face_count; ++face) {
    lookup->at = project_to_face(view, face, lookup->position);
    if (lookup->at.inside && some_texel_draws(*lookup, normal, lit, reach_)) return true;
  }
  return false;
}

/// Whether two layers are mixed there, or the shadow fades.
bool Checker::is_mixed(std::size_t pixel) const {
  const View view = make_view(in_.camera, in_.capture.size);
  const auto lies_within = [&](bool by_distance, double from, double to) {
    const double at = from_camera(view, by_distance, in_.traced.receiver.data[pixel].position);
    return at >= from && at <= to;
  };
  const auto& fade = in_.capture.fade;
  if (fade && lies_within(fade->by_distance, fade->from, fade->to)) return true;
  const std::vector<CapturedSelect> select = captured_selects(in_.capture);
  return std::any_of(select.begin(), select.end(), [&](const CapturedSelect& one) {
    return one.blend > 0.0 && lies_within(one.by_distance, one.far - one.blend, one.far);
  });
}

bool Checker::may_draw_partly_lit(std::size_t pixel) const {
  const bool averages = map_.technique == raster::Technique::pcf;
  if (!(averages || is_hard()) || is_mixed(pixel)) return true;
  if (!captured_test(record_).looks_up(pixel)) return false;
  const auto lookup = record_.outside_map.data[pixel] != 0 ? std::nullopt : lookup_of(pixel);
  if (!lookup) return true;
  const Vec3& normal = in_.traced.receiver.data[pixel].normal;
  return averages && some_texel_draws(*lookup, normal, true, reach_ + 1.0) &&
         some_texel_draws(*lookup, normal, false, reach_ + 1.0);
}

std::optional<double> Checker::filtered_light(std::size_t pixel, const FilterKernel& kernel,
                                              std::vector<double>& weights) const {
  const auto lookup = lookup_of(pixel);
  if (!lookup || reads_ == Reads::elsewhere) return std::nullopt;
  const int column = lookup->at.column(), row = lookup->at.row(), reach = kernel.reach(),
            last = record_.map.view.size - 1;
  if (std::min(column, row) < reach || std::max(column, row) + reach > last) return std::nullopt;
  kernel.weigh(Vec2(lookup->at.u - column, lookup->at.v - row), weights);
  const Vec3& normal = in_.traced.receiver.data[pixel].normal;
  BiasedLookup there = *lookup;
  double light = 0.0;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    if (weights[k] == 0.0) continue;
    const int i = static_cast<int>(k) % kernel.width() - reach,
              j = static_cast<int>(k) / kernel.width() - reach;
    there.key = raytrace::TexelKey::pack(lookup->at.face, column + i, row + j);
    const auto depth = compare::stored_caster(record_, there.key);
    const double gap = depth ? compare::gap_before(record_, map_.bias, normal, there, *depth) : -infinity;
    if (gap <= record_.bias_constant_world) light += weights[k];
  }
  return light;
}

/// Neither lit nor dark, by more than five steps of eight bits.
bool is_between(float light) {
  constexpr float one_value = 0.02f;
  return light > one_value && light < 1.0f - one_value;
}

bool keeps_label(Label label) {
  return label == Label::outside_map || label == Label::light_size;
}

/// The filter that comes nearest to what was drawn of these pixels, where one comes near.
void find_filter(const Checker& checker, const compare::LightComparison& light,
                 const std::vector<std::uint32_t>& not_drawn, DescribedTest& out) {
  constexpr double near_enough = 0.15;  // a mean difference; kernels differ in their weights
  constexpr std::size_t most_asked = 1000;
  const auto is_grey = [&](std::uint32_t i) { return is_between(light.rungs[6].data[i]); };
  const auto greys = std::count_if(not_drawn.begin(), not_drawn.end(), is_grey);
  if (static_cast<std::size_t>(greys) < few_pixels) return;
  std::vector<FilterKernel> kernels;
  for (const double radius : {1.0, 2.5, 6.0})
    for (const FilterKernel& kernel : kernels_of_reach(radius))
      if (kernel.shape != FilterKernel::Shape::taps || kernel.side > 1) kernels.push_back(kernel);
  const std::size_t step = not_drawn.size() / most_asked + 1, asked = (not_drawn.size() - 1) / step + 1;
  std::vector<double> errors(kernels.size(), infinity);
  parallel_for(kernels.size(), [&](std::size_t k) {
    std::vector<double> weights;
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < not_drawn.size(); i += step)
      if (const auto mean = checker.filtered_light(not_drawn[i], kernels[k], weights))
        sum += std::abs(*mean - double{light.rungs[6].data[not_drawn[i]]}), ++count;
    if (2 * count > asked) errors[k] = sum / double(count);
  });
  const auto best = std::min_element(errors.begin(), errors.end());
  if (!(*best < near_enough)) return;
  out.filter = kernels[static_cast<std::size_t>(best - errors.begin())], out.filter_error = *best;
}

/// The keys that say a filter, and what it is.
std::string filter_words(const FilterKernel& filter, bool is_known) {
  using Shape = FilterKernel::Shape;
  const bool taps = filter.shape == Shape::taps || filter.shape == Shape::linear_taps;
  if (!is_known || !taps || filter.spacing != 1.0)
    return fmt::format(
        "an average over {} to each side would draw them (`filter.kind`, `filter.radius_texels`)",
        compare::with_noun(fmt::format("{:g}", filter.half_width()), "texel"));
  return fmt::format("{0} x {0} comparisons{1} draw them (`filter.kind` pcf, `filter.radius_texels` {2:g})",
                     filter.side, filter.shape == Shape::linear_taps ? ", each of four texels," : "",
                     filter.half_width());
}

}  // namespace

bool DescribedTest::is_drawn() const {
  return not_drawn < few_pixels || static_cast<double>(not_drawn) < few_share * static_cast<double>(compared);
}

bool DescribedTest::filter_is_known() const {
  constexpr double known = 0.01;
  return filter && filter_error < known;
}

bool DescribedTest::is_mostly_drawn() const {
  constexpr double some = 0.05;
  return static_cast<double>(not_drawn) < some * static_cast<double>(compared);
}

DescribedTest check_described_test(const FrameInput& in, const raster::RasterFrame& drawn,
                                   compare::LightComparison& light) {
  const TimedStage stage("described test");
  const Checker checker(in, drawn);
  const auto differs = [&](std::size_t i) {
    return compare::is_compared(light.labels.data[i]) &&
           std::abs(light.rungs[5].data[i] - light.rungs[6].data[i]) > 0.5f;
  };
  const auto is_partly_lit = [&](std::size_t i) {
    return compare::is_compared(light.labels.data[i]) && is_between(light.rungs[6].data[i]) &&
           !checker.may_draw_partly_lit(i);
  };
  const std::size_t pixels = light.labels.data.size();
  DescribedTest out;
  out.compared = compare::pixels_where(pixels, [&](std::size_t i) {
                   return compare::is_compared(light.labels.data[i]);
                 }).size();
  const auto not_drawn = compare::pixels_where(pixels, [&](std::size_t i) {
    const bool may =
        is_partly_lit(i) ? false : !differs(i) || checker.may_draw(i, light.rungs[6].data[i], true);
    return !may && !lies_behind_far_plane(drawn.lights.front(), in.traced.receiver.data[i].position, i);
  });
  out.not_drawn = not_drawn.size();
  if (!out.is_drawn()) find_filter(checker, light, not_drawn, out);
  for (const std::uint32_t i : not_drawn)
    out.drawn_darker += light.rungs[6].data[i] < light.rungs[5].data[i] ? 1 : 0;
  // Where the test is another, it is chance that some texel nearby agrees with the picture.
  const bool is_drawn = out.is_drawn();
  const auto unexplained = compare::pixels_where(pixels, [&](std::size_t i) {
    const Label label = light.labels.data[i];
    if (!compare::has_cause(label) || keeps_label(label)) return false;
    return is_partly_lit(i) ||
           (differs(i) && (!is_drawn || !checker.may_draw(i, light.rungs[6].data[i], false)));
  });
  if (is_drawn)
    for (const std::uint32_t i : unexplained)
      out.by_another_layer += !is_partly_lit(i) && checker.may_draw(i, light.rungs[6].data[i], true) ? 1 : 0;
  if (!unexplained.empty()) mark_unexplained(unexplained, light);
  return out;
}

std::vector<std::string> far_places_notes(const FrameInput& in, const raster::LightRecord& record) {
  constexpr double coarse_texels = 0.1;
  double farthest = 0.0;
  for (const SurfacePoint& point : in.traced.receiver.data)
    if (point.primitive != no_id)
      for (int axis = 0; axis < 3; ++axis) farthest = std::max(farthest, std::abs(point.position[axis]));
  const double spacing = farthest > 0.0 ? std::ldexp(1.0, std::ilogb(farthest) - 23) : 0.0;
  if (spacing < coarse_texels * record.texel_world) return {};
  return {
      fmt::format("places of 32 bits lie {} apart so far from the origin ({:.3g}), {} of the map: move the "
                  "origin nearer, or "
                  "work with places relative to the camera",
                  compare::with_noun(fmt::format("{:.2g}", spacing), "world unit"), farthest,
                  compare::texels_text(spacing / record.texel_world))};
}

std::vector<std::string> described_test_notes(const DescribedTest& test,
                                              const std::optional<OtherTest>& other) {
  std::vector<std::string> out;
  if (test.is_drawn() && test.by_another_layer >= few_pixels)
    out.push_back(fmt::format(
        "{} wrong pixels are drawn as another layer has them than the first that holds their place: "
        "`map[].select` of gnomon/capture/2 says by which distances layers are chosen",
        grouped(test.by_another_layer)));
  if (!test.is_drawn()) {
    std::string note = fmt::format(
        "the test as described (map, matrix, bias, filter) is not the one that was drawn in {} of {} "
        "compared pixels ({} of them darker, {} lighter): the wrong ones among them are unexplained, and {}",
        grouped(test.not_drawn), grouped(test.compared), grouped(test.drawn_darker),
        grouped(test.not_drawn - test.drawn_darker),
        !advice_holds(test, other) ? "no bias is advised"
        : other                    ? "advice starts from the bias as described"
                                   : "advice leaves them as they were drawn");
    if (other)
      note += fmt::format("; if {}, it is the one drawn in {} of the pixels", other->what,
                          compare::percent(other->share));
    else if (test.filter)
      note += "; " + filter_words(*test.filter, test.filter_is_known());
    else if (test.is_mostly_drawn() && 20 * test.drawn_darker > 19 * test.not_drawn)
      note += "; what else takes light away (contact shadows, a cookie) is said by `also`";
    out.push_back(std::move(note));
  }
  return out;
}

}  // namespace gnomon::judge
