// The scenes of the speed figures: a teapot, the bunny, and a million triangles, each over a ground; terrains, and a forest.
// All positions are floats, so that every tracer sees the same geometry.
#pragma once

#include <optional>
#include <string>

#include "scene/scene.h"

namespace gnomon::bench {

struct BenchScene {
  std::string name;
  Scene scene;  ///< light 0 is a point, light 1 a sun
};

BenchScene teapot_scene();
/// Nothing where the model is not there.
std::optional<BenchScene> bunny_scene();
/// A terrain with seven bunnies; teapots where there is no bunny.
BenchScene million_scene();
/// The built-in forest under a point above the ride, and its sun: 20 million triangles by 2,000 instances, which are
/// kept.
std::optional<BenchScene> forest_scene();
/// Makes a terrain of 2 cells^2 triangles, under the million's lights and camera.
BenchScene terrain_scene(const std::string& name, int cells);

}  // namespace gnomon::bench
