#include "tests/support/small_scenes.h"

namespace gnomon::test {

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

Scene boxes_under_three_lights() {
  Scene scene = sunlit_scene({floor_mesh(4, 4), box_mesh({-0.5, 0.0, -0.5}, {0.5, 0.8, 0.5}),
                              box_mesh({0.9, 0.3, -0.2}, {1.4, 0.7, 0.6})},
                             {0.7, -1.0, 0.3});
  Light lamp;
  lamp.name = "lamp";
  lamp.type = LightType::spot;
  lamp.position = {-2, 3, 2};
  lamp.direction = glm::normalize(Vec3(2, -3, -2));
  lamp.inner_angle = 0.4;
  lamp.outer_angle = 0.7;
  scene.lights.push_back(lamp);
  lamp.name = "bulb";
  lamp.type = LightType::point;
  lamp.position = {1.5, 2.0, 1.5};
  scene.lights.push_back(lamp);
  scene.camera = {{2.5, 3.0, 4.0}, {0.2, 0.2, 0}, {0, 1, 0}, 0.7};
  return scene;
}

}  // namespace gnomon::test
