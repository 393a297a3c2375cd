#include "support/compare_support.h"

namespace gnomon::test {

Compared run_comparison(Scene scene, const compare::CompareOptions& options) {
  Compared out;
  out.scene = std::make_unique<Scene>(std::move(scene));
  out.world = std::make_unique<World>(make_world(*out.scene));
  auto context = raster::create_context(raster::Backend::automatic);
  if (!context) {
    ADD_FAILURE() << context.error().message();
    return out;
  }
  auto renderer = raster::Renderer::create(std::move(*context), *out.world, plan_effects(*out.scene));
  if (!renderer) {
    ADD_FAILURE() << renderer.error().message();
    return out;
  }
  auto result = compare::compare_world(*out.world, **renderer, options);
  if (!result) {
    ADD_FAILURE() << result.error().message();
    return out;
  }
  out.result = std::move(*result);
  return out;
}

compare::CompareOptions test_options(ImageSize size, int map_size, double bias_world) {
  compare::CompareOptions options;
  options.raster.size = options.raytrace.size = size;
  options.raster.map.size = map_size;
  options.raster.map.bias = {bias_world, raster::BiasUnit::world};
  options.raster.runs = 0;
  options.raytrace.picture = false;
  return options;
}

Mesh floor_mesh(double half_width, double half_depth) {
  Mesh mesh;
  mesh.name = "floor";
  mesh.positions = {{-half_width, 0, half_depth},
                    {half_width, 0, half_depth},
                    {half_width, 0, -half_depth},
                    {-half_width, 0, -half_depth}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

Mesh box_mesh(const Vec3& lo, const Vec3& hi) {
  Mesh mesh;
  mesh.name = "box";
  for (int i = 0; i < 8; ++i)
    mesh.positions.emplace_back((i & 1) ? hi.x : lo.x, (i & 2) ? hi.y : lo.y, (i & 4) ? hi.z : lo.z);
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  quad(0, 4, 6, 2), quad(1, 3, 7, 5), quad(0, 1, 5, 4), quad(2, 6, 7, 3), quad(0, 2, 3, 1), quad(4, 5, 7, 6);
  return mesh;
}

Scene sunlit_scene(std::vector<Mesh> meshes, const Vec3& direction) {
  Scene scene;
  scene.name = "test";
  scene.materials.push_back(Material{"grey"});
  Light sun;
  sun.name = "sun";
  sun.direction = glm::normalize(direction);
  scene.lights.push_back(sun);
  for (Mesh& mesh : meshes) {
    MeshInstance instance;
    instance.name = mesh.name;
    instance.mesh = static_cast<std::uint32_t>(scene.meshes.size());
    scene.instances.push_back(instance);
    scene.meshes.push_back(std::move(mesh));
  }
  return scene;
}

double acne_fraction(double a, double b, double bias) {
  if (a < b) std::swap(a, b);
  if (bias < 0.0) return 1.0 - acne_fraction(a, b, -bias);
  if (bias >= a + b) return 0.0;
  if (bias <= a - b) return 0.5 * (1.0 - bias / a);
  return (a + b - bias) * (a + b - bias) / (8.0 * a * b);
}

}  // namespace gnomon::test
