// Packets of floats against the double kernels: what trace_frame stores must be theirs bit for bit, for every
// instruction set that this machine has. The reference is made here, one ray at a time.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <tuple>
#include <vector>

#include "raytrace/frame.h"
#include "raytrace/packets/edge_setup.h"
#include "raytrace/packets/shadow_pass.h"
#include "raytrace/tiles.h"
#include "scene/light.h"
#include "tests/support/every_target.h"
#include "tests/support/raytrace_support.h"

namespace gnomon::test {

using raytrace::Accel;
using raytrace::PointVisibility;
using raytrace::SurfacePoint;
using raytrace::Tracer;

struct Reference {
  std::vector<SurfacePoint> receivers;
  std::vector<std::vector<PointVisibility>> visibility;
};

inline PointVisibility visibility_of(const Tracer& tracer, const Light& light, const SurfacePoint& point) {
  if (point.primitive == no_id) return PointVisibility::lit;
  if (light_cannot_reach(light, point.position, point.normal)) return PointVisibility::shadowed;
  return tracer.centre_visibility(point, light);
}

inline Reference reference_of(const Tracer& tracer, const Scene& scene, ImageSize size) {
  const View view = make_view(scene.camera, size);
  Reference r;
  r.visibility.resize(scene.lights.size());
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const Ray ray = pixel_ray(view, x + 0.5, y + 0.5);
      const auto hit = tracer.closest_seen(ray);
      r.receivers.push_back(hit ? tracer.surface_point(ray, *hit) : SurfacePoint{});
      for (std::size_t i = 0; i < scene.lights.size(); ++i)
        r.visibility[i].push_back(visibility_of(tracer, scene.lights[i], r.receivers.back()));
    }
  return r;
}

inline bool same_bits(const Vec3& a, const Vec3& b) {
  using Bits = std::array<std::uint64_t, 3>;
  return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
}

inline bool same_point(const SurfacePoint& a, const SurfacePoint& b) {
  if (a.primitive != b.primitive) return false;
  return a.primitive == no_id ||
         (same_bits(a.position, b.position) && same_bits(a.position_error, b.position_error) &&
          same_bits(a.normal, b.normal) && same_bits(Vec3(a.barycentric, 0.0), Vec3(b.barycentric, 0.0)));
}

inline void expect_same(const Scene& scene, const Tracer& tracer, const Reference& reference,
                        ImageSize size) {
  std::vector<std::uint32_t> lights(scene.lights.size());
  for (std::uint32_t i = 0; i < lights.size(); ++i) lights[i] = i;
  raytrace::RaytraceOptions options;
  options.size = size, options.picture = false;
  const auto frame = trace_frame(tracer, plan_effects(scene), scene.camera, lights, options);
  std::size_t points = 0;
  for (std::size_t i = 0; i < reference.receivers.size(); ++i)
    points += same_point(frame.receiver.data[i], reference.receivers[i]) ? 0 : 1;
  EXPECT_EQ(points, 0U) << "receivers differ, " << raytrace::packet_target();
  for (std::size_t l = 0; l < lights.size(); ++l) {
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < reference.receivers.size(); ++i)
      wrong += frame.lights[l].centre.data[i] == reference.visibility[l][i] ? 0 : 1;
    EXPECT_EQ(wrong, 0U) << "visibility of light " << l << " differ, " << raytrace::packet_target();
  }
}

/// Expects the same visibility where a tile's receivers are kept as floats alone, and the same receivers in double.
inline void expect_same_by_floats(const Scene& scene, const Tracer& tracer, const Reference& reference,
                                  ImageSize size) {
  const View view = make_view(scene.camera, size);
  if (!blocks_apply(tracer, view)) return;
  const raytrace::EdgeSetup eye = edge_setup_of_eye(tracer, view);
  const raytrace::TileGrid grid{size};
  std::vector<raytrace::TileHits> hits(grid.count());
  raytrace::HugeArray<raytrace::QuantisedTile> tiles(grid.count());
  SurfacePoint unwritten;
  unwritten.primitive = 0;  // the pass writes the background, too
  Image<SurfacePoint> receivers(size, unwritten);
  primary_pass(tracer, view, eye, {.size = size, .hits = hits, .receivers = &receivers, .quantised = {}});
  std::size_t points = 0;
  for (std::size_t i = 0; i < receivers.data.size(); ++i)
    points += same_point(receivers.data[i], reference.receivers[i]) ? 0 : 1;
  EXPECT_EQ(points, 0U) << "receivers differ, " << raytrace::packet_target();
  primary_pass(tracer, view, eye,
               {.size = size, .hits = hits, .receivers = nullptr, .quantised = {tiles.data(), tiles.size()}});
  using raytrace::PacketUse;
  for (std::size_t l = 0; l < scene.lights.size(); ++l) {
    std::map<PacketUse, raytrace::ShadowRayCounts> counts;
    for (const PacketUse packets : {PacketUse::where_cheaper, PacketUse::always, PacketUse::never}) {
      Image<PointVisibility> visibility(size, PointVisibility::lit);
      counts[packets] = shadow_pass({.tracer = tracer,
                                     .size = size,
                                     .stored = nullptr,
                                     .view = &view,
                                     .hits = hits,
                                     .quantised = {tiles.data(), tiles.size()},
                                     .packets = packets},
                                    scene.lights[l], visibility);
      std::size_t wrong = 0;
      for (std::size_t i = 0; i < visibility.data.size(); ++i)
        wrong += visibility.data[i] == reference.visibility[l][i] ? 0 : 1;
      EXPECT_EQ(wrong, 0U) << "visibility of light " << l << " by floats differ, "
                           << raytrace::packet_target();
    }
    const auto& [chosen, by_packets, one_by_one] =
        std::tie(counts[PacketUse::where_cheaper], counts[PacketUse::always], counts[PacketUse::never]);
    EXPECT_EQ(chosen.cast, by_packets.cast);
    EXPECT_EQ(chosen.cast, one_by_one.cast);
    EXPECT_EQ(one_by_one.single, one_by_one.cast);
    EXPECT_LE(by_packets.single, chosen.single);
  }
}

inline void check(const Scene& scene, ImageSize size) {
  const TestWorld w(scene);
  const Tracer tracer(w.world(), Accel::bvh);
  const Reference reference = reference_of(tracer, w.scene(), size);
  for_each_target([&] {
    expect_same(w.scene(), tracer, reference, size);
    expect_same_by_floats(w.scene(), tracer, reference, size);
  });
}

inline void look(Scene& scene, const Vec3& eye, const Vec3& target, double fov = 0.8) {
  scene.camera.eye = eye, scene.camera.target = target, scene.camera.vertical_fov = fov;
  scene.camera.up = {0.1, 1, 0.05};
}

inline std::vector<Light> lights_around(const Vec3& center, double distance) {
  return {point_light(center + distance * Vec3(1.5, 2.0, 0.7)), sun({-0.3, -1.0, -0.2}), sun({0, -1, 0}),
          point_light(center + distance * Vec3(0.0, 0.3, 0.0))};
}

}  // namespace gnomon::test
