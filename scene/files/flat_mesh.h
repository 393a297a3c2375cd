// Meshes under a transform that has no inverse, such as a scale of 0 along one axis.
#pragma once

#include "scene/scene.h"

namespace gnomon {

/// The mesh as `world_from_object` leaves it, in the world: what becomes a line or a point is left out, normals are the
/// triangles' own. Without triangles where nothing else is left.
Mesh flattened(const Mesh& mesh, const Mat4& world_from_object);

}  // namespace gnomon
