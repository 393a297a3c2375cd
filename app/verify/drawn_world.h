// What the cases of the depth map work with: a small world drawn by the rasterizer, where there is a context.
#pragma once

#include <memory>

#include "app/verify/run.h"
#include "app/verify/small_world.h"
#include "raster/renderer.h"

namespace gnomon::verify {

/// A world and its rasterizer.
class DrawnWorld {
 public:
  /// Why there is none stands in error().
  explicit DrawnWorld(Scene scene);
  bool ready() const { return renderer_ != nullptr; }
  const Error& error() const { return error_; }
  const World& world() const { return world_; }
  /// Camera and lights may change between drawings.
  Scene& scene() { return scene_; }
  int max_map_size() const { return renderer_->info().max_map_size; }

  /// The first light's records; untimed.
  Expected<raster::RasterFrame> draw(const raster::RasterOptions& options);

 private:
  Scene scene_;
  World world_;
  std::unique_ptr<raster::Renderer> renderer_;
  Error error_{ErrorKind::graphics, {}};
};

raster::RasterOptions drawing(ImageSize size, int map_size, double bias_world);

/// The ray through a pixel's centre, worked out from the camera alone.
Ray eye_ray(const Camera& camera, ImageSize size, int x, int y);

/// Distance along the ray to the plane y = height; infinite where it is not met.
double to_level(const Ray& ray, double height);

/// A row that says that there is no context.
void skip_without_context(Run& run, const DrawnWorld& world, std::string row);

}  // namespace gnomon::verify
