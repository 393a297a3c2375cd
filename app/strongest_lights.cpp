#include "app/strongest_lights.h"

#include <fmt/core.h>

#include <algorithm>
#include <numeric>

#include "app/options/option_kinds.h"
#include "raytrace/frame.h"
#include "scene/base/stages.h"
#include "scene/light.h"

namespace gnomon::app {
namespace {

constexpr ImageSize grid{64, 36};  // a light that reaches a 2,000th of the picture meets one of these points

/// Once it is posed; the given one where the pose will be refused.
Camera posed_by(PoseOptions poses, const Camera& given, const World& world) {
  poses.light_azimuth = poses.light_elevation = poses.light_distance = poses.light_size = std::nullopt;
  Scene posed;
  posed.camera = given;
  return apply_poses(poses, {}, posed, world) ? posed.camera : given;
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

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
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

std::vector<std::uint32_t> strongest_lights(const LoadedScene& loaded, const std::vector<Light>& lights,
                                            const Camera& camera, std::size_t count) {
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

LightSelection::LightSelection(const LoadedScene& loaded, int max_lights)
    : loaded_(loaded),
      most_(static_cast<std::size_t>(max_lights)),
      camera_(loaded.scene->camera),
      lights_(loaded.scene->lights) {}

bool LightSelection::leaves_out(const std::vector<std::string>& named) const {
  return lights_.size() > most_ && std::all_of(named.begin(), named.end(), [this](const std::string& name) {
           return std::any_of(lights_.begin(), lights_.end(),
                              [&name](const Light& light) { return light.name == name; });
         });
}

std::vector<Light> LightSelection::kept(const std::vector<std::string>& named, const PoseOptions& poses) {
  if (!leaves_out(named)) return lights_;
  const Camera camera = posed_by(poses, camera_, *loaded_.world);
  if (seen_by_ != camera) {
    strongest_ = strongest_lights(loaded_, lights_, camera, most_);
    seen_by_ = camera;
  }
  std::vector<Light> kept;
  for (std::uint32_t i = 0; i < lights_.size(); ++i)
    if (std::binary_search(strongest_.begin(), strongest_.end(), i) || holds(named, lights_[i].name))
      kept.push_back(lights_[i]);
  return kept;
}

std::string LightSelection::note(const std::vector<std::string>& named) const {
  return fmt::format(
      "the scene has {} lights: the {} that would light most of what the camera sees are used{}, no other "
      "(--light NAME takes another one in, --max-lights N more)",
      lights_.size(), most_, named.empty() ? "" : " and those named");
}

void keep_strongest_lights(LoadedScene& loaded, int max_lights, const std::vector<std::string>& named,
                           const PoseOptions& poses, Console& console) {
  LightSelection selection(loaded, max_lights);
  if (!selection.leaves_out(named)) return;
  const TimedStage stage("load");
  Scene& scene = *loaded.scene;
  const std::size_t all = scene.lights.size();
  scene.lights = selection.kept(named, poses);
  loaded.lights_left_out = all - scene.lights.size();
  loaded.plan = plan_effects(scene);
  std::string note = selection.note(named);
  console.note(note);
  scene.notes.push_back(std::move(note));  // for the page and the JSON
}

}  // namespace gnomon::app
