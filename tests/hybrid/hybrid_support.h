// A scene on stage for the hybrid's tests: its world, tracer, topology, and the truth by pure ray tracing.
#pragma once

#include <gtest/gtest.h>

#include <iostream>
#include <memory>
#include <optional>

#include "hybrid/hard_shadows.h"
#include "raytrace/frame.h"
#include "tests/support/places.h"
#include "tests/support/raytrace_support.h"

namespace gnomon::test {

struct Stage {
  /// `keep_sizes`: of the lights; else each is shrunk to its centre.
  Stage(Scene s, ImageSize image_size, bool keep_sizes = false)
      : scene(std::move(s)),
        world(make_world(scene)),
        tracer(world, raytrace::Accel::bvh),
        topology(world),
        size(image_size) {
    std::vector<std::uint32_t> lights(scene.lights.size());
    for (std::uint32_t i = 0; i < lights.size(); ++i) {
      lights[i] = i;
      if (!keep_sizes) scene.lights[i].extent = {};
    }
    raytrace::RaytraceOptions options;
    options.size = size, options.picture = false, options.seed = 5;
    frame = trace_frame(tracer, plan_effects(scene), scene.camera, lights, options);
  }
  LightView map(std::uint32_t light, int map_size) const {
    return fit_light_view(world, scene.lights[light], scene.camera, double(size.width) / size.height,
                          map_size)
        .value();
  }

  Scene scene;
  World world;
  raytrace::Tracer tracer;
  raytrace::Topology topology;
  ImageSize size;
  raytrace::RayTracedFrame frame;
};

struct Outcome {
  hybrid::ShadowCounts counts;
  std::uint64_t different = 0;  ///< from the ray tracer's answers, where those are certain
  double ray_share() const {
    return counts.asked > 0 ? static_cast<double>(counts.rays) / static_cast<double>(counts.asked) : 0.0;
  }
};

/// The hard-shadow pass against the ray tracer's frame, whose receivers these are.
inline Outcome compare_pass(const Stage& stage, std::uint32_t light, hybrid::LightCache& cache) {
  Image<raytrace::PointVisibility> visibility;
  Image<hybrid::Decision> decisions(stage.size);
  Outcome out;
  out.counts = trace_hard_shadows(stage.tracer, cache, raytrace::make_receivers(stage.frame.receiver),
                                  visibility, &decisions);
  for (std::size_t i = 0; i < visibility.data.size(); ++i) {
    const raytrace::PointVisibility truth = stage.frame.lights[light].centre.data[i];
    const bool traced = decisions.data[i] == hybrid::Decision::traced;
    const bool differs =
        truth != visibility.data[i] && (truth != raytrace::PointVisibility::uncertain || traced);
    if (differs && out.different == 0)
      ADD_FAILURE() << stage.scene.name << " light " << light << " map " << cache.sheets.view().size
                    << " pixel " << i % static_cast<std::size_t>(stage.size.width) << ","
                    << i / static_cast<std::size_t>(stage.size.width) << ": decision "
                    << static_cast<int>(decisions.data[i]) << ", found "
                    << static_cast<int>(visibility.data[i]) << ", traced " << static_cast<int>(truth);
    out.different += differs ? 1 : 0;
  }
  EXPECT_EQ(out.counts.lit + out.counts.shadowed + out.counts.rays, out.counts.asked);
  return out;
}

inline Outcome run(const Stage& stage, std::uint32_t light, int map_size) {
  hybrid::LightCache cache(stage.tracer, stage.topology, stage.scene.lights[light],
                           stage.map(light, map_size));
  const Outcome out = compare_pass(stage, light, cache);
  std::cout << stage.scene.name << " light " << light << " map " << map_size << ": "
            << 100.0 * out.ray_share() << " % rays, build " << cache.build_ms() << " + "
            << cache.sheets.stats().refine_ms << " ms, " << cache.bytes() / 1024 << " KiB\n";
  return out;
}

/// A model of ../shared/data over a ground, with a point light, a sun and a spot; null where it is absent.
inline std::unique_ptr<Stage> model_stage(const std::string& file, ImageSize size, bool soft = false) {
  auto mesh = read_obj(gnomon::test::shared_data() + file);
  if (!mesh) return nullptr;
  Mesh model = normalised(std::move(*mesh));
  double low = infinity;
  for (const Vec3& p : model.positions) low = std::min(low, p.y);
  Scene scene = scene_of({std::move(model), quad({-1, low, -1}, {0, 0, 2}, {2, 0, 0})});
  scene.name = file;
  Light spot = point_light({0.7, 1.2, 0.9});
  spot.type = LightType::spot, spot.outer_angle = 0.6;
  spot.direction = glm::normalize(Vec3(-0.7, -1.2, -0.9));
  scene.lights = {point_light({0.7, 1.2, 0.9}), sun(glm::normalize(Vec3(-0.5, -1, -0.4))), spot};
  if (soft) {
    scene.lights.resize(1);
    scene.lights[0].extent = DiscLight{0.08, glm::normalize(Vec3(-0.7, -1.2, -0.9))};
    scene.lights[0].shadow_samples = 16;
  }
  scene.camera.eye = {0.25, 0.375, 1.25}, scene.camera.target = {0, 0, 0};
  return std::make_unique<Stage>(std::move(scene), size, soft);
}

}  // namespace gnomon::test
