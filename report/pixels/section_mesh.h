// What the page cuts to draw its cross-section: the scene's triangles and, as finely tessellated meshes, the
// solids whose cut is no circle or line. Spheres and planes the page cuts itself, exactly.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/world.h"

namespace gnomon::compare {

struct SectionMesh {
  std::vector<Vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// Of quadrics and tori (scene/shapes/tessellate.h), twice the cells across an implicit surface; 0: there are
  /// none.
  int solid_sectors = 0;
  bool complete = true;  ///< false: triangles or solids are too many for a page and left out
};

/// `most_triangles`: of the scene's own, and again of the solids', who get fewer sectors before they go.
SectionMesh section_mesh(const World& world, std::size_t most_triangles = 200000);

}  // namespace gnomon::compare
