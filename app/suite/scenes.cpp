#include "app/suite/write.h"

#include <glm/gtc/matrix_transform.hpp>

namespace gnomon::app {

namespace {

constexpr double degree = pi / 180.0;

// ---- meshes ----

/// Four corners to a side, with its normal.
void add_box(Mesh& mesh, const Aabb& box) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      Vec3 normal(0.0), u(0.0), v(0.0);
      normal[axis] = side, u[(axis + 1) % 3] = 1.0, v[(axis + 2) % 3] = side;
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      for (const Vec2 corner : {Vec2(-1, -1), Vec2(1, -1), Vec2(1, 1), Vec2(-1, 1)}) {
        mesh.positions.push_back(box.center() + 0.5 * box.extent() * (normal + corner.x * u + corner.y * v));
        mesh.normals.emplace_back(normal);
        mesh.uvs.emplace_back(0.5 * corner + 0.5);
      }
      mesh.triangles.push_back({first, first + 1, first + 2});
      mesh.triangles.push_back({first, first + 2, first + 3});
    }
}

Mesh make_box() {
  Mesh mesh;
  mesh.name = "box";
  add_box(mesh, {Vec3(-0.5), Vec3(0.5)});
  return mesh;
}

Mesh make_ell() {
  Mesh mesh;
  mesh.name = "ell";
  for (const Aabb& box : ell_boxes()) add_box(mesh, box);
  return mesh;
}

Mesh make_square() {
  Mesh mesh;
  mesh.name = "square";
  mesh.positions = {{-0.5, 0.0, -0.5}, {-0.5, 0.0, 0.5}, {0.5, 0.0, 0.5}, {0.5, 0.0, -0.5}};
  mesh.normals.assign(4, Vec3f(0.0f, 1.0f, 0.0f));
  mesh.uvs = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

// ---- scenes ----

enum MeshOf : std::uint32_t { of_box, of_square, of_ell };
enum Surface : std::uint32_t { ground, thing };

/// Every scene begins with the three meshes, two materials, and its camera.
Scene begin(const char* name, const Vec3& eye, const Vec3& target, double fov = 40.0) {
  Scene scene;
  scene.name = name;
  scene.camera = {.eye = eye, .target = target, .vertical_fov = fov * degree};
  scene.meshes = {make_box(), make_square(), make_ell()};
  scene.materials.resize(2);
  scene.materials[ground].name = "ground";
  scene.materials[ground].diffuse = Vec3f(0.5f);
  scene.materials[thing].name = "thing";
  scene.materials[thing].diffuse = Vec3f(0.7f, 0.4f, 0.25f);
  scene.ambient = Vec3f(0.15f);
  scene.exposure = 1.0;
  return scene;
}

struct Turn {
  Vec3 axis{0.0, 1.0, 0.0};
  double degrees = 0.0;
};

void add(Scene& scene, const char* name, MeshOf mesh, Surface material, const Vec3& middle, const Vec3& size,
         const Turn& turn = {}) {
  const Mat4 place = glm::translate(Mat4(1.0), middle);
  const Mat4 turned = turn.degrees == 0.0 ? place : glm::rotate(place, turn.degrees * degree, turn.axis);
  scene.instances.push_back({name, mesh, glm::scale(turned, size), material});
}

void add_floor(Scene& scene, double width, double depth, const Vec3& middle = Vec3(0.0)) {
  add(scene, "floor", of_square, ground, middle, {width, 1.0, depth});
}

/// A box whose foot is at that height.
void add_standing(Scene& scene, const char* name, const Vec3& foot, const Vec3& size, const Turn& turn = {}) {
  add(scene, name, of_box, thing, foot + Vec3(0.0, 0.5 * size.y, 0.0), size, turn);
}

/// The sun stands at that elevation and azimuth (0: +z, 90: +x).
Scene with_sun(Scene scene, double elevation, double azimuth) {
  const double e = elevation * degree, a = azimuth * degree;
  Light sun;
  sun.name = "sun";
  sun.direction = -glm::normalize(Vec3(std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a)));
  sun.intensity = Vec3f(2.0f);
  scene.lights = {sun};
  return scene;
}

SuiteScene tilted_plane() {
  Scene scene = begin("tilted-plane", {0.0, 5.0, 7.0}, {0.0, 0.5, 0.0});
  add(scene, "plane", of_square, ground, {0.0, 0.0, 0.0}, {8.0, 1.0, 6.0}, {{0.0, 0.0, 1.0}, 25.0});
  return {"A tilted plane alone in the sun: whatever is dark is acne.",
          with_sun(std::move(scene), 40.0, 35.0)};
}

SuiteScene wall_on_floor() {
  Scene scene = begin("wall-on-floor", {3.5, 3.5, 5.5}, {0.0, 0.4, -0.5});
  add_floor(scene, 12.0, 12.0);
  add_standing(scene, "wall", {0.0, 0.0, 0.0}, {4.0, 1.25, 0.0625});
  return {"A wall of 6.25 cm on a floor: a bias that is too large detaches its shadow, or shines through.",
          with_sun(std::move(scene), 45.0, 160.0)};
}

SuiteScene floating_box() {
  Scene scene = begin("floating-box", {2.5, 3.0, 5.5}, {0.0, 0.3, 0.0});
  add_floor(scene, 12.0, 12.0);
  add_standing(scene, "on the floor", {-1.5, 0.0, 0.0}, Vec3(0.75), {{0.0, 1.0, 0.0}, 20.0});
  add_standing(scene, "3 cm above", {0.0, 0.03125, 0.0}, Vec3(0.75), {{0.0, 1.0, 0.0}, 20.0});
  add_standing(scene, "25 cm above", {1.5, 0.25, 0.0}, Vec3(0.75), {{0.0, 1.0, 0.0}, 20.0});
  return {"Boxes on, just above and above a floor: contacts and gaps.",
          with_sun(std::move(scene), 50.0, -140.0)};
}

SuiteScene pickets() {
  Scene scene = begin("pickets", {1.5, 2.5, 5.0}, {0.0, 0.3, 0.5});
  add_floor(scene, 12.0, 12.0);
  for (int i = 0; i < 25; ++i)
    add_standing(scene, "picket", {-1.5 + 0.125 * i, 0.0, 0.0}, {0.0078125, 1.0, 0.03125});
  return {"Pickets of 8 mm, thinner than most maps' texels: features that are lost.",
          with_sun(std::move(scene), 42.0, 205.0)};
}

/// Sixteen texels a side: opaque in a pointed oval with a notch, else nothing.
Texture leaf_texture() {
  Texture texture;
  texture.name = "leaf";
  texture.size = {16, 16};
  texture.nearest = true;
  texture.repeat_s = texture.repeat_t = false;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      const double u = (x + 0.5) / 8.0 - 1.0, v = (y + 0.5) / 8.0 - 1.0;
      const bool inside = std::abs(u) < 0.75 * (1.0 - v * v) && !(u > 0.25 && std::abs(v) < 0.125);
      texture.texels.emplace_back(60, 140, 40, inside ? 255 : 0);
    }
  return texture;
}

SuiteScene masked_leaf() {
  Scene scene = begin("masked-leaf", {2.5, 4.0, 4.5}, {0.0, 0.5, 0.0});
  scene.textures = {leaf_texture()};
  scene.materials[thing].diffuse = Vec3f(1.0f);
  scene.materials[thing].diffuse_texture = 0;
  scene.materials[thing].alpha_mode = AlphaMode::mask;
  add_floor(scene, 10.0, 10.0);
  add(scene, "leaf", of_square, thing, {0.0, 1.25, 0.0}, {2.0, 1.0, 2.0}, {{0.0, 0.0, 1.0}, 15.0});
  return {"A leaf cut out of a square by an alpha mask of 16 x 16 texels, unfiltered: masks in the map.",
          with_sun(std::move(scene), 60.0, -60.0)};
}

SuiteScene mirrored_node() {
  Scene scene = begin("mirrored-node", {2.0, 3.5, 5.5}, {0.0, 0.4, 0.0});
  add_floor(scene, 12.0, 12.0);
  add(scene, "plain", of_ell, thing, {-1.25, 0.0, 0.0}, {1.0, 1.0, 1.0});
  add(scene, "mirrored", of_ell, thing, {1.25, 0.0, 0.0}, {-1.0, 1.0, 1.0});
  return {"A mesh and its mirror image by a negative scale: what is culled as a back face is its front.",
          with_sun(std::move(scene), 48.0, 150.0)};
}

SuiteScene two_sided_sheet() {
  Scene scene = begin("two-sided-sheet", {2.0, 3.0, 5.5}, {0.0, 0.4, 0.0});
  add_floor(scene, 12.0, 12.0);
  add(scene, "towards", of_square, thing, {-1.25, 0.625, 0.0}, {1.5, 1.0, 1.0}, {{1.0, 0.0, 0.0}, 60.0});
  add(scene, "away", of_square, thing, {1.25, 0.625, 0.0}, {1.5, 1.0, 1.0}, {{1.0, 0.0, 0.0}, -120.0});
  return {"Sheets without thickness that turn one side and the other to the sun: both cast, both are lit.",
          with_sun(std::move(scene), 35.0, 75.0)};
}

SuiteScene far_from_origin() {
  const Vec3 away(16384.0, 0.0, -8192.0);
  Scene scene = begin("far-from-origin", away + Vec3(2.5, 3.0, 4.5), away + Vec3(0.0, 0.3, 0.0));
  add_floor(scene, 8.0, 8.0, away);
  add_standing(scene, "box", away + Vec3(-0.75, 0.0, 0.0), Vec3(0.75), {{0.0, 1.0, 0.0}, 20.0});
  add_standing(scene, "post", away + Vec3(0.75, 0.0, 0.25), {0.125, 1.5, 0.125});
  return {"A box and a post 18 km from the origin: floats there are 1 to 2 mm apart.",
          with_sun(std::move(scene), 50.0, -140.0)};
}

SuiteScene cube_seams() {
  Scene scene = begin("cube-seams", {0.0, 6.5, 7.5}, {0.0, 0.0, 0.5}, 45.0);
  add_floor(scene, 14.0, 14.0);
  add(scene, "back wall", of_square, ground, {0.0, 2.0, -4.0}, {14.0, 1.0, 4.0}, {{1.0, 0.0, 0.0}, 90.0});
  for (const double x : {-1.5, 1.5})
    for (const double z : {-1.5, 1.5}) add_standing(scene, "pillar", {x, 0.0, z}, {0.25, 1.75, 0.25});
  add(scene, "beam", of_box, thing, {0.0, 0.5, 1.5}, {2.0, 0.125, 0.125});
  Light bulb{.name = "bulb", .type = LightType::point, .position = {0.0, 2.0, 0.0}};
  bulb.intensity = Vec3f(12.0f);
  scene.lights = {bulb};
  return {"Pillars along the seams of a point light's cube of maps, and a beam across one.",
          std::move(scene)};
}

SuiteScene spot_rim() {
  Scene scene = begin("spot-rim", {2.5, 4.5, 6.0}, {0.0, 0.2, 0.0});
  add_floor(scene, 12.0, 12.0);
  for (int i = 0; i < 6; ++i) {
    const double angle = 60.0 * i * degree;
    add_standing(scene, "block", {1.875 * std::cos(angle), 0.0, 1.875 * std::sin(angle)},
                 {0.375, 0.5, 0.375});
  }
  Light spot{.name = "spot", .type = LightType::spot, .position = {0.5, 4.0, 0.25}};
  spot.direction = glm::normalize(Vec3(0.0, 0.0, 0.0) - spot.position);
  spot.intensity = Vec3f(40.0f);
  spot.inner_angle = 25.0 * degree, spot.outer_angle = 30.0 * degree;
  scene.lights = {spot};
  return {"Blocks across the rim of a spot's cone, where its map ends.", std::move(scene)};
}

SuiteScene grazing_sun() {
  Scene scene = begin("grazing-sun", {1.0, 3.5, 6.0}, {0.0, 0.0, 0.0});
  add_floor(scene, 16.0, 10.0);
  for (int i = 0; i < 5; ++i)
    add_standing(scene, "stone", {-3.0 + 1.25 * i, 0.0, -1.5 + 0.75 * i}, {0.25, 0.125, 0.25});
  return {"A sun three degrees above the horizon: a texel's depth changes twenty times its width.",
          with_sun(std::move(scene), 3.0, -75.0)};
}

SuiteScene long_floor() {
  Scene scene = begin("long-floor", {1.5, 2.5, 12.0}, {0.0, 0.5, 0.0});
  add_floor(scene, 24.0, 256.0, {0.0, 0.0, -116.0});
  for (int i = 0; i < 30; ++i)
    add_standing(scene, "post", {i % 2 == 0 ? -2.0 : 2.0, 0.0, 4.0 - 8.0 * i}, {0.5, 2.0, 0.5});
  return {"Posts along 256 m of floor: one map is too coarse near by, cascades have seams.",
          with_sun(std::move(scene), 40.0, 60.0)};
}

}  // namespace

std::vector<Aabb> ell_boxes() {
  return {{Vec3(-0.5, 0.0, -0.25), Vec3(0.5, 0.5, 0.25)}, {Vec3(-0.5, 0.5, -0.25), Vec3(-0.125, 1.25, 0.25)}};
}

std::vector<SuiteScene> suite_scenes() {
  return {tilted_plane(),    wall_on_floor(),   floating_box(), pickets(),  masked_leaf(), mirrored_node(),
          two_sided_sheet(), far_from_origin(), cube_seams(),   spot_rim(), grazing_sun(), long_floor()};
}

}  // namespace gnomon::app
