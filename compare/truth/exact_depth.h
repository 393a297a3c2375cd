// The upper rungs of a pixel at any constant bias: the biased test of V5, and the same with the exact depth in place of
// the stored one. What is wrong with the one and right with the other is the stored number's fault.
#pragma once

#include <optional>

#include "compare/ladder/biased_test.h"
#include "compare/truth/columns.h"

namespace gnomon::compare {

/// Whether a stored depth is the exact one up to the rounding of the shaders' floats. Such a depth counts as
/// exact. A floor that faces the light squarely has one depth all over, and the map's float of it may fall to
/// either side. No rasterizer that rounds both sides alike would see that. Of averaged moments: whether the
/// exact one is among those that may have been averaged.
inline bool is_exact(const LadderInput& input, raytrace::TexelKey key, double stored_depth,
                     double exact_depth) {
  const double rounding = input.record().rounding.float_world;
  const raster::MapTest& test = test_of(input.record());
  if (test.reads() != raster::MapTest::Reads::averages)
    return std::abs(stored_depth - exact_depth) <= rounding;
  const Interval averaged = test.averaged_depths(input.record(), key);
  const double far = input.record().map.view.face(key.face()).far_depth;
  return exact_depth >= averaged.min - rounding && std::min(exact_depth, far) <= averaged.max + rounding;
}

/// A climbed pixel above its lower rungs: V5, V6 and the label that it has at any constant bias.
class UpperPixel {
 public:
  using Rungs = std::array<Image<float>, rung_count>;
  /// `group`: the pixel's; `column`: of that group's texel; `rungs`: the picture's, of which V0 ... V4 are read. What is
  /// given by reference must outlive this.
  UpperPixel(const LowerClimb& lower, const LadderInput& input, Column& column, std::size_t group,
             std::uint32_t pixel, const Rungs& rungs);

  /// The gap of rung V5, in double precision (biased_test.h).
  double gap() const { return gap_; }
  /// The gap of V5 to the surface that the looked-up texel stores, at the exact depth at which the ray through
  /// the texel's centre meets it. The surface is the ray's first hit, or with culling the stored one
  /// (stored_surface.h). The gap is -infinity where the ray meets nothing. There is none where the depth is no
  /// surface's (midpoint), or with culling nothing is stored. It is looked for when it is first asked for.
  const std::optional<double>& exact_gap();

  /// The gap of V5 to what the looked-up texel would store without the casters' bias; none where they have none.
  std::optional<double> unmoved_gap() const;

  struct Verdict {
    float biased = 0.0f;         ///< V5
    Label label = Label::right;  ///< right as well where no label is asked for
  };
  /// Where the constant bias is so many world units and the pixel is drawn as V6 = `drawn`.
  Verdict verdict_at(double bias_world, float drawn, bool labelled = true);

 private:
  using Levels = std::array<float, rung_count>;
  bool right_with_exact_depth(Levels v, double bias_world);
  bool right_with_unmoved_casters(Levels v, double bias_world) const;

  const LowerClimb& lower_;
  const LadderInput& in_;
  Column& column_;
  std::size_t group_;
  std::uint32_t pixel_;
  const Rungs& rungs_;
  raytrace::TexelKey lookup_;
  double gap_;
  std::optional<std::optional<double>> exact_;
};

}  // namespace gnomon::compare
