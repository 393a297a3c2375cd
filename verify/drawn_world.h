// What the cases of the depth map work with: a small world drawn by the rasterizer, where there is a context.
#pragma once

#include <memory>

#include "raster/renderer.h"
#include "verify/run.h"
#include "verify/small_world.h"

namespace gnomon::verify {

/// A world and its rasterizer.
class DrawnWorld {
 public:
  /// Why there is no rasterizer stands in error().
  explicit DrawnWorld(Scene scene);
  bool ready() const { return renderer_ != nullptr; }
  bool has_context() const { return has_context_; }
  const Error& error() const { return error_; }
  const World& world() const { return world_; }
  /// Camera and lights may change between drawings.
  Scene& scene() { return scene_; }
  int max_map_size() const { return renderer_->info().max_map_size; }

  /// The first light's records; untimed. Error: error() where it is not ready.
  Expected<raster::RasterFrame> draw(const raster::RasterOptions& options);

 private:
  Scene scene_;
  World world_;
  bool has_context_ = false;
  std::unique_ptr<raster::Renderer> renderer_;
  Error error_{ErrorKind::graphics, {}};
};

raster::RasterOptions drawing(ImageSize size, int map_size, double bias_world);

/// The ray through a pixel's centre, worked out from the camera alone.
Ray eye_ray(const Camera& camera, ImageSize size, int x, int y);

/// Distance along the ray to the plane y = height; infinite where it is not met.
double to_level(const Ray& ray, double height);

/// The row of a world that is not ready: skipped where the machine has no context, and else wrong.
void add_row_of_undrawn(Run& run, const DrawnWorld& world, const std::string& row);

}  // namespace gnomon::verify
