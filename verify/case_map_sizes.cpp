// Orthographic against perspective maps, and pictures of extreme sizes. The oracle of the first is the closed
// form of a plane's gap under a sun; of the second, rays cast by hand.
#include "verify/cases.h"
#include "verify/drawn_world.h"

namespace gnomon::verify {

// A lamp that recedes along the light's direction, its cone narrowed so that its texels keep their width on
// the floor. The bias that leaves no acne must come to that of a sun, a + b = h (|dz/du| + |dz/dv|), in the
// same world units.
void bias_convergence(Run& run) {
  const Vec3 towards = glm::normalize(Vec3(0.5, 1.0, 0.3));
  constexpr double reach = 3.0;  // of the cone around the origin
  constexpr int size = 256;
  Scene scene = scene_of({}, {plane({0, 0, 0}, {0, 1, 0})});
  Light lamp = point_light({0, 0, 0});
  lamp.type = LightType::spot, lamp.direction = -towards;
  scene.lights = {lamp};
  scene.camera.eye = {0.0, 6.0, 0.01}, scene.camera.vertical_fov = 0.6;
  DrawnWorld drawn(std::move(scene));
  if (!drawn.ready()) return add_row_of_undrawn(run, drawn, "lamp against sun");
  for (const double distance : {10.0, 100.0, 1000.0}) {
    Light& light = drawn.scene().lights[0];
    light.position = distance * towards;
    light.outer_angle = std::atan(reach / distance), light.inner_angle = 0.5 * light.outer_angle;
    const auto frame = drawn.draw(drawing({320, 320}, size, 0.0));
    if (!frame) return run.fault("lamp against sun", frame.error().message());
    const LightFace& face = frame->lights[0].map.view.face(0);
    const Vec3 up(0, 1, 0);  // the floor's normal
    const double half_texel = face.half_extent.x * distance / size;
    const double sum = half_texel * (std::abs(glm::dot(up, face.right)) + std::abs(glm::dot(up, face.up))) /
                       std::abs(glm::dot(up, face.forward));
    double most = 0.0;
    std::uint64_t seen = 0;
    for (const float gap : frame->lights[0].gap.data)
      if (gap > -infinity) most = std::max(most, double(gap)), ++seen;
    // Off the axis the lamp's texels are wider by the depth there. That is at most by the cone's reach over its
    // distance, as seen on a floor that leans by less than one to two.
    run.sample_each(
        "bias without acne, lamp " + std::to_string(static_cast<int>(distance)) + " away", seen,
        [&](std::uint64_t, Tally& tally) { tally.check(true), tally.error(std::abs(most / sum - 1.0)); },
        "of the sun's bias", 3.0 * reach / distance + 0.02);
  }
}

namespace {

/// A floor with a box on it: what the ray through a pixel meets, by hand.
bool meets_floor_beside_box(const Ray& ray, Vec3& place) {
  const double t = to_level(ray, 0.0);
  if (!(t < infinity)) return false;
  place = ray.at(t);
  return std::abs(place.x) < 7.9 && std::abs(place.z) < 7.9;
}

}  // namespace

void image_sizes(Run& run) {
  Scene scene =
      scene_of({quad({-8, 0, -8}, {0, 0, 16}, {16, 0, 0}), quad({-1, 2, -1}, {0, 0, 2}, {2, 0, 0})});
  scene.lights = {sun({0.35, -1.0, 0.2})};
  scene.camera.eye = {0.3, 1.2, 6.0}, scene.camera.target = {0.0, 0.0, 0.5}, scene.camera.vertical_fov = 1.0;
  DrawnWorld drawn(std::move(scene));
  if (!drawn.ready()) return add_row_of_undrawn(run, drawn, "sizes of the picture");
  const int longest = drawn.max_map_size();
  const Vec3 d = drawn.scene().lights[0].direction;
  for (const ImageSize size : {ImageSize{1, 1}, ImageSize{longest, 1}, ImageSize{1, longest}}) {
    // So that a strip shows what a picture would: its field of view is the angle of one pixel of it.
    drawn.scene().camera.vertical_fov =
        size.width > size.height ? 2.0 * std::atan(std::tan(0.5) / size.width) : 1.0;
    raster::RasterOptions options = drawing(size, 256, 0.0);
    options.map.bias.adaptive = true;  // the texels of a strip's map are long and thin
    const auto frame = drawn.draw(options);
    const std::string name = std::to_string(size.width) + " x " + std::to_string(size.height);
    if (!frame) {
      run.fault(name, frame.error().message());
      continue;
    }
    run.sample_each(name, size.pixels(), [&](std::uint64_t i, Tally& tally) {
      const int x = static_cast<int>(i) % size.width, y = static_cast<int>(i) / size.width;
      Vec3 p;
      const Ray ray = eye_ray(drawn.scene().camera, size, x, y);
      if (!meets_floor_beside_box(ray, p)) return;
      const Vec3 plate = ray.at(to_level(ray, 2.0));
      if (ray.direction.y > 0.0 && std::max(std::abs(plate.x), std::abs(plate.z)) < 1.0) return;
      const Vec3 over = p - d * (2.0 / -d.y);
      const double reach = std::max(std::abs(over.x), std::abs(over.z));
      if (std::abs(reach - 1.0) < 0.2) return;  // within some texels of the outline
      const bool drawn_lit = frame->lights[0].visibility.data[i] > 0.5f;
      tally.check(frame->primitive.data[i] <= 1 && drawn_lit == (reach > 1.0));
    });
  }
  const std::array beyond{ImageSize{longest + 1, 1}, ImageSize{1, longest + 1},
                          ImageSize{longest + 1, longest + 1}};
  run.sample_each("one pixel more: refused", beyond.size(), [&](std::uint64_t i, Tally& tally) {
    const auto frame = drawn.draw(drawing(beyond[i], 16, 1e-3));
    tally.check(!frame && frame.error().kind == ErrorKind::graphics);
  });
  run.sample_each("a map of one texel more: refused", 1, [&](std::uint64_t, Tally& tally) {
    const auto frame = drawn.draw(drawing({16, 16}, longest + 1, 1e-3));
    tally.check(!frame && frame.error().kind == ErrorKind::graphics);
  });
}

}  // namespace gnomon::verify
