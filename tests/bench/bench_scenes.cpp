#include "bench_scenes.h"

#include "scene/generate/random.h"
#include "scene/load.h"
#include "tests/support/places.h"
#include "tests/support/raytrace_support.h"

namespace gnomon::bench {
namespace {

void round_to_float(Scene& scene) {
  for (Mesh& mesh : scene.meshes) mesh = test::in_floats(std::move(mesh));
}

std::optional<Mesh> bunny() {
  std::optional<Mesh> mesh =
      test::read_obj(gnomon::test::shared_data() + "/common_organic/stanford-bunny.obj");
  if (mesh) *mesh = test::normalised(std::move(*mesh));
  return mesh;
}

Mesh teapot();

// Six thousand triangles where the model is there; else the built-in one, finer.
Mesh coarse_teapot() {
  std::optional<Mesh> mesh = test::read_obj(gnomon::test::shared_data() + "/common_organic/teapot.obj");
  return mesh ? test::normalised(std::move(*mesh)) : teapot();
}

// The triangles of the built-in scene's meshes but its ground (the one with the fewest).
Mesh teapot() {
  const Expected<Scene> scene = load_scene("teapot");
  Mesh all;
  if (!scene) return all;
  const World world = make_world(*scene);
  std::vector<std::uint32_t> count(scene->instances.size());
  for (std::uint32_t i = 0; i < world.triangle_count(); ++i) ++count[world.object_of(i)];
  for (std::uint32_t i = 0; i < world.triangle_count(); ++i) {
    if (count[world.object_of(i)] < 100) continue;
    const auto first = static_cast<std::uint32_t>(all.positions.size());
    for (const Vec3& corner : world.corners(i)) all.positions.push_back(corner);
    all.triangles.push_back({first, first + 1, first + 2});
  }
  return test::normalised(std::move(all));
}

double lowest(const Mesh& mesh) {
  double low = infinity;
  for (const Vec3& p : mesh.positions) low = std::min(low, p.y);
  return low;
}

BenchScene over_ground(std::string name, Mesh mesh) {
  const double low = lowest(mesh);
  Scene scene = test::scene_of({std::move(mesh), test::quad({-1, low, -1}, {0, 0, 2}, {2, 0, 0})});
  scene.lights = {test::point_light({0.7, 1.2, 0.9}), test::sun(glm::normalize(Vec3(-0.5, -1, -0.4)))};
  scene.camera.eye = {0.25, 0.375, 1.25}, scene.camera.target = {0, 0, 0};
  round_to_float(scene);
  return {std::move(name), std::move(scene)};
}

Mesh terrain(int cells, double half, double height) {
  Mesh mesh;
  const Image<float> noise = periodic_fractal({cells + 1, cells + 1}, {6, 6}, 7, 3);
  for (int y = 0; y <= cells; ++y)
    for (int x = 0; x <= cells; ++x)
      mesh.positions.emplace_back(half * (2.0 * x / cells - 1.0),
                                  height * static_cast<double>(noise.at(x, y)),
                                  half * (2.0 * y / cells - 1.0));
  const auto at = [&](int x, int y) { return static_cast<std::uint32_t>(y * (cells + 1) + x); };
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x) {
      mesh.triangles.push_back({at(x, y), at(x, y + 1), at(x + 1, y)});
      mesh.triangles.push_back({at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)});
    }
  return mesh;
}

Scene over_terrain(std::vector<Mesh> meshes) {
  Scene scene = test::scene_of(std::move(meshes));
  scene.lights = {test::point_light({1.5, 3.0, 2.0}), test::sun(glm::normalize(Vec3(-0.5, -1, -0.4)))};
  scene.camera.eye = {0.5, 1.75, 2.75}, scene.camera.target = {0, 0.5, 0};
  round_to_float(scene);
  return scene;
}

}  // namespace

BenchScene teapot_scene() {
  return over_ground("teapot", coarse_teapot());
}

std::optional<BenchScene> bunny_scene() {
  std::optional<Mesh> mesh = bunny();
  if (!mesh) return std::nullopt;
  return over_ground("bunny", std::move(*mesh));
}

BenchScene million_scene() {
  std::optional<Mesh> model = bunny();
  if (!model) model = teapot();
  std::vector<Mesh> meshes{terrain(512, 2.5, 0.6)};
  const double low = lowest(*model);
  for (int i = 0; i < 7; ++i) {
    Mesh copy = *model;
    const double angle = 0.9 * i, distance = i == 0 ? 0.0 : 1.1;
    const Vec3 place(distance * std::cos(angle), 0.4 - low, distance * std::sin(angle));
    for (Vec3& p : copy.positions) {
      const double c = std::cos(angle), s = std::sin(angle);
      p = Vec3(c * p.x + s * p.z, p.y, c * p.z - s * p.x) + place;
    }
    meshes.push_back(std::move(copy));
  }
  return {"million", over_terrain(std::move(meshes))};
}

std::optional<BenchScene> forest_scene() {
  Expected<Scene> scene = load_scene("forest");
  if (!scene) return std::nullopt;
  scene->lights.insert(scene->lights.begin(), test::point_light({6.0, 14.0, 8.0}));
  round_to_float(*scene);
  for (MeshInstance& instance : scene->instances)
    instance.world_from_object = Mat4(Mat4f(instance.world_from_object));
  return BenchScene{"forest", std::move(*scene)};
}

BenchScene terrain_scene(const std::string& name, int cells) {
  return {name, over_terrain({terrain(cells, 2.5, 0.6)})};
}

}  // namespace gnomon::bench
