// Where points fall on the map: behind the light, beside the map, on the borders of texels and of cube faces.
// The oracles work out places from the map's frame with arithmetic of their own, and from how the scene was
// built.
#include <fmt/core.h>

#include "scene/light_map/cascade_fit.h"
#include "verify/cases.h"
#include "verify/drawn_world.h"

namespace gnomon::verify {

namespace {

constexpr ImageSize picture{320, 200};

Scene room(double half) {
  // Inner sides only; wound inwards.
  const double h = half, s = 2.0 * half;
  return scene_of({quad({-h, -h, -h}, {0, 0, s}, {s, 0, 0}), quad({-h, h, -h}, {s, 0, 0}, {0, 0, s}),
                   quad({-h, -h, -h}, {0, s, 0}, {0, 0, s}), quad({h, -h, -h}, {0, 0, s}, {0, s, 0}),
                   quad({-h, -h, -h}, {s, 0, 0}, {0, s, 0}), quad({-h, -h, h}, {0, s, 0}, {s, 0, 0})});
}

/// Where the ray leaves a cube of this half side around the origin.
Vec3 on_room(const Ray& ray, double half) {
  double t = infinity;
  for (int a = 0; a < 3; ++a) {
    const double wall = ray.direction[a] > 0.0 ? half : -half;
    const double at = (wall - ray.origin[a]) / ray.direction[a];
    if (at > 0.0) t = std::min(t, at);
  }
  return ray.at(t);
}

}  // namespace

// A spot light in the middle of a room: half of the walls lie behind it. And the half-plane behind the eye of
// a light-space perspective warp, where its divisor is not positive.
void behind_light(Run& run) {
  Scene scene = room(3.0);
  Light spot = point_light({0.2, 0.1, 0.3});
  spot.type = LightType::spot, spot.direction = glm::normalize(Vec3(1, -0.4, 0.3)), spot.outer_angle = 0.7;
  scene.lights = {spot};
  scene.camera.eye = {1.0, 1.0, 2.5}, scene.camera.target = {-3.0, 0.0, -0.5},
  scene.camera.vertical_fov = 1.6;
  DrawnWorld drawn(std::move(scene));
  if (!drawn.ready()) return add_row_of_undrawn(run, drawn, "behind the light");
  const auto frame = drawn.draw(drawing(picture, 128, 0.0));
  if (!frame) {
    run.fault("receivers behind a spot light", frame.error().message());
  } else {
    run.sample_each("receivers behind a spot light", picture.pixels(), [&](std::uint64_t i, Tally& tally) {
      const int x = static_cast<int>(i) % picture.width, y = static_cast<int>(i) / picture.width;
      const Vec3 p = on_room(eye_ray(drawn.scene().camera, picture, x, y), 3.0);
      if (glm::dot(p - spot.position, spot.direction) > -1e-3) return;
      tally.check(frame->lights[0].outside_map.data[i] == 1 && frame->lights[0].visibility.data[i] == 1.0f);
    });
  }
  Scene street = scene_of({quad({-30, 0, -30}, {0, 0, 60}, {60, 0, 0}), box({-1, 0, -1}, {1, 2, 1})});
  street.lights = {sun({0.3, -1.0, 0.2})};
  street.camera.eye = {0.0, 1.7, 8.0}, street.camera.target = {0.0, 1.0, 0.0};
  const World world = make_world(street);
  const auto view = fit_warped(world, street.lights[0], street.camera, 1.6, 256);
  if (!view || !(view->face(0).warp > 0.0)) return run.fault("behind a warp's eye", "the fit made no warp");
  const LightFace& face = view->face(0);
  run.sample("points behind a warp's eye", run.rays(0.1), [&](Random& random, Tally& tally) {
    const double up = face.center.y - (1.0 / face.warp) * (1.0 + random.power_of_ten(-6, 3));
    const double right = random.uniform(-100, 100), forward = random.uniform(-100, 100);
    const Vec3 p = view->origin + right * face.right + up * face.up + forward * face.forward;
    tally.check(!project_to_face(*view, 0, p).inside);
  });
}

// A floor that goes on beside what the map of its only caster covers, and a wall beyond a spot light's
// depths.
void outside_map(Run& run) {
  Scene scene = scene_of({box({-1, 0, -1}, {1, 2, 1})}, {plane({0, 0, 0}, {0, 1, 0})});
  scene.lights = {sun({0.4, -1.0, 0.25})};
  scene.camera.eye = {3.0, 9.0, 12.0};
  DrawnWorld drawn(std::move(scene));
  if (!drawn.ready()) return add_row_of_undrawn(run, drawn, "beside the map");
  const auto frame = drawn.draw(drawing(picture, 64, 1e-3));
  if (!frame) return run.fault("beside the map", frame.error().message());
  const raster::LightRecord& record = frame->lights[0];
  const LightFace& face = record.map.view.face(0);
  std::uint64_t beside = 0;
  run.sample_each("receivers beside the map", picture.pixels(), [&](std::uint64_t i, Tally& tally) {
    if (frame->primitive.data[i] != drawn.world().triangle_count()) return;  // the plane
    const int x = static_cast<int>(i) % picture.width, y = static_cast<int>(i) / picture.width;
    const Ray ray = eye_ray(drawn.scene().camera, picture, x, y);
    const Vec3 d = ray.at(to_level(ray, 0.0)) - record.map.view.origin;
    const double u = glm::dot(d, face.right) / face.half_extent.x,
                 v = glm::dot(d, face.up) / face.half_extent.y;
    const double reach = std::max(std::abs(u), std::abs(v));
    // On the border a float may fall either side; in the margin of one texel the plane may leave the map's
    // depths.
    if (reach > 1.0 - 2.0 / record.map.view.size - 1e-4 && reach < 1.0 + 1e-4) return;
    const bool out = record.outside_map.data[i] == 1;
    beside += reach > 1.0;
    tally.check(reach > 1.0 ? out && record.visibility.data[i] == 1.0f : !out);
  });
  run.sample_each("and there are such receivers", 1,
                  [&](std::uint64_t, Tally& tally) { tally.check(beside > 1000); });
}

// A level floor seen from straight above. So pixel centres fall on the borders of texels, or beside them
// by less than the 8 bits that OpenGL keeps below a pixel.
void texel_boundaries(Run& run) {
  constexpr int size = 64;
  constexpr ImageSize pixels{64, 64};
  Scene scene = scene_of({quad({-4, 0, -4}, {0, 0, 8}, {8, 0, 0})});
  scene.lights = {sun({0, -1, 0})};
  scene.camera.up = {0, 0, -1};
  DrawnWorld drawn(std::move(scene));
  if (!drawn.ready()) return add_row_of_undrawn(run, drawn, "borders of texels");
  for (const double shift : {0.0, 1e-12, -1e-12, 1e-4, -1e-4}) {
    // A pixel of the floor is as wide as a texel of the map, which has a texel of margin on each side; the
    // eye stands half a texel off, so that pixel centres lie on borders.
    const double texel = 8.0 / (size - 2), height = 1000.0;
    Camera& camera = drawn.scene().camera;
    camera.eye = {(0.5 + shift) * texel, height, (0.5 + shift) * texel};
    camera.target = {camera.eye.x, 0.0, camera.eye.z};
    camera.vertical_fov = 2.0 * std::atan(0.5 * texel * pixels.height / height);
    raster::RasterOptions options = drawing(pixels, size, 0.0);
    const auto frame = drawn.draw(options);
    if (!frame) return run.fault("borders of texels", frame.error().message());
    const raster::LightRecord& record = frame->lights[0];
    const LightFace& face = record.map.view.face(0);
    run.sample_each(
        fmt::format("pixels {:g} texels beside borders", shift), pixels.pixels(),
        [&](std::uint64_t i, Tally& tally) {
          if (frame->primitive.data[i] == no_id) return;
          const int x = static_cast<int>(i) % pixels.width, y = static_cast<int>(i) / pixels.width;
          const Ray ray = eye_ray(camera, pixels, x, y);
          const Vec3 d = ray.at(to_level(ray, 0.0)) - record.map.view.origin;
          const Vec2 at =
              0.5 * size *
              (Vec2(glm::dot(d, face.right), glm::dot(d, face.up)) / face.half_extent + Vec2(1.0));
          const Vec2 got(record.texel_uv.data[i]);
          const Vec2 error = glm::abs(got - at);
          tally.error(std::max(error.x, error.y));
          for (int axis = 0; axis < 2; ++axis) {
            const double low = std::floor(at[axis] - 1.0 / 256), high = std::floor(at[axis] + 1.0 / 256);
            const double texel_got = std::floor(got[axis]);
            tally.check(texel_got == low || texel_got == high);
          }
        },
        "texels", 1.0 / 256);
  }
}

namespace {

/// Directions on the cube's diagonals and edges, whose largest components tie.
Vec3 tied_direction(Random& random) {
  Vec3 d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  const int kept = random.integer(0, 2);
  for (int a = 0; a < 3; ++a)
    if (a != kept || random.coin()) d[a] = random.coin() ? 1.0 : -1.0;
  return d * random.power_of_ten(-3, 3);
}

/// By the rule of the page: the largest component; x before y before z.
int face_by_rule(const Vec3& d) {
  int axis = 0;
  for (int a = 1; a < 3; ++a)
    if (std::abs(d[a]) > std::abs(d[axis])) axis = a;
  return 2 * axis + (d[axis] < 0.0 ? 1 : 0);
}

}  // namespace

void cube_seams(Run& run) {
  Scene scene = room(2.0);
  scene.lights = {point_light({0, 0, 0})};
  scene.camera.eye = {0.4, 0.3, 0.5}, scene.camera.target = {-2.0, -2.0, -2.0},
  scene.camera.vertical_fov = 1.7;
  DrawnWorld drawn(std::move(scene));
  const auto fitted = fit_light_view(drawn.world(), drawn.scene().lights[0], drawn.scene().camera, 1.6, 64);
  if (!fitted) return run.fault("directions with tied axes", fitted.error().message());
  LightView view = *fitted;
  view.seamless = !run.is_textbook();
  run.sample(
      "directions with tied axes", run.rays(0.1),
      [&](Random& random, Tally& tally) {
        const Vec3 d = tied_direction(random);
        const TexelCoordinate t = project_to_texel(view, view.origin + d);
        tally.check(t.inside && t.face == face_by_rule(d));
        if (!t.inside) return;
        // Half a texel's diagonal at most, as an angle at the light.
        const Vec3 ray = texel_ray(view, t.face, t.column() + 0.5, t.row() + 0.5).direction;
        const double angle = std::atan2(glm::length(glm::cross(ray, d)), glm::dot(ray, d));
        tally.error(angle / (std::numbers::sqrt2 / view.size));
      },
      "half diagonals of a texel", 1.0 + 1e-9);
  if (!drawn.ready()) return add_row_of_undrawn(run, drawn, "a room seen through its seams");
  // A lamp in the middle of an empty room lights every point of it; the walls' edges and the floor's
  // diagonals are seams.
  raster::RasterOptions options = drawing(picture, 64, 0.0);
  options.map.technique = run.is_textbook() ? raster::Technique::hard : raster::Technique::cube;
  options.map.bias.adaptive = true;
  for (const Vec3& eye : {Vec3(0.4, 0.3, 0.5), Vec3(0.0, 0.0, 0.0), Vec3(0.0, 0.0, 1.0)}) {
    drawn.scene().camera.eye = eye;
    const auto frame = drawn.draw(options);
    if (!frame) return run.fault("a room seen through its seams", frame.error().message());
    run.sample_each(fmt::format("a room's seams from ({:g} {:g} {:g})", eye.x, eye.y, eye.z),
                    picture.pixels(), [&](std::uint64_t i, Tally& tally) {
                      if (frame->primitive.data[i] == no_id) return;
                      tally.check(frame->lights[0].outside_map.data[i] == 0 &&
                                  frame->lights[0].visibility.data[i] == 1.0f);
                    });
  }
}

}  // namespace gnomon::verify
