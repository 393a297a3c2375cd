// The conformance suite: small scenes with one light each, whose shadows can be worked out by hand. They are
// made of three meshes, so that a test can work them out: "box", the unit cube around its origin; "square",
// the unit square in the plane y = 0, facing up, with texture coordinates (x + 1/2, z + 1/2); "ell", two boxes.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace gnomon::app {

struct SuiteScene {
  std::string description;  ///< one sentence: what it shows, and what goes wrong there
  Scene scene;              ///< its name is the file's
};

std::vector<SuiteScene> suite_scenes();

/// The two boxes of the mesh "ell", in its own space.
std::vector<Aabb> ell_boxes();

}  // namespace gnomon::app
