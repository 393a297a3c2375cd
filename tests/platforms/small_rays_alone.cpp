// What small_rays.cpp has for another processor in the place of libraries: Highway's choice, of one set of vectors, and those parts of
// the tracer that need GMP or solids. None of its rays comes there, and one that did would end it.
#include <hwy/targets.h>

#include <cstdlib>

#include "raytrace/shapes/intersect.h"
#include "raytrace/shapes/solid.h"
#include "scene/shapes/solid.h"

namespace hwy {
ChosenTarget& GetChosenTarget() {
  static ChosenTarget only;
  return only;
}
}  // namespace hwy

namespace gnomon {

Aabb world_box(const ShapeGeometry&) {
  std::abort();
}
Vec3 solid_normal(const ShapeGeometry&, const Vec3&) {
  std::abort();
}

namespace raytrace {

bool starts_before(const RayFrame&, const LeafPrimitive&) {
  std::abort();
}
bool finish_edge_on(const RayFrame&, const LeafPrimitive&, TriangleHit&) {
  std::abort();
}
bool intersect_solid(const RayFrame&, const ShapeGeometry&, double&) {
  std::abort();
}

}  // namespace raytrace
}  // namespace gnomon
