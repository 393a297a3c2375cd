// An acceleration structure of a built-in scene, cut by an upright plane: of the structure what a ray in that plane can
// come to, so that the page traverses the very cells that the ray tracer traverses (raytrace/accel), and of the scene
// the segments that such a ray can hit.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "scene/expected.h"

namespace gnomon::app::lessons {

/// `kind`: grid, octree, kd, bsp, or bvh, the binary one. Keys: "plane" (z), "bounds" [left, right, bottom, top],
/// "segments" [[item, x0, y0, x1, y1], …], "primitives" (of the whole scene), "tree", of a BSP tree "slack", and
/// "checks": rays with what the program counts for them.
///
/// A tree's node is a leaf {"items": […]}, or has "children": of a kd-tree with "axis" and "split", of an octree with
/// "middle", of a BSP tree with "normal" and "offset", of a BVH with its own "box"; a child that the plane does not come
/// to is null, except of a BVH, where it is {"missed": true}, for it is tested. A grid has "walls" of both axes and
/// "cells", rows of x. Items are ranges: first, last, first, last, …
/// Error: of the scene; (internal) no such kind.
Expected<nlohmann::ordered_json> structure_cut(const std::string& kind, const std::string& scene);

}  // namespace gnomon::app::lessons
