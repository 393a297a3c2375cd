#include "judge/moments_test.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "compare/ladder/biased_test.h"
#include "judge/capture_pictures.h"
#include "judge/test_suspects.h"

namespace gnomon::judge {
namespace {

using raster::Technique;

Averages averages_of(const MomentsTest::Texel& texel) {
  return {texel[0], texel[1], texel[2], texel[3]};
}

/// The numbers of a face's near and far depths on a texel's ray.
Interval ends_of(const MomentsTest& test, const LightView& view, TexelKey key) {
  if (test.stores == Stores::depths) return {0.0, 1.0};
  const Vec2& range = test.range;
  const double per_depth =
      test.stores == Stores::distances ? 1.0 / compare::depth_of_distance(view, key, 1.0) : 1.0;
  const auto number = [&](double depth) { return (depth * per_depth - range.x) / (range.y - range.x); };
  return {number(view.face(key.face()).near_depth), number(view.face(key.face()).far_depth)};
}

/// The exponent of a warp whose numbers end at e to the power of it, which are those of nothing drawn.
double exponent_of(const MomentsTest& test, std::size_t channel) {
  double largest = 0.0;
  for (const auto& texel : test.texels) largest = std::max(largest, std::abs(double{texel[channel]}));
  return std::log(largest);
}

void add_exponents(const MomentsTest& test, std::vector<TestSuspect>& out) {
  const bool esm = test.formula.technique == Technique::esm, evsm = test.formula.technique == Technique::evsm;
  if (!esm && !evsm) return;
  const double positive = exponent_of(test, 0), negative = test.formula.filter.evsm_negative_exponent;
  if (!(positive > 0.0)) return;
  // The negative warp's largest number is that of the near end, where nothing need be.
  const std::string what =
      evsm && negative > 0.0 ? fmt::format("`filter.exponents` are about [{:.3g}, {:g}]", positive, negative)
                             : fmt::format("`filter.exponents` are about [{:.3g}]", positive);
  out.push_back({what, "", [positive](raster::LightRecord& record) {
                   raster::FilterOptions& filter = changed_test<MomentsTest>(record).formula.filter;
                   return filter.esm_exponent = filter.evsm_positive_exponent = positive, true;
                 }});
}

}  // namespace

std::shared_ptr<CapturedTest> make_moments_test(const Capture& capture) {
  return std::make_shared<MomentsTest>(capture);
}

Expected<void> check_moments(const Capture& capture) {
  const FilterName kind = capture.filter->kind;
  if ((kind == FilterName::esm || kind == FilterName::evsm) && capture.filter->exponents.empty())
    return capture_error(capture, "filter.exponents", "is missing");
  const CapturedLayer& layer = capture.map.front();
  if (convention_of(*layer.convention).reversed || (layer.range && layer.range->x > layer.range->y))
    return capture_error(
        capture, "map[0].convention",
        "is not read of moments whose numbers fall with the distance; zero_to_one, minus_one_to_one, "
        "distance and linear_z are, the last two with a `range` that rises");
  return {};
}

MomentsTest::MomentsTest(const Capture& capture) {
  const CapturedFilter& filter = *capture.filter;
  formula.technique = technique_of(filter.kind);
  const double across = 2.0 * filter.radius_texels;  // a kernel's middle has the most of it
  formula.own_share = 1.0 / std::max(1.0, across * across);
  formula.filter.light_bleeding_reduction = filter.light_bleeding_reduction;
  formula.filter.moment_bias = filter.moment_bias, formula.minimum_variance = filter.minimum_variance;
  if (!filter.exponents.empty())
    formula.filter.esm_exponent = formula.filter.evsm_positive_exponent = filter.exponents.front();
  formula.filter.evsm_negative_exponent = filter.exponents.size() > 1 ? filter.exponents[1] : 0.0;
}

std::size_t MomentsTest::channels() const {
  if (formula.technique == Technique::esm) return 1;
  const bool both_warps = formula.technique == Technique::evsm && formula.filter.evsm_negative_exponent > 0.0;
  return formula.technique == Technique::msm || both_warps ? 4 : 2;
}

Averages MomentsTest::between(const raster::LightRecord& record, const TexelCoordinate& at) const {
  Averages read{};
  for (const WeighedTexel& near : texels_between(record, *this, at))
    for (std::size_t k = 0; k < read.size(); ++k) read[k] += near.weight * texels[near.index][k];
  return read;
}

std::optional<double> MomentsTest::caster(const raster::LightRecord& record,
                                          const raster::MapLookup& lookup) const {
  constexpr int halvings = 48;
  const Averages read = between(record, lookup.at);
  Interval numbers = ends_of(*this, record.map.view, lookup.key);
  const auto has_half = [&](double x) { return formula.light(read, x) >= 0.5; };
  if (has_half(numbers.max)) return std::nullopt;
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (numbers.min + numbers.max);
    (has_half(middle) ? numbers.min : numbers.max) = middle;
  }
  return depth_of(record.map.view, lookup.key, numbers.min);
}

Expected<LayerNumbers> MomentsTest::read_layer(const Capture& capture, std::size_t layer) const {
  static constexpr std::array<std::string_view, 4> all{"R", "G", "B", "A"};
  const auto picture = gnomon::judge::read_layer(capture, layer);
  if (!picture) return fail(picture.error());
  const auto wrong = [&](std::string reason) {
    return capture_error(capture, fmt::format("map[{}].depth", layer), std::move(reason));
  };
  const auto names = std::span(all).first(channels());
  LayerNumbers out{picture->size, {}, {}};
  out.averages.resize(out.size.pixels());
  for (std::size_t k = 0; k < names.size(); ++k) {
    const Channel* channel = picture->find(std::string(names[k]));
    if (channel == nullptr) return wrong(fmt::format("needs channels {}", fmt::join(names, ", ")));
    if (!std::all_of(channel->values.begin(), channel->values.end(),
                     [](float v) { return std::isfinite(v); }))
      return wrong(fmt::format("has texels in channel {} that are not finite numbers", names[k]));
    for (std::size_t i = 0; i < out.averages.size(); ++i) out.averages[i][k] = channel->values[i];
  }
  // Some store both warps before their squares; a square is never below 0, and the negative warp always is.
  if (names.size() == 4 && formula.technique == Technique::evsm && !out.averages.empty() &&
      out.averages.front()[1] < 0.0f)
    for (auto& texel : out.averages) std::swap(texel[1], texel[2]);
  for (const Texel& texel : out.averages) {
    const double mean = formula.mean(averages_of(texel));
    // An average of nothing drawn is off the far end's number by its rounding.
    const bool close = std::abs(mean - 1.0) < 0x1p-18, below = mean < 0.0 && mean > -0x1p-18;
    out.values.push_back(close ? 1.0f : below ? 0.0f : static_cast<float>(mean));
  }
  return out;
}

void MomentsTest::take(const LayerNumbers& numbers, std::size_t place, std::size_t index, std::size_t count) {
  texels.resize(count);
  texels[index] = numbers.averages[place];
}

void MomentsTest::describe(raster::MapOptions& map, raster::ForeignPicture& picture) const {
  const raster::FilterOptions& said = formula.filter;
  map.filter.light_bleeding_reduction = said.light_bleeding_reduction;
  map.filter.esm_exponent = said.esm_exponent, map.filter.moment_bias = said.moment_bias;
  map.filter.evsm_positive_exponent = said.evsm_positive_exponent;
  map.filter.evsm_negative_exponent = said.evsm_negative_exponent;
  picture.stores = "moments";
  picture.said.insert(picture.said.end(),
                      {"bleeding-reduction", "esm-exponent", "evsm-exponent", "moment-bias"});
  if (said.evsm_negative_exponent > 0.0) picture.said.emplace_back("evsm-negative-exponent");
  if (formula.minimum_variance > 0.0)
    picture.numbers.push_back({"minimum_variance", "minimum variance", formula.minimum_variance});
}

void MomentsTest::reorder(std::size_t first, std::span<const std::size_t> from) {
  const std::vector<Texel> own = texels;
  for (std::size_t i = 0; i < from.size(); ++i) texels[first + i] = own[from[i]];
}

Interval MomentsTest::averaged_depths(const raster::LightRecord& record, TexelKey key) const {
  const LightView& view = record.map.view;
  const std::size_t index = record.map.texel_index(key.face(), key.column(), key.row());
  const Interval numbers = formula.own_numbers(averages_of(texels[index])), ends = ends_of(*this, view, key);
  const auto depth = [&](double x) { return depth_of(view, key, std::clamp(x, ends.min, ends.max)); };
  return {depth(numbers.min), depth(numbers.max)};
}

AveragesRead MomentsTest::read_averages(const raster::LightRecord& record, const raster::MapLookup& lookup,
                                        double slope_world) const {
  const TexelCoordinate& at = lookup.at;
  AveragesRead out{between(record, at), 0.0, lookup.cosine};
  const double depth = at.depth - slope_world * at.depth / at.distance;
  if (stores == Stores::depths) {
    out.x = stored_from_depth(record.map.view, lookup.key.face(), lookup.key.row() + 0.5, depth);
    return out;
  }
  const double world = stores == Stores::distances ? at.distance - slope_world : depth;
  out.x = (world - range.x) / (range.y - range.x);
  return out;
}

void MomentsTest::add_suspects(std::vector<TestSuspect>& suspects) const {
  add_exponents(*this, suspects);
  constexpr int steps = 20;
  for (int i = 0; i < steps; ++i) {
    const double reduction = double(i) / steps;
    suspects.push_back({fmt::format("`filter.light_bleeding_reduction` is about {:g}", reduction), "",
                        [reduction](raster::LightRecord& record) {
                          changed_test<MomentsTest>(record).formula.filter.light_bleeding_reduction =
                              reduction;
                          return true;
                        }});
  }
  for (const double variance : {0.0, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2})
    suspects.push_back({fmt::format("`filter.minimum_variance` is about {:g}", variance), "",
                        [variance](raster::LightRecord& record) {
                          changed_test<MomentsTest>(record).formula.minimum_variance = variance;
                          return true;
                        }});
}

}  // namespace gnomon::judge
