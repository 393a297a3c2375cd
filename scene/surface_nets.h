// Triangles of an implicit surface: surface nets (Gibson 1998, "Constrained elastic surface nets", MICCAI),
// in their plain dual form: one corner per grid cell that the surface passes through, one quad per grid edge
// that it crosses.
#pragma once

#include "scene/scene.h"

namespace gnomon {

/// Adds them, in world coordinates, with the function's gradients as normals. The box has n cells along each
/// axis. A closed body is taken as max(f, distance to the box's faces) on a grid one cell wider, so that its
/// mesh is closed; corners on a cut keep their place in the cell.
void add_surface_nets(const Implicit& implicit, int n, Mesh& mesh);

}  // namespace gnomon
