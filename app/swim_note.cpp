#include "app/swim_note.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "raster/technique_traits.h"
#include "scene/light_map/light_view.h"

namespace gnomon::app {

namespace {

/// The camera a hundredth of its distance to the right.
Camera moved_aside(Camera camera) {
  const Vec3 ahead = camera.target - camera.eye;
  const Vec3 right = glm::cross(ahead, camera.up);
  const double length = glm::length(right);
  const Vec3 step = length > 0.0 ? right * (0.01 * glm::length(ahead) / length) : Vec3(0.0);
  camera.eye += step, camera.target += step;
  return camera;
}

bool swims(const World& world, const Light& light, const raster::MapOptions& map, double aspect) {
  if (light.type != LightType::directional) return false;     // its map stays with the light
  if (!raster::compares_depths(map.technique)) return false;  // whatever the map, the answer is the same
  if (map.snap) return false;                                 // it stands still between steps
  switch (raster::traits_of(map.technique).texels) {
    case raster::TexelShape::cascades:
      return !map.cascades.snap || map.cascades.fit_samples;
    case raster::TexelShape::warped:
      return true;
    case raster::TexelShape::of_light:
      break;
  }
  const Camera& camera = world.scene->camera;
  return window_moves(world, light, {camera, moved_aside(camera)}, aspect, map.size, map.window);
}

/// What moves by whole texels in its place.
const char* way_out(const raster::MapOptions& map) {
  switch (raster::traits_of(map.technique).texels) {
    case raster::TexelShape::cascades:
      return "without --no-snap and --cascade-fit it moves by whole texels";
    case raster::TexelShape::warped:
      return "--technique csm moves by whole texels";
    case raster::TexelShape::of_light:
      break;
  }
  return "--technique csm moves by whole texels, and so does this map with --snap";
}

}  // namespace

std::string swim_note(const World& world, const raster::MapOptions& map, ImageSize size,
                      std::span<const std::uint32_t> lights) {
  std::vector<std::string> names;
  for (const std::uint32_t index : lights) {
    const Light& light = world.scene->lights[index];
    if (swims(world, light, map, double(size.width) / size.height)) names.push_back(light.name);
  }
  if (names.empty()) return {};
  return fmt::format(
      "The map of {} follows the camera by parts of a texel ({}): its shadow edges swim when the camera "
      "moves; {}.",
      fmt::join(names, ", "), raster::technique_name(map.technique), way_out(map));
}

}  // namespace gnomon::app
