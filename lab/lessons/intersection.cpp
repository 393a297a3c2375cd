#include "lab/lessons/figures.h"

#include <fmt/core.h>

#include <array>

#include "raytrace/tracer.h"
#include "scene/shapes/expression.h"
#include "scene/world.h"

namespace gnomon::lab::lessons {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view ovals = "(x^2 + y^2)^2 - 2*(x^2 - y^2) - (0.985^4 - 1)";

/// What the figures build structures over, seen in the plane z = 0: x, y and radius. Most lie close together.
constexpr std::array<std::array<double, 3>, 14> discs{{{-2.3, -0.9, 0.22},
                                                       {-2.1, 0.75, 0.3},
                                                       {-1.2, 0.1, 0.26},
                                                       {-0.6, -0.95, 0.2},
                                                       {-0.3, 0.85, 0.24},
                                                       {0.3, -0.3, 0.2},
                                                       {1.15, 0.5, 0.12},
                                                       {1.4, 0.55, 0.1},
                                                       {1.3, 0.82, 0.11},
                                                       {1.55, 0.78, 0.12},
                                                       {1.5, 0.33, 0.1},
                                                       {1.72, 0.52, 0.09},
                                                       {2.3, -0.85, 0.28},
                                                       {2.5, 1.0, 0.18}}};

/// Upright walls round a polygon, as a mesh from z = -1 to 1.
void add_walls(Scene& scene, const std::vector<glm::dvec2>& corners) {
  Mesh mesh;
  for (const double z : {-1.0, 1.0})
    for (const glm::dvec2& corner : corners) mesh.positions.emplace_back(corner.x, corner.y, z);
  const auto n = static_cast<std::uint32_t>(corners.size());
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    mesh.triangles.push_back({i, j, j + n}), mesh.triangles.push_back({i, j + n, i + n});
  }
  scene.meshes.push_back(std::move(mesh));
  scene.instances.emplace_back();
  scene.instances.back().mesh = 0;
}

/// What the figures draw: a plane, the zigzag of `parity`, the box of half 0.9 by 0.6, the sphere about (0.2, 0) of radius 0.9, Cassini's ovals.
Expected<Scene> scene_of(const std::string& kind) {
  Scene scene;
  scene.materials.emplace_back();
  if (kind == "sphere") {
    scene.shapes.push_back({"sphere", Sphere{Vec3(0.2, 0.0, 0.0), 0.9}, 0});
  } else if (kind == "implicit") {
    auto function = parse_expression(ovals);
    if (!function) return fail(function.error());
    Implicit body;
    body.box = {Vec3(-2.0), Vec3(2.0)};
    body.text = ovals;
    body.function = std::move(*function);
    scene.shapes.push_back({"ovals", std::move(body), 0});
  } else if (kind == "discs") {
    for (const auto& [x, y, radius] : discs)
      scene.shapes.push_back({"disc", Sphere{Vec3(x, y, 0.0), radius}, 0});
  } else if (kind == "plane") {
    scene.shapes.push_back({"plane", Plane{Vec3(0.3, -0.2, 0.0), Vec3(-0.6, 0.8, 0.0)}, 0});
  } else if (kind == "box") {
    add_walls(scene, {{-0.9, -0.6}, {0.9, -0.6}, {0.9, 0.6}, {-0.9, 0.6}});
  } else if (kind == "parity") {
    add_walls(scene, {{-1.6, -0.9},
                      {1.6, -0.9},
                      {1.6, 0.9},
                      {0.9, 0.9},
                      {0.9, -0.3},
                      {0.3, -0.3},
                      {0.3, 0.9},
                      {-0.4, 0.9},
                      {-0.4, -0.3},
                      {-1.0, -0.3},
                      {-1.0, 0.9},
                      {-1.6, 0.9}});
  } else {
    return fail(ErrorKind::internal, fmt::format("no such kind of intersection (got {})", kind));
  }
  return scene;
}

/// Rounds a value to what a figure's slider holds.
double on_slider(double value) {
  return std::round(200.0 * value) / 200.0;
}

Json distance(const std::optional<raytrace::Hit>& hit) {
  return hit ? Json(hit->t) : Json();
}

Json ray_checks(const World& world) {
  const raytrace::Tracer tracer(world, raytrace::Accel::bvh);
  Json checks = Json::array();
  for (int i = 0; i < 24; ++i) {
    const double angle = 0.1 + 0.27 * i;
    const Vec3 from(on_slider(2.5 * std::cos(angle)), on_slider(1.4 * std::sin(angle)), 0.0);
    const Vec3 to(on_slider(1.6 * std::cos(2.3 * angle)), on_slider(1.3 * std::sin(1.7 * angle)), 0.0);
    Ray ray{from, glm::normalize(to - from), {}};
    auto hit = tracer.closest_hit(ray);
    checks.push_back({{"from", {from.x, from.y}}, {"to", {to.x, to.y}}, {"t", distance(hit)}});
    int crossings = 0;
    for (; hit; hit = tracer.closest_hit(ray)) ++crossings, ray.t.min = hit->t * (1.0 + 1e-9);
    checks.back()["crossings"] = crossings;
  }
  return checks;
}

Json triangle_checks() {
  constexpr std::array depths{2.0, 3.0, 5.0};
  Json checks = Json::array();
  for (int i = 0; i < 16; ++i) {
    Scene scene;
    scene.materials.emplace_back();
    Mesh mesh;
    Json corners = Json::array();
    for (int k = 0; k < 3; ++k) {
      const double angle = 0.4 * i + 2.1 * k + 0.3 * (i % 5) * k;
      const Vec3 corner(on_slider(1.3 * std::cos(angle) + 0.02 * i),
                        on_slider(0.9 * std::sin(angle) - 0.03 * i), depths[static_cast<std::size_t>(k)]);
      corners.push_back({corner.x, corner.y});
      mesh.positions.push_back(corner);
    }
    mesh.triangles.push_back({0, 1, 2});
    scene.meshes.push_back(std::move(mesh));
    scene.instances.emplace_back();
    const World world = make_world(scene);
    const raytrace::Tracer tracer(world, raytrace::Accel::bvh);
    checks.push_back({{"corners", std::move(corners)},
                      {"t", distance(tracer.closest_hit(Ray{Vec3(0.0), Vec3(0.0, 0.0, 1.0), {}}))}});
  }
  return checks;
}

}  // namespace

Expected<nlohmann::ordered_json> intersection_checks(const std::string& kind) {
  if (kind == "triangle") return Json{{"checks", triangle_checks()}};
  const auto scene = scene_of(kind);
  if (!scene) return fail(scene.error());
  Json json{{"checks", ray_checks(make_world(*scene))}};
  if (kind == "discs") json["discs"] = discs;
  return json;
}

}  // namespace gnomon::lab::lessons
