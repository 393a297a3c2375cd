#include "studies/sweep/ray_points.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "scene/files/path_status.h"
#include "scene/files/read_file.h"
#include "scene/light.h"

namespace gnomon::studies {
namespace {

using compare::Json;

using Json = nlohmann::ordered_json;
using raytrace::PointVisibility;
using raytrace::Precision;
using raytrace::RayTracedFrame;
using raytrace::Tracer;

constexpr std::size_t counted_pixels = 20000;  // whose rays are traced once more for what they test

class Measurer {
 public:
  Measurer(const World& world, raytrace::Accel accel, const std::vector<std::uint32_t>& lights,
           const raytrace::RaytraceOptions& options)
      : world_(world), accel_(accel), lights_(lights), options_(options), plan_(plan_effects(*world.scene)) {
    options_.picture = false;
  }

  std::vector<RayPoint> measure() {
    const Scene& scene = *world_.scene;
    const bool soft = std::any_of(lights_.begin(), lights_.end(),
                                  [&](std::uint32_t light) { return has_size(scene.lights[light]); });
    reference_ = trace(Tracer(world_, accel_, Precision::exact), reference_samples, 1);
    std::vector<RayPoint> points;
    for (const Precision precision : {Precision::fast, Precision::robust, Precision::exact}) {
      const Tracer tracer(world_, accel_, precision);
      const std::string name(precision_name(precision));
      if (!soft) points.push_back(point(tracer, name, 0));
      for (const int samples : {1, 4, 16, 64})
        if (soft && (precision == Precision::robust || samples == 16))
          points.push_back(point(tracer, fmt::format("{}, {} samples", name, samples), samples));
    }
    return points;
  }

 private:
  RayTracedFrame trace(const Tracer& tracer, int samples, int runs) const {
    raytrace::RaytraceOptions options = options_;
    options.shadow_samples = samples;
    options.runs = runs;
    return trace_frame(tracer, plan_, world_.scene->camera, lights_, options);
  }

  RayPoint point(const Tracer& tracer, std::string name, int samples) const {
    const RayTracedFrame frame = trace(tracer, samples, std::max(1, options_.runs));
    RayPoint out;
    out.name = std::move(name);
    out.times = frame.primary_rays;
    out.shadow_times.runs.assign(out.times.runs.size(), 0.0);
    out.rays = frame.rays.primary;
    out.bytes = tracer.stats().bytes;
    double absolute = 0.0;
    for (std::size_t i = 0; i < frame.lights.size(); ++i) {
      add_times(frame.lights[i].exact_times(), out.times);
      add_times(frame.lights[i].exact_times(), out.shadow_times);
      out.rays += frame.lights[i].exact_rays();
      absolute += compare_light(frame, i, out);
    }
    out.mean_absolute = absolute / static_cast<double>(std::max<std::uint64_t>(out.compared, 1));
    count_tests(tracer, frame, out);
    return out;
  }

  static void add_times(const Times& more, Times& sum) {
    for (std::size_t run = 0; run < std::min(more.runs.size(), sum.runs.size()); ++run)
      sum.runs[run] += more.runs[run];
  }

  // The sum of the visibilities' differences.
  double compare_light(const RayTracedFrame& frame, std::size_t i, RayPoint& out) const {
    const raytrace::LightTruth &found = frame.lights[i], &truth = reference_.lights[i];
    const Light& light = world_.scene->lights[found.light];
    double absolute = 0.0;
    for (std::size_t p = 0; p < reference_.receiver.data.size(); ++p) {
      const auto &seen = frame.receiver.data[p], &right = reference_.receiver.data[p];
      if (right.primitive == no_id || light_cannot_reach(light, right.position, right.normal)) continue;
      if (truth.centre.data[p] == PointVisibility::uncertain) continue;
      ++out.compared;
      if (found.centre.data[p] == PointVisibility::uncertain) {
        ++out.uncertain;
        continue;
      }
      const double difference = std::abs(visibility(found, p) - visibility(truth, p));
      absolute += difference;
      out.wrong += seen.primitive != right.primitive || difference > 0.5 ? 1 : 0;
    }
    return absolute;
  }

  static double visibility(const raytrace::LightTruth& light, std::size_t pixel) {
    if (!light.visibility.data.empty()) return double{light.visibility.data[pixel]};
    return light.centre.data[pixel] == PointVisibility::lit ? 1.0 : 0.0;
  }

  void count_tests(const Tracer& tracer, const RayTracedFrame& frame, RayPoint& out) const {
    const View view = make_view(world_.scene->camera, options_.size);
    const std::size_t pixels = frame.receiver.data.size();
    const auto width = static_cast<std::size_t>(options_.size.width);
    raytrace::WorkCounts work;
    std::uint64_t rays = 0;
    for (std::size_t p = 0; p < pixels; p += 1 + pixels / counted_pixels) {
      const std::size_t x = p % width, y = p / width;
      (void)tracer.closest_seen(pixel_ray(view, double(x) + 0.5, double(y) + 0.5), work);
      ++rays;
      const raytrace::SurfacePoint& receiver = frame.receiver.data[p];
      if (receiver.primitive == no_id) continue;
      for (const std::uint32_t index : lights_) {
        const Light& light = world_.scene->lights[index];
        if (light_cannot_reach(light, receiver.position, receiver.normal)) continue;
        (void)tracer.occluded(tracer.shadow_ray(receiver, light), work);
        ++rays;
      }
    }
    out.boxes_per_ray = double(work.boxes) / double(std::max<std::uint64_t>(rays, 1));
    out.primitives_per_ray = double(work.primitives) / double(std::max<std::uint64_t>(rays, 1));
  }

  const World& world_;
  raytrace::Accel accel_;
  const std::vector<std::uint32_t>& lights_;
  raytrace::RaytraceOptions options_;
  EffectPlan plan_;
  RayTracedFrame reference_;
};

}  // namespace

std::vector<RayPoint> measure_ray_points(const World& world, raytrace::Accel accel,
                                         const std::vector<std::uint32_t>& lights,
                                         const raytrace::RaytraceOptions& options) {
  return Measurer(world, accel, lights, options).measure();
}

std::string ray_points_path(const std::string& folder) {
  return fmt::format("{}/{}", folder, ray_points_name);
}

std::string ray_points_json(const std::vector<RayPoint>& points) {
  Json json = Json::array();
  for (const RayPoint& p : points)
    json.push_back({{"name", p.name},
                    {"compared", p.compared},
                    {"wrong", p.wrong},
                    {"uncertain", p.uncertain},
                    {"mean_absolute", p.mean_absolute},
                    {"times_ms", {{"median", p.times.median()}, {"runs", p.times.runs}}},
                    {"shadow_times_ms", {{"median", p.shadow_times.median()}, {"runs", p.shadow_times.runs}}},
                    {"rays", p.rays},
                    {"boxes_per_ray", p.boxes_per_ray},
                    {"primitives_per_ray", p.primitives_per_ray},
                    {"bytes", p.bytes}});
  return Json{{"schema", "gnomon/rays/1"}, {"points", json}}.dump(1) + "\n";
}

Expected<std::vector<RayPoint>> read_ray_points(const std::string& folder) {
  std::vector<RayPoint> points;
  const auto there = is_there(ray_points_path(folder));
  if (!there) return fail(there.error());
  if (!*there) return points;
  const auto text = read_file(ray_points_path(folder));
  if (!text) return fail(text.error());
  try {
    const Json whole = Json::parse(*text);
    for (const Json& json : whole.at("points")) {
      RayPoint& p = points.emplace_back();
      p.name = json.at("name").get<std::string>();
      p.compared = json.at("compared").get<std::uint64_t>();
      p.wrong = json.at("wrong").get<std::uint64_t>();
      p.uncertain = json.at("uncertain").get<std::uint64_t>();
      p.mean_absolute = json.at("mean_absolute").get<double>();
      p.times.runs = json.at("times_ms").at("runs").get<std::vector<double>>();
      if (json.contains("shadow_times_ms"))  // sweeps made before have none
        p.shadow_times.runs = json.at("shadow_times_ms").at("runs").get<std::vector<double>>();
      p.rays = json.at("rays").get<std::uint64_t>();
      p.boxes_per_ray = json.at("boxes_per_ray").get<double>();
      p.primitives_per_ray = json.at("primitives_per_ray").get<double>();
      p.bytes = json.at("bytes").get<std::uint64_t>();
    }
  } catch (const Json::exception& error) {
    return fail(Error{ErrorKind::bad_input, std::string("not the ray tracer's points: ") + error.what(),
                      ray_points_path(folder)});
  }
  return points;
}

}  // namespace gnomon::studies
