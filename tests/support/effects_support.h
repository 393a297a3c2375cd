// Small pictures for the tests of the ray tracer's effects.
#pragma once

#include "raytrace/frame.h"
#include "tests/support/raytrace_support.h"

namespace gnomon::test {

/// All lights, bvh, robust; min_contribution 0, so that what is tested is the physics, and as many samples
/// per pixel as the camera asks for.
inline raytrace::RayTracedFrame trace_picture(const Scene& scene, ImageSize size = {1, 1},
                                              std::uint64_t seed = 0, bool records = true) {
  const TestWorld w(scene);
  std::vector<std::uint32_t> lights(scene.lights.size());
  for (std::uint32_t i = 0; i < lights.size(); ++i) lights[i] = i;
  raytrace::RaytraceOptions options;
  options.size = size, options.seed = seed, options.min_contribution = 0.0, options.records = records;
  options.samples_per_pixel = scene.camera.samples_per_pixel;
  const raytrace::Tracer tracer(w.world(), raytrace::Accel::bvh);
  return trace_frame(tracer, plan_effects(w.scene()), scene.camera, lights, options);
}

inline Material glass_of(float ior, int priority = 0) {
  Material m;
  m.name = "glass", m.diffuse = Vec3f(0.0f), m.transmission = 1.0f, m.ior = ior, m.priority = priority;
  return m;
}
inline Material mirror_of(float share, float roughness = 0.0f) {
  Material m;
  m.name = "mirror", m.diffuse = Vec3f(0.0f), m.mirror = share, m.roughness = roughness;
  return m;
}

/// A narrow view along -z from a height: every pixel of it sees nearly the same.
inline Camera straight_down_z(double from) {
  Camera camera;
  camera.eye = {0.0, 0.0, from}, camera.target = {0.0, 0.0, 0.0}, camera.vertical_fov = 1e-6;
  return camera;
}

}  // namespace gnomon::test
