// What a file does not say and the program therefore makes up: camera, light, ground. Each is noted in
// Scene::notes.
#pragma once

#include "scene/files/formats.h"

namespace gnomon {

/// World-space bounds of all triangles and spheres; empty when the scene has only planes.
Aabb scene_bounds(const Scene& scene);

/// A camera that looks at the middle of the bounds from the front right and above. It is so near that
/// everything is just in a picture of `aspect`, width by height, and in every wider one.
Camera default_camera(const Scene& scene, const Aabb& bounds, double aspect);

/// From above, on the camera's left, and a little from its side.
Light default_sun(const Camera& camera);

/// Completes a loaded file: at least one material; a camera that looks at what casts shadows (made_view.h) and a sun from
/// above on the camera's left, or a lamp in closed rooms, if it has none; and for a bare model without lights a ground
/// under it, unless it brings one. One note says what was made.
Scene add_defaults(LoadedFile loaded);

}  // namespace gnomon
