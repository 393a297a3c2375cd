// Exact shapes turned into triangles, to show on purpose what that changes: flat facets with the true normals
// at their corners, outlines that are polygons. Planes stay, for they have no end.
#pragma once

#include "scene/scene.h"

namespace gnomon {

inline constexpr int min_tessellation = 3, max_tessellation = 256;

/// Every shape but planes becomes a mesh and an instance of the same name and material. Spheres, quadrics and
/// tori: n sectors around their axis, n / 2 (at least 2) rings where they are curved along it; corners lie on
/// the surface, closed shapes give closed meshes. Implicit surfaces: surface nets (Gibson 1998, "Constrained
/// elastic surface nets") over n^3 cells of their box, corners moved onto the surface; features thinner than
/// a cell are lost. A note says what was done.
Scene tessellate_shapes(Scene scene, int n);

/// Every infinite plane becomes a square mesh of the same name and material, around what is finite and the
/// camera: its half side is the diagonal of the box around these. A note says where it ends.
Scene cut_planes(Scene scene);

/// One shape; requires that it is no plane.
Mesh tessellated(const Shape& shape, int n);

}  // namespace gnomon
