// Orthographic cameras: what each pixel sees against closed forms, in both renderers; the ladder and the exact techniques on it;
// what lies behind the eye; cameras far away.
#include "hybrid/visibility.h"
#include "tests/support/compare_support.h"
#include "tests/support/one_world.h"
#include "tests/support/raster_scenes.h"
#include "tests/support/solid_samples.h"

namespace gnomon::test {
namespace {

using raster::Technique;

constexpr ImageSize picture{160, 120};

/// A ball and a box of triangles over an infinite floor, seen from above at an angle.
Scene closed_form_scene() {
  Scene scene;
  scene.materials.resize(1);
  scene.meshes = {box_mesh({-1.5, 0.25, -0.5}, {-0.5, 1.25, 0.5})};
  scene.instances = {{"box", 0, Mat4(1.0), 0}};
  scene.shapes = {{"ball", Sphere{{0.8, 0.9, 0.3}, 0.6}, 0}, {"floor", Plane{{0, 0, 0}, {0, 1, 0}}, 0}};
  scene.lights = {sun({0.6, -1.0, 0.35})};
  scene.camera = {.eye = {3.0, 4.0, 7.0}, .target = {0.0, 0.5, 0.0}, .orthographic_height = 4.0};
  return scene;
}

enum class Object : std::uint8_t { box, ball, floor, none };

struct Seen {
  Object object = Object::none;
  double t = infinity;
  double margin = infinity;  ///< of what decides which object it is, world units; below it rounding does
};

/// The pixel's ray as the definition says, apart from scene/camera.cpp.
Ray parallel_ray(const Camera& camera, int x, int y) {
  const Vec3 forward = glm::normalize(camera.target - camera.eye);
  const Vec3 right = glm::normalize(glm::cross(forward, camera.up)), up = glm::cross(right, forward);
  const double pixel = camera.orthographic_height / picture.height;
  return {camera.eye + (x + 0.5 - 0.5 * picture.width) * pixel * right +
              (0.5 * picture.height - y - 0.5) * pixel * up,
          forward};
}

void keep_nearest(Seen& seen, Object object, double t) {
  if (t > 0.0 && t < seen.t) seen.object = object, seen.t = t;
}

Seen closed_form(const Ray& ray) {
  Seen seen;
  const Vec3 to_ball = Vec3(0.8, 0.9, 0.3) - ray.origin;
  const double along = glm::dot(to_ball, ray.direction);
  const double across = glm::length(to_ball - along * ray.direction);
  seen.margin = std::abs(across - 0.6);
  if (across < 0.6) keep_nearest(seen, Object::ball, along - std::sqrt(0.36 - across * across));
  const Vec3 low = (Vec3(-1.5, 0.25, -0.5) - ray.origin) / ray.direction;
  const Vec3 high = (Vec3(-0.5, 1.25, 0.5) - ray.origin) / ray.direction;
  const double enter = raytrace::max_component(glm::min(low, high));
  const double leave = -raytrace::max_component(-glm::max(low, high));
  seen.margin = std::min(seen.margin, std::abs(leave - enter));
  if (enter < leave) keep_nearest(seen, Object::box, enter);
  keep_nearest(seen, Object::floor, -ray.origin.y / ray.direction.y);
  return seen;
}

Object object_of(std::uint32_t primitive, const World& world) {
  if (primitive == no_id) return Object::none;
  if (world.is_triangle(primitive)) return Object::box;
  return primitive == world.triangle_count() ? Object::ball : Object::floor;
}

// A rasterizer's triangles have corners rounded to 1/256 pixel: what lies nearer to an outline is not asked for.
TEST(Orthographic, EachPixelSeesWhatItsParallelRayMeets) {
  const double pixel = 4.0 / picture.height;
  for (const double away : {1.0, 30.0}) {
    Scene scene = closed_form_scene();
    scene.camera.eye = scene.camera.target + away * (scene.camera.eye - scene.camera.target);
    const Compared run = run_comparison(scene, test_options(picture, 256, 0.02));
    int asked = 0;
    std::array<int, 4> seen_of{};
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x) {
        const Ray ray = parallel_ray(scene.camera, x, y);
        const Seen seen = closed_form(ray);
        if (seen.margin < 0.05 * pixel) continue;
        ++asked, ++seen_of[static_cast<std::size_t>(seen.object)];
        const raytrace::SurfacePoint& point = run.result.raytraced.receiver.at(x, y);
        ASSERT_EQ(object_of(point.primitive, *run.world), seen.object) << x << " " << y;
        ASSERT_EQ(object_of(run.result.raster.primitive.at(x, y), *run.world), seen.object) << x << " " << y;
        EXPECT_NEAR(glm::distance(point.position, ray.at(seen.t)), 0.0, 1e-9 * away);
      }
    EXPECT_GT(asked, 0.98 * static_cast<double>(picture.pixels()));
    for (const Object object : {Object::box, Object::ball, Object::floor})
      EXPECT_GT(seen_of[static_cast<std::size_t>(object)], 1000);
  }
}

std::size_t different(const compare::LightComparison& light, std::size_t a, std::size_t b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < light.labels.data.size(); ++i)
    count += compare::is_compared(light.labels.data[i]) && light.rungs[a].data[i] != light.rungs[b].data[i];
  return count;
}

// The hard test as climbed is the one that was drawn, but at texels' borders; however far the eye stands.
TEST(Orthographic, TheLadderEndsWhereTheRasterizerDrew) {
  for (const double away : {1.0, 1000.0, 1e5})
    for (const Technique technique : {Technique::hard, Technique::csm, Technique::lispsm}) {
      Scene scene = closed_form_scene();
      scene.camera.eye = scene.camera.target + away * (scene.camera.eye - scene.camera.target);
      compare::CompareOptions options = test_options(picture, 256, 0.02);
      options.raster.map.technique = technique;
      const Compared run = run_comparison(scene, options);
      const std::size_t compared = run.light().pixels.compared;
      std::printf("  %6.0f away, technique %d: %zu of %zu differ\n", away, int(technique),
                  different(run.light(), 5, 6), compared);
      EXPECT_GT(compared, picture.pixels() / 2);
      EXPECT_LE(different(run.light(), 5, 6), compared / 1000);
      EXPECT_EQ(run.light().pixels.silhouette, 0u);
    }
}

// A view from which every pixel's ray meets the same light-space texels as any other: the share of acne on the floor is the
// closed form's (docs/design.md, section 3), and the texels' sizes do not depend on the place.
TEST(Orthographic, AcneIsTheClosedForms) {
  Scene scene = sunlit_scene({floor_mesh(10.0, 10.0)}, {0.8, -1.3, 0.45});
  scene.camera = {.eye = {1.3, 14.0, 9.0}, .target = {0.2, 0.0, 0.5}, .orthographic_height = 6.0};
  const compare::CompareOptions options = test_options({480, 360}, 512, 0.0);
  const Compared first = run_comparison(scene, options);
  const LightFace& face = first.result.raster.lights[0].map.view.faces[0];
  const double slope_u =
      std::abs(glm::dot(Vec3(0, 1, 0), face.right) / glm::dot(Vec3(0, 1, 0), face.forward));
  const double slope_v = std::abs(glm::dot(Vec3(0, 1, 0), face.up) / glm::dot(Vec3(0, 1, 0), face.forward));
  const double a = face.half_extent.x / 512 * slope_u, b = face.half_extent.y / 512 * slope_v;
  for (const double share : {0.0, 0.5}) {
    const double bias = share * std::max(a, b);
    const Compared run = run_comparison(scene, test_options({480, 360}, 512, bias));
    const auto& light = run.light();
    const double acne = double(light.classes[static_cast<std::size_t>(compare::Label::acne) - 1]);
    EXPECT_NEAR(acne / double(light.pixels.compared), acne_fraction(a, b, bias), 0.005);
    // Texels are as large on the screen everywhere: perspective aliasing is one number.
    const auto& theory = light.theory;
    EXPECT_NEAR(theory.perspective.median, theory.perspective.max, 1e-9 * theory.perspective.max);
    const double pixel = 6.0 / 360, texel = 2.0 * std::sqrt(face.half_extent.x * face.half_extent.y) / 512;
    EXPECT_NEAR(theory.perspective.median, texel / pixel, 1e-9);
    EXPECT_NEAR(theory.measured_aliasing.median, theory.aliasing.median, 2e-3 * theory.aliasing.median);
  }
}

Scene crowded() {
  Scene scene = still_life(true);
  const std::vector<Shape> solids = solid_samples(0.5, {2.0, 0.8, -1.0});
  for (std::size_t i = 0; i < solids.size(); i += 3) scene.shapes.push_back(solids[i]);
  for (Shape& shape : scene.shapes) shape.material = 0;
  scene.lights = {sun({0.6, -1.0, 0.35}), lamp(LightType::point, {0.3, 2.2, 1.0}, {0, 0, 0})};
  scene.camera = {.eye = {40.0, 50.0, 60.0}, .target = {0.5, 0.3, 0.0}, .orthographic_height = 6.0};
  return scene;
}

// The irregular z-buffer and the hybrid decide every pixel as the ray tracer does; both renderers' depths agree.
TEST(Orthographic, ExactTechniquesAreExact) {
  OneWorld world(crowded());
  world.renderer->use_external_visibility(raster::Technique::hybrid, hybrid::make_visibility(world.world));
  for (const Technique technique : {Technique::izb, Technique::hybrid}) {
    compare::CompareOptions options = test_options({240, 180}, 128);
    options.raster.map.technique = technique;
    const compare::Comparison run = world.compare(options);
    for (const compare::LightComparison& light : run.lights) {
      EXPECT_EQ(light.error.wrong, 0u);
      EXPECT_GT(light.pixels.compared, 10000u);
      EXPECT_LT(light.pixels.silhouette, light.pixels.total / 200);
    }
  }
}

// Rays start in the plane through the eye: what lies behind it is not seen, and what reaches through it is cut there.
TEST(Orthographic, NothingIsSeenBehindTheEye) {
  Scene scene = closed_form_scene();
  const Vec3 forward = glm::normalize(scene.camera.target - scene.camera.eye);
  scene.camera.eye = scene.camera.target - 0.2 * forward;     // within the box's and the ball's reach
  scene.meshes.push_back(box_mesh({-3, 3, 3}, {3, 3.5, 5}));  // wholly behind it
  scene.instances.push_back({"behind", 1, Mat4(1.0), 0});
  const Compared run = run_comparison(scene, test_options(picture, 256, 0.02));
  std::size_t same = 0, through = 0, behind = 0;
  for (std::size_t i = 0; i < picture.pixels(); ++i) {
    const std::uint32_t seen = run.result.raytraced.receiver.data[i].primitive;
    same += seen == run.result.raster.primitive.data[i];
    through += seen != no_id && run.world->is_triangle(seen);
    behind += seen != no_id && run.world->is_triangle(seen) && run.world->object_of(seen) == 1;
  }
  EXPECT_GE(same, picture.pixels() - 20);
  EXPECT_GT(through, 200u);
  EXPECT_EQ(behind, 0u);
}

TEST(Orthographic, EveryTechniqueDraws) {
  OneWorld world(crowded());
  world.scene.lights.resize(1);
  for (const Technique technique : {Technique::pcf, Technique::pcss, Technique::vsm, Technique::evsm,
                                    Technique::msm, Technique::midpoint}) {
    compare::CompareOptions options = test_options({120, 90}, 256);
    options.raster.map.technique = technique;
    const compare::Comparison run = world.compare(options);
    EXPECT_LT(run.lights[0].error.wrong_fraction, 0.2);
  }
}

}  // namespace
}  // namespace gnomon::test
