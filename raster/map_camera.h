// Maps fitted to another camera than the one whose picture is drawn. The picture's pixels then show receivers that
// stay where they are in the world, while each drawing has the map that the moving camera would get: V6 at fixed
// receivers, by the very programs that draw the picture, and so without any reprojection (docs/shimmer.md).
#pragma once

#include <optional>

#include "raster/renderer.h"

namespace gnomon::raster {

/// The camera that maps are fitted to. `shift` and `margin` are for a map that follows the camera by translation
/// alone: the window fitted to `camera` is wider by `margin` on each side and then moved.
struct MapCamera {
  Camera camera;
  Vec3 shift{0.0};      ///< world units; orthographic maps move by what of it lies across the light
  double margin = 0.0;  ///< world units, >= 0; of orthographic maps without a warp
};

/// From the next frame on; nothing: the picture's own camera, as it is at first. The renderer is one that
/// Renderer::create made.
void set_map_camera(Renderer& renderer, const std::optional<MapCamera>& camera);

}  // namespace gnomon::raster
