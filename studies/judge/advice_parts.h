// Constants that the captured test could have: what each makes of the picture.
#pragma once

#include "compare/bias/bias_curve.h"
#include "compare/result/judged.h"
#include "studies/judge/captured_frame.h"

namespace gnomon::compare {

/// What the test draws with every constant: of pixels inside the map by their gaps; those outside stay as they are.
struct TriedConstants {
  GapLists gaps;
  std::uint64_t outside = 0, outside_wrong = 0, outside_ties = 0;

  double pixels() const { return static_cast<double>(gaps.count() + outside); }
  /// The share of the compared pixels that is wrong where so many inside the map are.
  double wrong(std::uint64_t inside) const;
  std::uint64_t inside_at(double bias_world) const;
  double wrong_at(double bias_world) const { return wrong(inside_at(bias_world)); }
};
/// `face`: of the pixels that look this one up alone; below 0: of all.
TriedConstants try_constants(const raster::LightRecord& record, const LightComparison& light, int face = -1);

/// A constant that is hardly wrong more often than the best one: the present one if it is, else the one nearest to 0.
struct GoodConstant {
  double stored = 0.0;  ///< in the map's own numbers
  double wrong = 0.0;   ///< share of the compared pixels
};
GoodConstant good_constant(const TriedConstants& tried, double unit_world, double now);

/// Another setting is worth changing for when it leaves less than this share of what the simpler one leaves.
inline constexpr double worth_changing = 0.9;

/// One constant in texels for all layers of a directional light's map, each of its own, where that is worth it; none else.
/// `least`: the share of wrong pixels that one constant in stored depth leaves.
std::optional<Advice> advise_in_texels(const LightComparison& light, const raster::LightRecord& record,
                                       double wrong_now, double least);

/// Each layer of a directional light's map with a constant of its own, where that is worth it; none else. `least`: the share
/// of wrong pixels that the best without leaves.
std::optional<Advice> advise_on_layers(const LightComparison& light, const raster::LightRecord& record,
                                       double wrong_now, double least);

/// Of a map that is read by an average of comparisons (pcf): the advised constant with what it makes of the mean error. One that raises that is moved towards the
/// present one until it does not.
void weigh_mean_error(const FrameInput& input, const raster::RasterFrame& drawn, const LightComparison& light,
                      Advice& advice);

}  // namespace gnomon::compare
