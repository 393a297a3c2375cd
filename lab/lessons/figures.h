// The live figures of one page: what a lesson's marks ask for, as the data that the page's script
// (report/page/src/lessons) makes figures of. A mark of a name that is not known here keeps its picture.
#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "lab/lessons/comparison.h"
#include "lab/lessons/lesson_text.h"
#include "scene/base/expected.h"

namespace gnomon::lab::lessons {

class PageFigures {
 public:
  /// `lab`: where the lab's page is, seen from this one, and beside it the program for the web; empty where there is none.
  explicit PageFigures(app::Console& console, std::string lab = {})
      : console_(console), lab_(std::move(lab)) {}

  /// Adds the figure of the next mark. Errors: of its scene and its settings.
  Expected<void> add(const LiveMark& mark);

  /// The page's data without its parts.
  nlohmann::ordered_json data() const;
  const std::vector<report::DataPart>& parts() const { return parts_; }

 private:
  using Json = nlohmann::ordered_json;
  struct Row;
  /// Every figure that the program knows: its name, what makes it, and what it can be computed with again.
  static std::span<const Row> rows();
  static Json controls_of(const Row& row);
  Expected<Json> bias(const LiveMark& mark);
  Expected<Json> map_size(const LiveMark& mark);
  Expected<Json> two_passes(const LiveMark& mark);
  Expected<SmallComparison> compare(const LiveMark& mark, const Settings& settings);
  /// The key of a comparison that is now among the page's; all its parts, or the light's alone as light `light`.
  std::string keep(const std::string& key, SmallComparison&& comparison, int light);

  app::Console& console_;
  std::string lab_;
  Json figures_ = Json::array(), comparisons_ = Json::object(), words_ = Json::object(),
       drawn_ = Json::object();
  std::set<std::string> kept_;  ///< names of parts
  std::vector<report::DataPart> parts_;
};

/// One figure as a page of its own would have it, data and parts: what the program for the web answers a lesson's page that asks for
/// other settings. JSON. Errors: of the mark's scene and its settings, of the graphics.
Expected<std::string> compute_figure(const LiveMark& mark, app::Console& console);

// What the ray tracer finds for rays at the surfaces of the intersection figures (report/page/src/lessons), whose
// numbers the page works out by itself.

/// `kind`: box, triangle, sphere, plane, implicit, parity; discs, with "discs" [[x, y, radius], …], of the figures that build.
/// The checks:
/// - {"checks": [{from, to, t}]}: rays in the plane z = 0 from one point towards another, and the distance of the first hit or
///   null.
/// - "crossings": how many surfaces lie along it.
/// - Of a triangle "checks" [{corners [[x, y], …], t}]: seen along a ray down the z axis, corners at depths 2, 3 and 5.
/// Error (internal): no such kind.
Expected<nlohmann::ordered_json> intersection_checks(const std::string& kind);

/// What the program's camera looks through: {"checks": [{columns, rows, fov, x, y, direction}]}. `fov` is the vertical angle in
/// degrees, x and y are a pixel from the top left. `direction` is the unit direction through its centre of an eye that looks down
/// -z.
nlohmann::ordered_json eye_ray_checks();

// An acceleration structure of a built-in scene, cut by an upright plane. Of the structure it holds what a ray in that
// plane can come to. So the page traverses the very cells that the ray tracer traverses (raytrace/accel). Of the scene
// it holds the segments that such a ray can hit.

/// `kind`: grid, octree, kd, bsp, or bvh, the binary one. Keys:
/// - "plane" (z), "bounds" [left, right, bottom, top]
/// - "segments" [[item, x0, y0, x1, y1], …], "primitives" (of the whole scene)
/// - "tree", of a BSP tree "slack", and "checks": rays with what the program counts for them
///
/// A tree's node is a leaf {"items": […]}, or has "children". Beside these a kd-tree has "axis" and "split", an octree
/// "middle", a BSP tree "normal" and "offset", a BVH its own "box". A child that the plane does not come to is null. In
/// a BVH it is {"missed": true}, for it is tested. A grid has "walls" of both axes and "cells", rows of x. Items are
/// ranges: first, last, first, last, … Error: of the scene; (internal) no such kind.
Expected<nlohmann::ordered_json> structure_cut(const std::string& kind, const std::string& scene);

/// What grids with 1 to 125 cells a primitive cost a built-in scene's eye rays and shadow rays: "points" [{density, cells, triangles}], both
/// means of a ray. "program" has the same as the ray tracer counts them for its own two grids, the endless planes among the
/// triangles. Errors: of the scene.
Expected<nlohmann::ordered_json> grid_curve(const std::string& scene);

}  // namespace gnomon::lab::lessons
