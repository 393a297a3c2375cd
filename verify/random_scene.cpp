#include "verify/random_scene.h"

#include <glm/gtc/matrix_transform.hpp>

#include "scene/light.h"
#include "scene/shapes/solid.h"
#include "verify/small_world.h"

namespace gnomon::verify {

namespace {

/// A multiple of 1/4 in [low, high].
double quarter(Random& r, double low, double high) {
  return 0.25 * r.integer(static_cast<int>(4.0 * low), static_cast<int>(4.0 * high));
}

template <class T>
const T& any_of(const std::vector<T>& all, Random& r) {
  return all[r.below(static_cast<std::uint32_t>(all.size()))];
}

Vec3 place(Random& r) {
  return {quarter(r, -2.0, 2.0), quarter(r, 0.25, 2.25), quarter(r, -2.0, 2.0)};
}

Mesh random_box(Random& r) {
  const Vec3 low = place(r);
  return box(low, low + Vec3{quarter(r, 0.25, 1.0), quarter(r, 0.25, 1.0), quarter(r, 0.25, 1.0)});
}

/// Now and then with its third corner within a millionth of a line through the others, or nearer.
std::array<Vec3, 3> loose_triangle(Random& r) {
  const auto offset = [&] {
    const double x = quarter(r, -1, 1), y = quarter(r, -0.25, 1), z = quarter(r, -1, 1);
    return Vec3{x, y, z};
  };
  const Vec3 first = place(r), second = first + offset();
  if (r.below(8) != 0) return {first, second, first + offset()};
  const double along = quarter(r, -1.0, 2.0), aside = std::exp2(r.integer(-52, -20));
  return {first, second, first + along * (second - first) + aside * offset()};
}

Mesh loose_triangles(Random& r, int count) {
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const auto n = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3& p : loose_triangle(r)) mesh.positions.push_back(p);
    mesh.triangles.push_back({n, n + 1, n + 2});
  }
  return mesh;
}

Vec3 in_plane(Random& r, const std::array<Vec3, 3>& corners) {
  const double u = 0.5 * r.integer(-3, 6), v = 0.5 * r.integer(-3, 6);
  return corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]);
}

Shape random_sphere(Random& r) {
  const Vec3 center = place(r);
  return sphere(center, quarter(r, 0.25, 1.0));
}

Shape random_solid(Random& r) {
  constexpr std::array axes{Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0, -1, 0)};
  const Vec3 origin = place(r), axis = r.coin() ? axes[r.below(4)] : r.direction();
  const ShapeFrame frame = frame_along(origin, axis);
  const double radius = quarter(r, 0.25, 1.0), height = quarter(r, 0.5, 1.5), less = 0.5 * radius;
  const bool closed = r.coin();
  switch (r.below(8)) {
    case 0:
      return {"ellipsoid", make_ellipsoid(frame, {radius, height, less})};
    case 1:
      return {"cylinder", make_cylinder(frame, radius, height, closed)};
    case 2:
      return {"cone", make_cone(frame, radius, 0.0, height, closed)};
    case 3:
      return {"cut cone", make_cone(frame, radius, less, height, closed)};
    case 4:
      return {"paraboloid", make_paraboloid(frame, radius, height, closed)};
    case 5:
      return {"hyperboloid", make_hyperboloid(frame, radius, less, height, closed)};
    case 6:
      return {"two bowls", make_two_bowls(frame, radius, 0.5 * height, height, closed)};
    default:
      return {"torus", Torus{frame, radius, less}};
  }
}

/// On a shape's axis, at its apex or rim, or on its widest circle.
Vec3 place_at(const Shape& shape, Random& r) {
  const int side = r.coin() ? 1 : -1, step = r.integer(-1, 1);
  if (const auto* plane = std::get_if<Plane>(&shape.geometry)) {
    Vec3 tangent, bitangent;
    orthonormal_basis(plane->normal, tangent, bitangent);
    return plane->point + static_cast<double>(step) * tangent;
  }
  if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
    Vec3 offset(0.0);
    offset[static_cast<int>(r.below(3))] = side * sphere->radius;
    return sphere->center + offset;
  }
  const Aabb box = local_box(shape.geometry);
  const double z = step < 0 ? box.min.z : step > 0 ? box.max.z : 0.5 * (box.min.z + box.max.z);
  return to_world(frame_of(shape.geometry), {r.coin() ? side * box.max.x : 0.0, 0.0, z});
}

/// In the plane of a random face, at one of its corners, at a shape, inside a box, or anywhere.
Vec3 light_place(const Scene& scene, Random& r) {
  const Mesh& any = any_of(scene.meshes, r);
  const Mesh& m = r.coin() ? scene.meshes.back() : any;  // the loose triangles lie in no axis-parallel plane
  const auto& t = any_of(m.triangles, r);
  const Vec3 a = m.positions[t[0]], b = m.positions[t[1]], c = m.positions[t[2]];
  switch (r.below(6)) {
    case 0:
      return a;
    case 1:
      return 0.5 * (m.positions.front() + m.positions.back());
    case 2:
      return {quarter(r, -3, 3), quarter(r, 2, 5), quarter(r, -3, 3)};
    case 3:
      return place_at(any_of(scene.shapes, r), r);
    default:
      return in_plane(r, {a, b, c});
  }
}

Light random_light(const Scene& scene, Random& r) {
  Light light = point_light(light_place(scene, r));
  const auto type = r.below(4);
  if (type == 0) {
    const Mesh& m = any_of(scene.meshes, r);
    const Vec3 along = m.positions[1] - m.positions[0];  // often in the planes of faces
    Vec3 direction = r.coin() ? along : Vec3{quarter(r, -1, 1), -1.0, quarter(r, -1, 1)};
    if (direction == Vec3(0.0)) direction = Vec3(0.0, -1.0, 0.0);
    light = sun(direction.y > 0.0 ? -direction : direction);
  } else if (type == 1) {
    light.type = LightType::spot;
    light.direction = glm::normalize(Vec3{quarter(r, -0.5, 0.5), -1.0, quarter(r, -0.5, 0.5)});
    light.outer_angle = 0.7;
  }
  return light;
}

/// p becomes scale * rotation * p + by.
struct Similarity {
  Mat3 rotation;
  double scale;
  Vec3 by;
  Vec3 operator()(const Vec3& p) const { return scale * (rotation * p) + by; }
};

void move(ShapeGeometry& geometry, const Similarity& to) {
  const double s = to.scale;
  const auto move_frame = [&](ShapeFrame& f) { f.origin = to(f.origin), f.axes = to.rotation * f.axes; };
  if (auto* plane = std::get_if<Plane>(&geometry))
    plane->point = to(plane->point), plane->normal = to.rotation * plane->normal;
  if (auto* sphere = std::get_if<Sphere>(&geometry)) sphere->center = to(sphere->center), sphere->radius *= s;
  if (auto* torus = std::get_if<Torus>(&geometry))
    move_frame(torus->frame), torus->major *= s, torus->minor *= s;
  if (auto* q = std::get_if<Quadric>(&geometry)) {
    move_frame(q->frame);
    q->xx /= s * s, q->yy /= s * s, q->zz /= s * s, q->z /= s;
    q->box = {s * q->box.min, s * q->box.max};
  }
}

/// Rotates, scales by 1/1000 to 1000, and moves by up to 10,000 times the scene's size: what the meshes are made
/// of, or their instances.
void turn(Scene& scene, Random& r) {
  const double angle = r.uniform(0.0, 2.0 * pi);
  const Mat3 rotation(glm::rotate(Mat4(1.0), angle, r.direction()));
  const double scale = r.power_of_ten(-3.0, 3.0), reach = scale * r.power_of_ten(-1.0, 4.0);
  const Similarity to{rotation, scale, r.in_box(reach)};
  Mat4 matrix(scale * rotation);
  matrix[3] = Vec4(to.by, 1.0);
  const bool instances = scene.instances.size() > scene.meshes.size() || r.coin();
  for (MeshInstance& i : scene.instances)
    if (instances) i.world_from_object = matrix * i.world_from_object;
  for (Mesh& mesh : scene.meshes)
    for (Vec3& p : mesh.positions)
      if (!instances) p = to(p);
  for (Shape& shape : scene.shapes) move(shape.geometry, to);
  for (Light& light : scene.lights)
    light.position = to(light.position), light.direction = rotation * light.direction;
  Camera& camera = scene.camera;
  camera.eye = to(camera.eye), camera.target = to(camera.target), camera.up = rotation * camera.up;
}

/// A texture of 4 x 4 texels whose alpha, of each, is 0 or 255.
Texture holes(Random& r, bool nearest) {
  Texture texture;
  texture.name = "holes", texture.size = {4, 4}, texture.nearest = nearest;
  for (int i = 0; i < 16; ++i) texture.texels.emplace_back(255, 255, 255, r.coin() ? 255 : 0);
  return texture;
}

/// Makes of some meshes only the front seen, and gives some holes.
void choose_materials(Scene& scene, Random& r) {
  scene.textures = {holes(r, true), holes(r, false)};
  for (const auto& [single, texture] : {std::pair{true, no_id}, {false, 0u}, {true, 1u}}) {
    Material material;
    material.double_sided = !single, material.diffuse_texture = texture;
    if (texture != no_id) material.alpha_mode = AlphaMode::mask;
    scene.materials.push_back(material);
  }
  for (MeshInstance& instance : scene.instances)
    if (r.below(3) == 0) instance.material = 1 + r.below(3);
  // A triangle of which u or v is the same everywhere shall not lie at a border of texels, or halfway between two. Rounding
  // would say over all of it whether there is a hole.
  constexpr double aside = 0.05;
  for (Mesh& mesh : scene.meshes)
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      const double u = aside + quarter(r, -1.0, 2.0), v = aside + quarter(r, -1.0, 2.0);
      mesh.uvs.emplace_back(u, v);
    }
}

/// A mesh once more: turned by quarters of a turn, stretched, perhaps mirrored, and moved.
void repeat_a_mesh(Scene& scene, Random& r) {
  MeshInstance again = any_of(scene.instances, r);
  Mat4 matrix(0.0);
  const int first = r.integer(0, 2), step = r.integer(1, 2);
  for (int i = 0; i < 3; ++i) {
    const double sign = r.coin() ? 1.0 : -1.0;
    matrix[i][(first + step * i) % 3] = sign * std::exp2(r.integer(-1, 1));
  }
  matrix[3] = Vec4(place(r), 1.0);
  again.world_from_object = matrix;
  scene.instances.push_back(again);
}

}  // namespace

Scene random_scene(Random& r) {
  std::vector<Mesh> meshes;
  for (int i = r.integer(1, 4); i > 0; --i) meshes.push_back(random_box(r));
  meshes.push_back(loose_triangles(r, r.integer(1, 12)));
  std::vector<Shape> shapes{plane(Vec3(0.0), Vec3(0.0, 1.0, 0.0))};
  if (r.below(3) == 0) shapes.push_back(plane({-3.0, 0.0, 0.0}, {1.0, 0.0, 0.0}));
  for (int i = r.integer(0, 2); i > 0; --i) shapes.push_back(random_sphere(r));
  if (r.coin()) shapes.push_back(random_solid(r));
  Scene scene = scene_of(std::move(meshes), std::move(shapes));
  if (r.coin()) choose_materials(scene, r);
  if (r.coin()) repeat_a_mesh(scene, r);
  scene.lights = {random_light(scene, r)};
  scene.camera.eye = Vec3(4.0, 2.0, 3.5) + Vec3{quarter(r, 0, 1), quarter(r, 0, 2), quarter(r, 0, 1)};
  scene.camera.target = {quarter(r, -0.5, 0.5), 0.5, quarter(r, -0.5, 0.5)};
  if (r.coin()) turn(scene, r);
  if (r.below(3) == 0) add_twin(scene, r);
  return scene;
}

World world_of(const Scene& scene) {
  const bool repeats = scene.instances.size() > scene.meshes.size();
  return make_world(scene, repeats ? InstanceChoice::keep : InstanceChoice::automatic);
}

Scene invariant_scene(LightType type, Random random) {
  Mesh loose = soup(30, 1.5, 0.8, random);
  for (Vec3& p : loose.positions) p = glm::round(64.0 * p) / 64.0;
  Scene scene =
      scene_of({quad({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}), box({-1, 0.5, -1}, {0, 1.5, 0}), std::move(loose)});
  Light light = point_light({-1.75, 3.25, 1.5});
  light.type = type;
  light.direction = glm::normalize(Vec3(0.5, -1.0, -0.375));
  light.outer_angle = 0.7;
  scene.lights = {light};
  scene.camera.eye = {3.5, 2.5, 4.0}, scene.camera.target = {0.0, 0.5, 0.0};
  return scene;
}

Agreement compare_with_rays(const Scene& scene, const raster::RasterFrame& drawn,
                            const raytrace::RayTracedFrame& traced) {
  Agreement out;
  for (std::size_t i = 0; i < traced.receiver.data.size(); ++i) {
    const raytrace::SurfacePoint& p = traced.receiver.data[i];
    const raytrace::PointVisibility truth = traced.lights[0].centre.data[i];
    if (p.primitive == no_id || p.primitive != drawn.primitive.data[i]) continue;
    if (truth == raytrace::PointVisibility::uncertain ||
        light_cannot_reach(scene.lights[0], p.position, p.normal))
      continue;
    ++out.asked;
    out.wrong +=
        (drawn.lights[0].visibility.data[i] > 0.5f) == (truth == raytrace::PointVisibility::lit) ? 0 : 1;
  }
  return out;
}

}  // namespace gnomon::verify
