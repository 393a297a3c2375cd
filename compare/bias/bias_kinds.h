// Which kind of bias suits a drawing: constant, slope, normal offset, receiver plane or adaptive. Each is
// tried on the map as it was drawn, with the double-precision twin of the hard test (biased_test.h). Each is
// taken at the smallest setting that is hardly wrong more often than its best.
#pragma once

#include "compare/bias/bias_curve.h"
#include "compare/ladder/ladder.h"

namespace gnomon::compare {

/// Settings that are hardly worse than the best: by at most one compared pixel in 100,000, or one wrong pixel
/// in fifty.
struct BiasRange {
  float from = 0.0f, to = 0.0f;  ///< the first such settings: from <= setting < to
};
/// `gaps` may be those of any setting that lights more pixels the larger it is.
BiasRange smallest_good_range(const GapLists& gaps);
/// find_best_bias, with what is clearly smaller and hardly worse. `unit_world`: world units of 1 in the unit that the
/// constant is given in.
BestBias find_advised_bias(const GapLists& gaps, double unit_world = 1.0);

/// Returns the number with the fewest digits in [from, to), not far above from; where none of three digits lies there, the
/// one nearest to from.
double short_number_in(double from, double to);

/// What kinds are compared by, of the pixels of some rows. `settings`: of each kind, for each compared pixel the setting
/// from which on it is lit, in the order of the pixels, and which side each is on; ties (GapLists) are counted.
/// `caster_slope` can be tried where the casters were drawn with one.
enum KindOfBias : std::size_t {
  plain,
  slope,
  receiver_plane,
  adaptive,
  normal_offset,
  caster_slope,
  kind_count
};
/// What a pixel is in truth, and of a lit one whether a bias mends it (GapLists).
enum class PixelSide : std::uint8_t { shadowed, lit, lit_by_lifting };
inline constexpr std::size_t side_count = 3;
struct KindSettings {
  std::array<std::vector<float>, kind_count> settings;
  std::vector<PixelSide> sides;
  std::uint64_t ties = 0;
};
/// Whether kinds can be compared on this map.
bool kinds_apply(const raster::RasterFrame& drawn, const raster::LightRecord& record);
KindSettings settings_of_kinds(const LadderInput& in, const std::array<Image<float>, rung_count>& rungs,
                               const Image<Label>& labels);
/// Lists of one kind from its settings; the lit ones that no setting harms are only counted.
void append_to_lists(const std::vector<float>& settings, const std::vector<PixelSide>& sides,
                     GapLists& lists);
/// From sorted lists.
BiasKind kind_of_bias(KindOfBias kind, const LadderInput& in, const GapLists& lists);
/// The best first.
void sort_kinds(std::vector<BiasKind>& kinds);
/// In the order in which equally good kinds are listed.
inline constexpr std::array<KindOfBias, kind_count> kinds_in_order{slope,          caster_slope,  plain,
                                                                   receiver_plane, normal_offset, adaptive};
bool is_tried(KindOfBias kind, const raster::Bias& drawn);

}  // namespace gnomon::compare
