// Renders and compares a scene in one call, for tests.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "compare/compare.h"
#include "scene/world.h"
#include "tests/support/small_scenes.h"

namespace gnomon::test {

/// A comparison together with what it points into.
struct Compared {
  std::unique_ptr<Scene> scene;
  std::unique_ptr<World> world;
  compare::Comparison result;
  const compare::LightComparison& light(std::size_t i = 0) const { return result.lights[i]; }
};

/// Renders both ways and compares; fails the test (and returns an empty result) on an error.
Compared run_comparison(Scene scene, const compare::CompareOptions& options,
                        const std::string& shader_folder = {});

/// Options for a test: untimed, one map, the given image size, without what `perceptual` adds.
compare::CompareOptions test_options(ImageSize size, int map_size, double bias_world = 0.0);

/// Puts a text into a file, between the marks `<!-- NAME -->` and `<!-- end of the NAME -->`, each a line of its own.
void write_between_marks(const std::string& path, const std::string& name, const std::string& text);

/// P(a U1 + b U2 > bias) for independent U1, U2 uniform on (-1, 1): the acne fraction of a plane whose depth
/// changes by a and b over half a texel (docs/design.md, section 3).
double acne_fraction(double a, double b, double bias);

}  // namespace gnomon::test
