// The same scene at the origin and 1e7 away from it. It is moved by whole numbers, so that every corner, the eye
// and the light move exactly, and the oracle is the picture at the origin.
#include "raytrace/frame.h"
#include "verify/cases.h"
#include "verify/small_world.h"

namespace gnomon::verify {

namespace {

/// Corners on multiples of 2^-20: exact at 1e7 too.
Mesh on_grid(Mesh mesh) {
  for (Vec3& p : mesh.positions) p = glm::round(p * 0x1p20) * 0x1p-20;
  return mesh;
}

Scene scene_at(const Vec3& place, Random random) {
  Scene scene = scene_of({on_grid(quad({-6, 0, -6}, {0, 0, 12}, {12, 0, 0})),
                          on_grid(soup(60, 1.5, 0.8, random)), on_grid(box({1, 0, 1}, {2, 1.5, 2}))});
  for (Mesh& mesh : scene.meshes)
    for (Vec3& p : mesh.positions) p += place;
  scene.lights = {point_light(place + Vec3(3.0, 7.0, 2.5)), sun({1.0, -2.0, 0.5})};
  scene.camera.eye = place + Vec3(0.0, 4.0, 9.0), scene.camera.target = place;
  return scene;
}

}  // namespace

void far_from_origin(Run& run) {
  const Vec3 place(1e7, -3e6, 2e7);
  const SmallWorld here(scene_at(Vec3(0.0), Random(run.seed()))), there(scene_at(place, Random(run.seed())));
  raytrace::RaytraceOptions options;
  options.picture = false;
  const int side = static_cast<int>(std::sqrt(static_cast<double>(run.rays(0.1, 1'000'000))));
  options.size = {side, side};
  const std::array<std::uint32_t, 2> lights{0, 1};
  const auto frame_of = [&](const SmallWorld& w) {
    return trace_frame(run.tracer(w.world()), plan_effects(w.scene()), w.scene().camera, lights, options);
  };
  const raytrace::RayTracedFrame a = frame_of(here), b = frame_of(there);
  const std::uint64_t pixels = a.receiver.data.size();
  run.sample_each("receivers", pixels, [&](std::uint64_t i, Tally& tally) {
    tally.check(a.receiver.data[i].primitive == b.receiver.data[i].primitive);
  });
  run.sample_each("shadows", 2 * pixels, [&](std::uint64_t i, Tally& tally) {
    const auto p = a.lights[i % 2].centre.data[i / 2], q = b.lights[i % 2].centre.data[i / 2];
    // Far away the points are rounded more coarsely: a visibility may become uncertain, never its opposite.
    tally.check(p == q || p == raytrace::PointVisibility::uncertain ||
                q == raytrace::PointVisibility::uncertain);
  });
}

}  // namespace gnomon::verify
