#include "judge/captured_moments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "compare/ladder/moments.h"
#include "judge/capture_pictures.h"

namespace gnomon::compare {
namespace {

std::span<const std::string_view> moment_channels(const CapturedFilter& filter) {
  static constexpr std::array<std::string_view, 4> all{"R", "G", "B", "A"};
  const bool four =
      filter.kind == FilterName::msm || (filter.kind == FilterName::evsm && filter.exponents.size() > 1);
  return std::span(all).first(filter.kind == FilterName::esm ? 1 : four ? 4 : 2);
}

raster::CapturedMoments& moments_in(raster::LightRecord& record) {
  return record.captured->test->moments;
}

/// The exponent of a warp whose numbers end at e to the power of it, which are those of nothing drawn.
double exponent_of(const raster::CapturedMoments& moments, std::size_t channel) {
  double largest = 0.0;
  for (const auto& texel : moments.texels) largest = std::max(largest, std::abs(double{texel[channel]}));
  return std::log(largest);
}

void add_exponents(const raster::CapturedMoments& moments, std::vector<TestSuspect>& out) {
  using raster::Technique;
  const bool esm = moments.technique == Technique::esm, evsm = moments.technique == Technique::evsm;
  if (!esm && !evsm) return;
  const double positive = exponent_of(moments, 0);
  if (!(positive > 0.0)) return;
  const bool two = evsm && moments.filter.evsm_negative_exponent > 0.0;
  // The negative warp's largest number is that of the near end, where nothing need be.
  const std::string what = two ? fmt::format("`filter.exponents` are about [{:.3g}, {:g}]", positive,
                                             moments.filter.evsm_negative_exponent)
                               : fmt::format("`filter.exponents` are about [{:.3g}]", positive);
  out.push_back({what, "", [positive](raster::LightRecord& record) {
                   raster::FilterOptions& filter = moments_in(record).filter;
                   return filter.esm_exponent = filter.evsm_positive_exponent = positive, true;
                 }});
}

}  // namespace

raster::CapturedMoments moments_of(const Capture& capture) {
  const CapturedFilter& filter = *capture.filter;
  raster::CapturedMoments out;
  out.technique = technique_of(filter.kind);
  const double across = 2.0 * filter.radius_texels;  // a kernel's middle has the most of it
  out.own_share = 1.0 / std::max(1.0, across * across);
  out.filter.light_bleeding_reduction = filter.light_bleeding_reduction;
  out.filter.moment_bias = filter.moment_bias, out.minimum_variance = filter.minimum_variance;
  if (!filter.exponents.empty())
    out.filter.esm_exponent = out.filter.evsm_positive_exponent = filter.exponents.front();
  out.filter.evsm_negative_exponent = filter.exponents.size() > 1 ? filter.exponents[1] : 0.0;
  out.range = capture.map.front().range.value_or(Vec2(0.0, 1.0));
  return out;
}

Expected<LayerNumbers> read_moments(const Capture& capture, std::size_t layer,
                                    const raster::CapturedMoments& moments) {
  const auto picture = read_layer(capture, layer);
  if (!picture) return fail(picture.error());
  const auto wrong = [&](std::string reason) {
    return capture_error(capture, fmt::format("map[{}].depth", layer), std::move(reason));
  };
  const std::span<const std::string_view> names = moment_channels(*capture.filter);
  LayerNumbers out{picture->size, {}, {}};
  out.moments.resize(out.size.pixels());
  for (std::size_t k = 0; k < names.size(); ++k) {
    const Channel* channel = picture->find(std::string(names[k]));
    if (channel == nullptr) return wrong(fmt::format("needs channels {}", fmt::join(names, ", ")));
    if (!std::all_of(channel->values.begin(), channel->values.end(),
                     [](float v) { return std::isfinite(v); }))
      return wrong(fmt::format("has texels in channel {} that are not finite numbers", names[k]));
    for (std::size_t i = 0; i < out.moments.size(); ++i) out.moments[i][k] = channel->values[i];
  }
  // Some store both warps before their squares; a square is never below 0, and the negative warp always is.
  if (names.size() == 4 && capture.filter->kind == FilterName::evsm && !out.moments.empty() &&
      out.moments.front()[1] < 0.0f)
    for (auto& texel : out.moments) std::swap(texel[1], texel[2]);
  for (const auto& m : out.moments) {
    const double mean = mean_of_moments(moments, {m[0], m[1], m[2], m[3]});
    // An average of nothing drawn is off the far end's number by its rounding.
    const bool close = std::abs(mean - 1.0) < 0x1p-18, below = mean < 0.0 && mean > -0x1p-18;
    out.values.push_back(close ? 1.0f : below ? 0.0f : static_cast<float>(mean));
  }
  return out;
}

void add_moment_suspects(const raster::CapturedMoments& moments, std::vector<TestSuspect>& suspects) {
  if (moments.texels.empty()) return;
  add_exponents(moments, suspects);
  constexpr int steps = 20;
  for (int i = 0; i < steps; ++i) {
    const double reduction = double(i) / steps;
    suspects.push_back({fmt::format("`filter.light_bleeding_reduction` is about {:g}", reduction), "",
                        [reduction](raster::LightRecord& record) {
                          return moments_in(record).filter.light_bleeding_reduction = reduction, true;
                        }});
  }
  for (const double variance : {0.0, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2})
    suspects.push_back({fmt::format("`filter.minimum_variance` is about {:g}", variance), "",
                        [variance](raster::LightRecord& record) {
                          return moments_in(record).minimum_variance = variance, true;
                        }});
}

}  // namespace gnomon::compare
