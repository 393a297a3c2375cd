// Rooms: models that are closed all around and are meant to be seen from within.
#pragma once

#include <optional>

#include "scene/scene.h"

namespace gnomon {

/// Where one stands in a room, and where its lamp hangs.
struct Interior {
  Camera camera;
  Vec3 lamp{0.0};
};

/// None unless faces that lie flat near each of the six sides of `bounds` cover most of it, and either these
/// face inwards or something shines inside: a point or spot light, or a glowing surface.
std::optional<Interior> find_interior(const Scene& scene, const Aabb& bounds);

}  // namespace gnomon
