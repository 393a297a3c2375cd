#include "app/strongest_lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "app/option_kinds.h"
#include "raytrace/frame.h"
#include "scene/light.h"
#include "scene/stages.h"

namespace gnomon::app {
namespace {

constexpr ImageSize grid{64, 36};  // a light that reaches a 2,000th of the picture meets one of these points

/// Once it is posed; the scene's own where the pose will be refused.
Camera camera_of(PoseOptions poses, const LoadedScene& loaded) {
  poses.light_azimuth = poses.light_elevation = poses.light_distance = poses.light_size = std::nullopt;
  Scene posed;
  posed.camera = loaded.scene->camera;
  return apply_poses(poses, {}, posed, *loaded.world) ? posed.camera : loaded.scene->camera;
}

raytrace::RayTracedFrame receivers(const LoadedScene& loaded, const Camera& camera) {
  raytrace::RaytraceOptions options;
  options.size = grid, options.picture = false;
  const raytrace::Tracer tracer(*loaded.world, raytrace::Accel::bvh);
  return raytrace::trace_frame(tracer, loaded.plan, camera, {}, options);
}

/// Luminance (Rec. 709), unshadowed; NaN of a light at the point itself counts as nothing.
double light_given(const Light& light, const raytrace::RayTracedFrame& frame) {
  double sum = 0.0;
  for (const raytrace::SurfacePoint& point : frame.receiver.data) {
    if (point.primitive == no_id || light_cannot_reach(light, point.position, point.normal)) continue;
    const LightAtPoint at = light_at(light, point.position);
    const double luminance = 0.2126 * at.irradiance.x + 0.7152 * at.irradiance.y + 0.0722 * at.irradiance.z;
    const double received = luminance * glm::dot(point.normal, at.to_light);
    if (received > 0.0) sum += received;
  }
  return sum;
}

bool is_light(const Scene& scene, const std::string& name) {
  return std::any_of(scene.lights.begin(), scene.lights.end(),
                     [&](const Light& light) { return light.name == name; });
}

}  // namespace

void add_max_lights(CLI::App& command, int& max_lights) {
  add_integer(
      command, "--max-lights", max_lights, 1, most_max_lights, "lights",
      "of a scene with more lights only those are kept that would light most of what the camera sees, "
      "shadows left out, and those that --light names");
}

std::string max_lights_argument(int max_lights) {
  return max_lights == usual_max_lights ? std::string() : fmt::format(" --max-lights {}", max_lights);
}

std::vector<std::uint32_t> strongest_lights(const LoadedScene& loaded, const Camera& camera,
                                            std::size_t count) {
  const std::vector<Light>& lights = loaded.scene->lights;
  std::vector<std::uint32_t> order(lights.size());
  std::iota(order.begin(), order.end(), 0u);
  if (order.size() <= count) return order;
  const raytrace::RayTracedFrame frame = receivers(loaded, camera);
  std::vector<double> given(lights.size());
  std::transform(lights.begin(), lights.end(), given.begin(),
                 [&](const Light& light) { return light_given(light, frame); });
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return given[a] > given[b]; });
  order.resize(count);
  std::sort(order.begin(), order.end());
  return order;
}

void keep_strongest_lights(LoadedScene& loaded, int max_lights, const std::vector<std::string>& named,
                           const PoseOptions& poses, Console& console) {
  Scene& scene = *loaded.scene;
  const std::size_t all = scene.lights.size(), most = static_cast<std::size_t>(max_lights);
  if (all <= most) return;
  for (const std::string& name : named)
    if (!is_light(scene, name)) return;
  const TimedStage stage("load");
  std::vector<char> stays(all, 0);
  for (const std::uint32_t light : strongest_lights(loaded, camera_of(poses, loaded), most)) stays[light] = 1;
  for (std::size_t i = 0; i < all; ++i)
    if (std::find(named.begin(), named.end(), scene.lights[i].name) != named.end()) stays[i] = 1;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < all; ++i)
    if (stays[i] != 0) std::swap(scene.lights[kept++], scene.lights[i]);
  scene.lights.resize(kept);
  loaded.lights_left_out = all - kept;
  loaded.plan = plan_effects(scene);
  std::string note = fmt::format(
      "the scene has {} lights: the {} that would light most of what the camera sees are kept{}; all "
      "others are left out of everything (--light NAME takes another one in, --max-lights N more)",
      all, most, named.empty() ? "" : ", and those named");
  console.note(note);
  scene.notes.push_back(std::move(note));  // for the page and the JSON
}

}  // namespace gnomon::app
