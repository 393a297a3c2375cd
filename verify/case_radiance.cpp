// Radiance that is not a number must not leave the picture, and must be counted.
#include "raytrace/frame.h"
#include "verify/cases.h"
#include "verify/small_world.h"

namespace gnomon::verify {

void non_finite_radiance(Run& run) {
  // A floor that glows as brightly as a float can say, under a sun as bright. Their sum is infinite wherever
  // the sun shines, and what a rough mirror beside it gathers of that would be NaN.
  constexpr float brightest = 3e38f;
  Scene scene = scene_of({quad({-6, 0, -6}, {0, 0, 12}, {12, 0, 0}), box({-2, 0, -2}, {-1, 3, -1})},
                         {sphere({1.5, 1.0, 0.0}, 1.0)});
  scene.materials.resize(2);
  scene.materials[0].diffuse = Vec3f(1.0f), scene.materials[0].emission = Vec3f(brightest);
  scene.materials[1].mirror = 0.9f, scene.materials[1].roughness = 0.4f;
  scene.shapes[0].material = 1;
  scene.instances[1].material = 1;
  scene.lights = {sun({1.0, -2.0, 0.5}), point_light({0.0, 0.0, 0.0})};  // the second lies in the floor
  scene.lights[0].intensity = scene.lights[1].intensity = Vec3f(brightest);
  scene.background = Vec3f(0.5f);
  scene.camera.eye = {0.0, 4.0, 9.0}, scene.camera.target = {0.0, 0.5, 0.0};
  scene.glossy_samples = 4;
  const SmallWorld w(scene);
  raytrace::RaytraceOptions options;
  const int side = static_cast<int>(std::sqrt(static_cast<double>(run.rays(0.05, 250'000))));
  options.size = {side, side};
  const std::vector<std::uint32_t> lights{0, 1};
  const auto frame =
      trace_frame(run.tracer(w.world()), plan_effects(w.scene()), scene.camera, lights, options);
  std::uint64_t infinite_floor = 0;
  run.sample_each("finite pixels", frame.color.data.size(), [&](std::uint64_t i, Tally& tally) {
    const Vec3f c = frame.color.data[i];
    const auto& point = frame.receiver.data[i];
    const bool too_bright = point.primitive != no_id && w.world().object_of(point.primitive) == 0 &&
                            frame.lights[0].centre.data[i] == raytrace::PointVisibility::lit;
    infinite_floor += too_bright ? 1 : 0;
    // Without the check these would be infinite: the textbook's picture.
    if (run.is_textbook()) return tally.check(!too_bright);
    tally.check(std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z) &&
                (!too_bright || c == Vec3f(0.0f)));
  });
  run.sample_each("counted", 1, [&](std::uint64_t, Tally& tally) {
    tally.check(infinite_floor > 0 && frame.non_finite >= infinite_floor && !run.is_textbook());
  });
}

}  // namespace gnomon::verify
