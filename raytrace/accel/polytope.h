// A convex cell with flat faces: what is left of a box after cuts by planes. Its area weighs the costs of a
// BSP tree's cuts; no ray's answer depends on it.
#pragma once

#include <array>
#include <vector>

#include "raytrace/accel/even_cells.h"

namespace gnomon::raytrace {

/// normal . p <= offset is below. The normal has unit length.
struct CutPlane {
  Vec3 normal;
  double offset;
  double height(const Vec3& p) const { return glm::dot(normal, p) - offset; }
};

/// Room for areas_of_parts() to work in.
struct CutBuffers {
  std::vector<Vec3> polygon, crossings;
};

class Polytope {
 public:
  explicit Polytope(const CellBox& box);

  double area() const { return area_; }
  /// The areas of the parts below and above, both with their new face.
  std::array<double, 2> areas_of_parts(const CutPlane& plane, CutBuffers& buffers) const;
  /// The part below.
  Polytope cut(const CutPlane& plane) const;

 private:
  using Face = std::vector<Vec3>;
  Polytope() = default;
  std::vector<Face> faces_;
  double area_ = 0.0;
};

}  // namespace gnomon::raytrace
