// What receivers that stay fixed in the world do from frame to frame. Let V and V' be a rung in one frame and in the
// next, and T_k = (V_k' - V_k) - (V0' - V0). T_6 is the temporal error: what the drawn shadow did beyond what the true
// one did. T_k+1 - T_k is the temporal step charged to cause k; the six sum to T_6. A flip is a receiver with |T_6| >
// 1/2. Where it is drawn wrong at one end of the step, or at both, the flip has the label of the larger error
// (deciding_step, ladder.h; of equal ones the later). Where filters leave it less than one half wrong at both, it has
// that of the step at which |T_k| last rose above one half. Sums are taken row by row and then over the rows in order,
// so that they are the same for any number of threads.
#pragma once

#include "compare/comparison.h"

namespace gnomon::studies {

/// What one frame says of its receivers; rungs mean something where `counted`.
struct RungFrame {
  std::array<Image<float>, compare::rung_count> rungs;
  Image<std::uint8_t> counted;  ///< 1: truth and drawing are to be compared here
  Image<std::uint8_t> outside;  ///< 1: the receiver's own texel lies outside the map
  Image<std::uint8_t> face;     ///< of the map: the cascade
};

/// Who made a flip: the six causes, and the map's end where the receiver lies outside in either frame.
inline constexpr std::size_t flip_label_count = compare::cause_count + 1;
inline constexpr std::uint8_t outside_map_flip = compare::cause_count;
std::string_view flip_label_name(std::size_t label, compare::Ladder ladder);

/// T_1 … T_6 of a receiver.
std::array<double, compare::cause_count> temporal_errors(const std::array<float, compare::rung_count>& before,
                                                         const std::array<float, compare::rung_count>& after);
/// The step that made the flip between these, |T_6| > 1/2.
compare::Cause flip_cause(const std::array<float, compare::rung_count>& before,
                          const std::array<float, compare::rung_count>& after);

/// Sums over the receivers counted in both of two frames.
struct TemporalSums {
  std::uint64_t receivers = 0, flips = 0, seam_flips = 0;
  std::array<std::uint64_t, flip_label_count> by_label{};
  std::array<double, compare::cause_count> signed_sum{}, absolute_sum{};
  double error_sum = 0.0, error_absolute_sum = 0.0;  ///< of T_6
  double drawn_swept = 0.0, true_swept = 0.0;        ///< world area over which |V6' - V6|, |V0' - V0|
  double edge_length = 0.0;                          ///< of the true shadow, world units
  TemporalSums& operator+=(const TemporalSums& other);
};

/// The vectors in the world from a receiver to its neighbours to the right and below, as their lengths (world units),
/// the area that they span and their dot product; all 0 where one of the two is not on the same surface.
struct ReceiverSpacing {
  Image<float> right, down, area, dot;
};
/// `step`: receivers stand at every so many pixels along both axes.
ReceiverSpacing receiver_spacing(const Image<raytrace::SurfacePoint>& receivers, const World& world,
                                 int step);

/// Describes the worst receiver over the whole film.
struct WorstReceiver {
  std::uint32_t pixel = 0;
  std::uint32_t flips = 0;
  double absolute = 0.0;  ///< sum of |T_6|
};

class TemporalBudget {
 public:
  TemporalBudget(ImageSize size, int frames, ReceiverSpacing spacing, int step);
  /// The next frame's. Returns the sums of the transition to it; empty ones for the first.
  const TemporalSums& add(RungFrame frame);

  const TemporalSums& total() const { return total_; }
  const std::vector<TemporalSums>& transitions() const { return transitions_; }
  const RungFrame& last() const { return last_; }
  /// By receiver: flips so far, and the label of the last transition's flip + 1 (0: none).
  const Image<std::uint16_t>& flips() const { return flips_; }
  const Image<std::uint8_t>& last_flips() const { return last_flips_; }
  /// Most flips first, of equals the largest sum, then the first pixel.
  std::vector<WorstReceiver> worst(std::size_t count) const;

 private:
  void add_row(int y, const RungFrame& next, TemporalSums& sums);
  Image<std::uint8_t> edge_steps() const;
  double edge_length(int x, int y) const;
  bool are_connected(int x, int y, int dx, int dy) const;

  ReceiverSpacing spacing_;
  Image<std::uint8_t> edge_steps_;
  int step_;
  RungFrame last_;
  bool has_last_ = false;
  TemporalSums total_;
  std::vector<TemporalSums> transitions_;
  Image<std::uint16_t> flips_;
  Image<std::uint8_t> last_flips_;
  Image<float> absolute_;
};

}  // namespace gnomon::studies
