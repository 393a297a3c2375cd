// What a file does not say and the program therefore makes up: camera, light, ground. Each is noted in
// Scene::notes.
#pragma once

#include <optional>

#include "scene/files/formats.h"

namespace gnomon {

/// World-space bounds of all triangles and spheres; empty when the scene has only planes.
Aabb scene_bounds(const Scene& scene);

/// A camera that looks at the middle of the bounds from the front right and above, so near that everything is
/// just in a picture of 4:3 (and so in a wider one).
Camera default_camera(const Scene& scene, const Aabb& bounds);

/// Completes a loaded file: at least one material; a camera that frames it and a sun from above on the
/// camera's left if it has none; and for a bare model without lights a ground under it, unless it brings one.
Scene add_defaults(LoadedFile loaded);

/// Where one stands in a room, and where its lamp hangs.
struct Interior {
  Camera camera;
  Vec3 lamp{0.0};
};

/// None unless faces that lie flat near each of the six sides of `bounds` cover most of it, and either these
/// face inwards or something shines inside: a point or spot light, or a glowing surface.
std::optional<Interior> find_interior(const Scene& scene, const Aabb& bounds);

}  // namespace gnomon
