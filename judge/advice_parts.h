// Constants that the captured test could have: which of them leaves least of the error.
#pragma once

#include "compare/bias/bias_curve.h"
#include "compare/result/judged.h"
#include "judge/captured_frame.h"
#include "judge/redrawing.h"

namespace gnomon::judge {

/// What a test that compares once draws with every constant: of pixels inside the map by their gaps; those outside stay as
/// they are.
struct TriedConstants {
  compare::GapLists gaps;
  std::uint64_t outside = 0, outside_wrong = 0, outside_ties = 0;

  double pixels() const { return static_cast<double>(gaps.count() + outside); }
  /// The share of the compared pixels that is wrong where so many inside the map are.
  double wrong(std::uint64_t inside) const;
  std::uint64_t inside_at(double bias_world) const;
  double wrong_at(double bias_world) const { return wrong(inside_at(bias_world)); }
};
/// `face`: of the pixels that look this one up alone; below 0: of all.
TriedConstants try_constants(const raster::LightRecord& record, const compare::LightComparison& light,
                             int face = -1);

/// A constant that leaves hardly more than the best one: the present one if it does, else the one nearest to 0.
struct GoodConstant {
  double stored = 0.0;  ///< in the map's own numbers
  /// What it leaves: of single comparisons the share of wrong pixels, else the mean error over a sample of the pixels.
  double left = 0.0;
};
GoodConstant good_constant(const TriedConstants& tried, double unit_world, double now);

/// Another setting is worth changing for when it leaves less than this share of what the simpler one leaves.
inline constexpr double worth_changing = 0.9;

/// What constants are looked for with.
struct ConstantSearch {
  const FrameInput& in;
  const raster::Bias& bias;
  const compare::LightComparison& light;
  const Redrawing& redrawing;
  double unit_world = 1.0;
  double now = 0.0;  ///< stored numbers

  /// Returns the constant that suits the record's other numbers; it changes the record's gaps. `face`: for that one alone.
  GoodConstant best_beside(TestedRecord& record, int face = -1) const;
  /// Returns what a constant, stored numbers, leaves of what is looked for.
  double left_at(TestedRecord& record, double stored) const;
};

/// Whether the layers of a record's map can each have a constant of their own that counts alike at every angle.
bool has_layers(const raster::LightRecord& record);

/// One constant in texels for all layers of a directional light's map, each of its own.
compare::Advice advise_in_texels(const ConstantSearch& search);
/// Each layer of a directional light's map with a constant of its own.
compare::Advice advise_on_layers(const ConstantSearch& search);

}  // namespace gnomon::judge
