// Small scenes built in code for the rasterizer's tests.
#pragma once

#include <string>

#include "scene/scene.h"

namespace gnomon::test {

inline Mesh box_mesh() {
  Mesh mesh;
  mesh.name = "box";
  for (int i = 0; i < 8; ++i)
    mesh.positions.emplace_back((i & 1) ? 0.5 : -0.5, (i & 2) ? 0.5 : -0.5, (i & 4) ? 0.5 : -0.5);
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// A square of the given half side in the plane y = 0, two triangles, facing +y, with texture coordinates 0
/// … 1.
inline Mesh square_mesh(double half) {
  Mesh mesh;
  mesh.name = "square";
  mesh.positions = {{-half, 0.0, -half}, {half, 0.0, -half}, {half, 0.0, half}, {-half, 0.0, half}};
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
  return mesh;
}

inline Mat4 placed(const Vec3& position, double size) {
  Mat4 m(size);
  m[3] = Vec4(position, 1.0);
  return m;
}

inline Light sun(const Vec3& direction) {
  Light light;
  light.name = "sun";
  light.type = LightType::directional;
  light.direction = glm::normalize(direction);
  return light;
}

inline Light lamp(LightType type, const Vec3& position, const Vec3& target) {
  Light light;
  light.name = type == LightType::spot ? "spot" : "lamp";
  light.type = type;
  light.position = position;
  light.direction = glm::normalize(target - position);
  light.intensity = Vec3f(static_cast<float>(glm::dot(target - position, target - position)));
  light.inner_angle = 0.5;
  light.outer_angle = 0.7;
  return light;
}

/// A box and a sphere on a ground square (or an infinite plane), all moved by `offset`; no light.
inline Scene still_life(bool infinite_ground = false, const Vec3& offset = Vec3(0.0)) {
  Scene scene;
  scene.name = "still life";
  scene.materials.resize(3);
  scene.materials[0].diffuse = Vec3f(0.7f, 0.7f, 0.65f);
  scene.materials[1].diffuse = Vec3f(0.8f, 0.3f, 0.2f);
  scene.materials[2].diffuse = Vec3f(0.2f, 0.4f, 0.8f);
  scene.materials[2].specular = Vec3f(0.5f);
  scene.meshes = {box_mesh(), square_mesh(4.0)};
  scene.instances.push_back({"box", 0, placed(offset + Vec3(-0.8, 0.5, 0.1), 1.0), 1});
  if (infinite_ground) {
    scene.shapes.push_back({"ground", Plane{offset, Vec3(0.0, 1.0, 0.0)}, 0});
  } else {
    scene.instances.push_back({"ground", 1, placed(offset, 1.0), 0});
  }
  scene.shapes.push_back({"ball", Sphere{offset + Vec3(0.9, 0.6, 0.3), 0.6}, 2});
  scene.camera.eye = offset + Vec3(1.5, 2.5, 5.0);
  scene.camera.target = offset + Vec3(0.0, 0.4, 0.0);
  scene.ambient = Vec3f(0.1f);
  scene.background = Vec3f(0.2f, 0.3f, 0.4f);
  return scene;
}

}  // namespace gnomon::test
