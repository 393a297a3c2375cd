#include "judge/moment_maps.h"

#include <algorithm>
#include <cmath>

#include "compare/ladder/moments.h"
#include "judge/stored_depths.h"
#include "scene/base/parallel.h"

namespace gnomon::compare {
namespace {

using raster::CapturedMoments;
using raster::Technique;

/// Returns the number that a texel stores of a depth along the map's axis, in [0, 1].
double stored_number(const raster::LightRecord& record, raytrace::TexelKey key, double depth) {
  using Stores = raster::CapturedTest::Stores;
  const raster::CapturedTest& test = *record.captured->test;
  const LightView& view = record.map.view;
  const double row = key.row() + 0.5;
  if (test.stores == Stores::depths)
    return std::clamp(stored_from_depth(view, key.face(), row, depth), 0.0, 1.0);
  double world = depth;
  if (test.stores == Stores::distances)
    world /= glm::dot(texel_ray(view, key.face(), key.column() + 0.5, row).direction,
                      view.face(key.face()).forward);
  const Vec2& range = test.moments.range;
  return std::clamp((world - range.x) / (range.y - range.x), 0.0, 1.0);
}

/// What a channel of a technique with exponents holds of a number.
double channel_of(const CapturedMoments& moments, std::size_t channel, double x) {
  if (moments.technique == Technique::esm) return std::exp(moments.filter.esm_exponent * x);
  const double sign = channel < 2 ? 1.0 : -1.0;
  const double exponent =
      channel < 2 ? moments.filter.evsm_positive_exponent : moments.filter.evsm_negative_exponent;
  const double warped = sign * std::exp(sign * exponent * (2.0 * x - 1.0));
  return channel % 2 == 0 ? warped : warped * warped;
}

std::size_t channels_of(const CapturedMoments& moments) {
  if (moments.technique == Technique::esm) return 1;
  return moments.filter.evsm_negative_exponent > 0.0 ? 4 : 2;
}

}  // namespace

MomentMaps::MomentMaps(const FrameInput& in, const raster::LightRecord& record) : record_(record) {
  const StoredDepths depths(in, record);
  const LightView& view = record.map.view;
  const auto n = static_cast<std::size_t>(view.size);
  numbers_.assign(record.map.depth.size(), 1.0);
  parallel_for(numbers_.size() / n, [&](std::size_t line) {
    const int face = static_cast<int>(line / n), row = static_cast<int>(line % n);
    for (int column = 0; column < view.size; ++column) {
      const auto key = raytrace::TexelKey::pack(face, column, row);
      if (const auto met = depths.first(key))
        numbers_[record.map.texel_index(face, column, row)] = stored_number(record, key, met->depth);
    }
  });
  fit_reach();
}

/// The mean over a square, row by row and then column by column; of texels beyond the border the nearest.
std::vector<double> MomentMaps::averaged(const std::vector<double>& values, int reach) const {
  const int n = record_.map.view.size;
  std::vector<double> across(values.size()), out(values.size());
  const auto pass = [&](const std::vector<double>& from, std::vector<double>& to, bool rows) {
    parallel_for(values.size() / static_cast<std::size_t>(n), [&](std::size_t line) {
      const int face = static_cast<int>(line) / n, fixed = static_cast<int>(line) % n;
      const auto index = [&](int k) {
        const int along = std::clamp(k, 0, n - 1);
        return rows ? record_.map.texel_index(face, along, fixed)
                    : record_.map.texel_index(face, fixed, along);
      };
      for (int i = 0; i < n; ++i) {
        double sum = 0.0;
        for (int k = i - reach; k <= i + reach; ++k) sum += from[index(k)];
        to[index(i)] = sum / (2 * reach + 1);
      }
    });
  };
  pass(values, across, true), pass(across, out, false);
  return out;
}

void MomentMaps::fit_reach() {
  constexpr double alike = 0.1;
  const CapturedMoments& moments = record_.captured->test->moments;
  std::vector<double> warped(numbers_.size());
  for (std::size_t i = 0; i < warped.size(); ++i) warped[i] = channel_of(moments, 0, numbers_[i]);
  const auto off = [&](const std::vector<double>& averages) {
    double sum = 0.0;
    for (std::size_t i = 0; i < averages.size(); ++i)
      sum += std::abs(mean_of_moments(moments, {averages[i], 0.0, 0.0, 0.0}) -
                      mean_of_moments(moments, {double{moments.texels[i][0]}, 0.0, 0.0, 0.0}));
    return sum;
  };
  const double unaveraged = off(warped);
  double least = infinity;
  const int most = static_cast<int>(std::ceil(0.5 / std::sqrt(moments.own_share) + 1.0));
  for (int reach = 0; reach <= most; ++reach)
    if (const double now = off(averaged(warped, reach)); now < least) least = now, reach_ = reach;
  as_stored_ = reach_ > 0 && least <= alike * unaveraged;
}

std::vector<CapturedMoments::Texel> MomentMaps::texels(const CapturedMoments& moments) const {
  std::vector<CapturedMoments::Texel> out(numbers_.size(), CapturedMoments::Texel{});
  std::vector<double> warped(numbers_.size());
  for (std::size_t channel = 0; channel < channels_of(moments); ++channel) {
    for (std::size_t i = 0; i < warped.size(); ++i) warped[i] = channel_of(moments, channel, numbers_[i]);
    const std::vector<double> averages = averaged(warped, reach_);
    for (std::size_t i = 0; i < out.size(); ++i) out[i][channel] = static_cast<float>(averages[i]);
  }
  return out;
}

std::vector<WarpExponents> exponents_to_try(const CapturedMoments& moments) {
  const raster::FilterOptions& now = moments.filter;
  std::vector<WarpExponents> out;
  if (moments.technique == Technique::esm)
    for (const double exponent : {20.0, 40.0, 60.0, 80.0}) out.push_back({exponent, 0.0});
  if (moments.technique == Technique::evsm) {
    // The square of the warp has to be a float.
    for (const double positive : {now.evsm_positive_exponent, 10.0, 20.0, 40.0})
      for (const double negative : {0.0, 5.0, 10.0})
        if (negative > 0.0 || now.evsm_negative_exponent == 0.0) out.push_back({positive, negative});
  }
  return out;
}

}  // namespace gnomon::compare
