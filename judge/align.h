// Whether a capture shows the scene as Gnomon sees it, and which of the usual differences of conventions it is
// if not. A comparison of two different pictures would be worth nothing.
#pragma once

#include <functional>
#include <string>

#include "judge/evidence.h"

namespace gnomon::judge {

struct AlignInput {
  const Capture& capture;
  const raytrace::Tracer& tracer;
  std::uint32_t light = 0;
  const raytrace::RayTracedFrame& frame;  ///< traced with the scene's camera
  bool fix = false;
  /// What the capture's map covers; null: not known. Beside it a renderer draws what it likes.
  const LightView* map = nullptr;
  /// The shadows are those of the capture's own test (OwnTest::is_believed): no convention of theirs is suspected.
  bool shadows_believed = false;
  /// Tells whether a usual mistake in the capture's test draws the shadows; asked before they are doubted.
  std::function<bool()> drawn_by_mistake{};
};

struct Aligned {
  bool everywhere = false;        ///< the sight is another than the scene's camera's
  bool trace_again = false;       ///< camera or light were changed
  bool pictures_differ = false;   ///< something was undone
  Mat3 place_from_captured{1.0};  ///< undone in the positions
  std::string doubt{};            ///< of the shadows, as a sentence, to be said where nothing explains them
};

/// Looks at positions, depths or silhouettes, the first that there is. What does not agree and is mended by a usual suspect is
/// named in `judged`, and undone in scene, sight and pictures. Error (bad input) with the agreement before and after: a
/// suspect fits and `fix` is false, or nothing fits.
Expected<Aligned> align_geometry(const AlignInput& input, Scene& scene, Sight& sight,
                                 CapturedPictures& pictures, compare::Judged& judged);
/// Does the same for the shadows, once the rest agrees. `frame` must then be traced from the sight.
Expected<Aligned> align_shadows(const AlignInput& input, Scene& scene, Sight& sight,
                                CapturedPictures& pictures, compare::Judged& judged);

/// A world in which the map's matrices are the light's, where they are not in the scene's: an error without `fix`, with it
/// the captured world, named in `judged`. `error`: what is wrong with them as they are.
Expected<Mat3> align_map(const AlignInput& input, const Error& error, const Light& light,
                         compare::Judged& judged);

/// Tells of a ratio whether the picture with shadows is the one that is named as the one without. That is so where it is
/// often brighter and hardly ever darker. An error without `fix`; with it the pictures are read again, in the other order.
Expected<void> check_order(const Capture& capture, bool orthographic, bool fix, CapturedPictures& pictures,
                           compare::Judged& judged);

/// What the visibility's values were encoded with for a display.
struct Encoding {
  compare::Mended mended;
  float (*decode)(float) = nullptr;  ///< stored to linear, both in [0, 1]
};
/// sRGB, or a gamma of 2.2, where the greys are multiples of one part once they are decoded. None where they are not,
/// or there are too few.
std::optional<Encoding> find_encoding(const CapturedPictures& pictures,
                                      const raytrace::RayTracedFrame& frame);

/// The side in pixels, 2 to 8, of the blocks that the visibility is made of: a shadow drawn at that fraction of the
/// picture's resolution and enlarged without interpolation. 1: no such blocks, or too few edges to tell.
int shadow_block(const CapturedPictures& pictures, const raytrace::RayTracedFrame& frame);

}  // namespace gnomon::judge
