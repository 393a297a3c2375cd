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
/// camera. Its half side is the diagonal of the box around these. A note says where it ends.
Scene cut_planes(Scene scene);

/// One shape; requires that it is no plane.
Mesh tessellated(const Shape& shape, int n);

// Triangles of an implicit surface by surface nets (Gibson 1998, "Constrained elastic surface nets", MICCAI),
// in their plain dual form. There is one corner per grid cell that the surface passes through, one quad per
// grid edge that it crosses.

/// Adds them, in world coordinates, with the function's gradients as normals. The box has n cells along each
/// axis. A closed body is taken as max(f, distance to the box's faces) on a grid one cell wider, so that its
/// mesh is closed; corners on a cut keep their place in the cell.
void add_surface_nets(const Implicit& implicit, int n, Mesh& mesh);

}  // namespace gnomon
