// The conformance suite as files: scenes, their true masks, and how to capture them.
#pragma once

#include <string>
#include <vector>

#include "app/console.h"
#include "raytrace/frame.h"
#include "scene/base/expected.h"
#include "scene/image.h"
#include "scene/scene.h"

namespace gnomon::app {

// The conformance suite: small scenes with one light each, whose shadows can be worked out by hand. They are
// made of three meshes, so that a test can work them out: "box", the unit cube around its origin; "square",
// the unit square in the plane y = 0, facing up, with texture coordinates (x + 1/2, z + 1/2); "ell", two boxes.

struct SuiteScene {
  std::string description;  ///< one sentence: what it shows, and what goes wrong there
  Scene scene;              ///< its name is the file's
};

std::vector<SuiteScene> suite_scenes();

/// The two boxes of the mesh "ell", in its own space.
std::vector<Aabb> ell_boxes();

/// A scene's truth at the centres of the pixels, row 0 at the top. Both hold 0 and 1.
struct SuiteMask {
  std::vector<float> lit;
  std::vector<float> asked;  ///< 0: background, beyond the light's reach, or a tie
};
/// Draws the mask of a scene with one light without size, by exact arithmetic.
SuiteMask suite_mask(const Scene& scene, ImageSize size);

/// Writes FOLDER/NAME.glb, FOLDER/NAME.exr (channels V = lit, A = asked) of every scene, and FOLDER/README.md.
Expected<void> write_suite(const std::string& folder, ImageSize size, Console& console);

}  // namespace gnomon::app
