#include "verify/drawn_world.h"

namespace gnomon::verify {

DrawnWorld::DrawnWorld(Scene scene) : scene_(std::move(scene)), world_(make_world(scene_)) {
  auto context = raster::create_context(raster::Backend::automatic);
  if (!context) {
    error_ = context.error();
    return;
  }
  has_context_ = true;
  auto renderer = raster::Renderer::create(std::move(*context), world_, plan_effects(scene_));
  if (renderer)
    renderer_ = std::move(*renderer);
  else
    error_ = renderer.error();
}

Expected<raster::RasterFrame> DrawnWorld::draw(const raster::RasterOptions& options) {
  if (!ready()) return fail(error_);
  const std::array<std::uint32_t, 1> first{0};
  return renderer_->render(options, first);
}

raster::RasterOptions drawing(ImageSize size, int map_size, double bias_world) {
  raster::RasterOptions options;
  options.size = size;
  options.map.size = map_size;
  options.map.bias = {bias_world, raster::BiasUnit::world};
  options.runs = 0;
  return options;
}

Ray eye_ray(const Camera& camera, ImageSize size, int x, int y) {
  const Vec3 forward = glm::normalize(camera.target - camera.eye);
  const Vec3 right = glm::normalize(glm::cross(forward, camera.up)), up = glm::cross(right, forward);
  const double tall = std::tan(0.5 * camera.vertical_fov), wide = tall * size.width / size.height;
  const double sx = (2 * x + 1) / double(size.width) - 1.0, sy = 1.0 - (2 * y + 1) / double(size.height);
  return {camera.eye, forward + sx * wide * right + sy * tall * up};
}

double to_level(const Ray& ray, double height) {
  const double t = (height - ray.origin.y) / ray.direction.y;
  return t > 0.0 ? t : infinity;
}

void add_row_of_undrawn(Run& run, const DrawnWorld& world, const std::string& row) {
  const std::string why = world.error().message();
  world.has_context() ? run.fault(row, why) : run.skip(row, "no context: " + why);
}

}  // namespace gnomon::verify
