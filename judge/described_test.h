// Whether the shadow test that a capture describes (map, matrix, bias, filter) is the one that was drawn. Where not, the
// ladder's reasons are those of something else. (What the map holds: map_content.h.)
#pragma once

#include "compare/comparison.h"
#include "judge/captured_frame.h"
#include "judge/filter_kernel.h"

namespace gnomon::judge {

struct DescribedTest {
  std::size_t compared = 0;  ///< pixels
  /// Compared pixels that the described test does not draw as they were drawn. That must hold whatever rounding does,
  /// whichever texel within the filter's reach decides, and whichever cascade that holds the place is looked up. Those that are
  /// partly lit where the test cannot make that are among them; those behind the far plane are not.
  std::size_t not_drawn = 0;
  std::size_t drawn_darker = 0;  ///< of these; the others are drawn lighter than the test has them
  /// A filter whose average of comparisons comes near to what is drawn of them; none does, or none is looked for.
  std::optional<FilterKernel> filter{};
  double filter_error = 0.0;  ///< how far it is off, on average
  /// Drawn as another layer than the first that holds the place has it; the capture does not say which is looked up.
  std::size_t by_another_layer = 0;

  bool is_drawn() const;  ///< but for a few pixels
  /// Tells whether the filter draws them to the last step of eight bits, so that nothing else need be looked for.
  bool filter_is_known() const;
  /// In 19 of 20 pixels: something else darkens or lightens the rest, such as contact shadows or a fade with distance.
  bool is_mostly_drawn() const;
};

/// Wrong pixels that the described test cannot have made get the label `unexplained`. Needs a
/// map. `light` is that of `drawn`'s only record.
DescribedTest check_described_test(const FrameInput& input, const raster::RasterFrame& drawn,
                                   compare::LightComparison& light);

/// Where receivers stand so far from the world's origin that floats of their places are coarse against the map's texels: by how
/// much two of them differ.
std::vector<std::string> far_places_notes(const FrameInput& input, const raster::LightRecord& record);

/// A usual mistake in the description with which it is the test that was drawn.
struct OtherTest {
  std::string what;    ///< "`rows` of the map is the other one"
  double share = 0.0;  ///< of the compared pixels that are drawn so
  /// It is the constant that the capture says otherwise: what other constants would draw holds all the same.
  bool of_constant = false;
  double constant_world = 0.0;  ///< where it is `of_constant`: the one that was drawn, as of LightRecord
};
std::optional<OtherTest> find_drawn_test(const FrameInput& input, const raster::RasterFrame& drawn,
                                         const compare::LightComparison& light);
/// Tells before anything is compared whether there is such a mistake. Needs a map; `drawn`: the capture's frame.
bool is_drawn_but_for_a_mistake(const FrameInput& input, const raster::RasterFrame& drawn);

/// Whether what the described test would draw with another bias says something of the renderer.
inline bool advice_holds(const DescribedTest& test, const std::optional<OtherTest>& other) {
  return test.is_drawn() || (other ? other->of_constant : test.is_mostly_drawn());
}

/// That the test is not the one drawn, as a sentence.
std::vector<std::string> described_test_notes(const DescribedTest& test,
                                              const std::optional<OtherTest>& other);

}  // namespace gnomon::judge
