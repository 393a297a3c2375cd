// The conformance suite as files: scenes, their true masks, and how to capture them.
#pragma once

#include <string>

#include "app/console.h"
#include "raytrace/frame.h"
#include "scene/expected.h"
#include "scene/image.h"

namespace gnomon::app {

/// A scene's truth at the centres of the pixels, row 0 at the top. Both hold 0 and 1.
struct SuiteMask {
  std::vector<float> lit;
  std::vector<float> asked;  ///< 0: background, beyond the light's reach, or a tie
};
/// Of a scene with one light without size, by exact arithmetic.
SuiteMask suite_mask(const Scene& scene, ImageSize size);

/// Writes FOLDER/NAME.glb, FOLDER/NAME.exr (channels V = lit, A = asked) of every scene, and FOLDER/README.md.
Expected<void> write_suite(const std::string& folder, ImageSize size, Console& console);

}  // namespace gnomon::app
