#include "lab/lessons/flatland.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <optional>

#include "raytrace/frame.h"
#include "raytrace/shading/fresnel.h"
#include "report/pixels/page_data.h"
#include "scene/load.h"

namespace gnomon::lab::lessons {

namespace {

using Json = nlohmann::ordered_json;

struct Flatland {
  std::string_view name, scene;
  CutPlane plane;
  CutWindow window;
};

// The sun of acne-floor stands at an azimuth of 35 degrees; the plane holds its direction.
constexpr double floor_azimuth = 35.0 * pi / 180.0;

std::array<Flatland, 7> all_flatlands() {
  const Vec3 to_sun(std::sin(floor_azimuth), 0.0, std::cos(floor_azimuth));
  const Vec3 through_balls =
      glm::normalize(Vec3(1.4, 0.0, -2.0));  // from the centre of glass to that of the mirror
  return {{{"boxes", "floating-box", {}, {-2.9, 3.3, -0.35, 1.75}},
           {"wall", "thin-wall", {}, {-2.2, 1.2, -0.3, 1.25}},
           {"floor", "acne-floor", {Vec3(0.0), to_sun}, {-3.0, 3.0, -0.6, 2.4}},
           {"leak", "thin-wall", {}, {-2.2, 1.2, -0.3, 1.25}},
           {"ball", "sphere-plane", {}, {-2.0, 3.0, -0.3, 2.3}},
           {"disc", "penumbra", {}, {-4.2, 4.2, -0.5, 4.6}},
           {"whitted", "whitted", {Vec3(-0.45, 0.0, 1.6), through_balls}, {-3.6, 4.6, -0.4, 4.2}}}};
}

/// The cut as it is made: everything in the plane's coordinates.
class Cut {
 public:
  Cut(const CutPlane& plane, const CutWindow& window)
      : plane_(plane), window_(window), across_(glm::cross(plane.right, Vec3(0.0, 1.0, 0.0))) {}

  double height(const Vec3& p) const { return glm::dot(across_, p - plane_.origin); }
  glm::dvec2 flat(const Vec3& v) const { return {glm::dot(plane_.right, v), v.y}; }
  glm::dvec2 place(const Vec3& p) const { return flat(p - plane_.origin); }

  void triangle(const std::array<Vec3, 3>& corners) {
    std::vector<glm::dvec2> ends;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 &a = corners[i], &b = corners[(i + 1) % 3];
      const double from = height(a), to = height(b);
      if ((from < 0.0) != (to < 0.0)) ends.push_back(place(a + (b - a) * (from / (from - to))));
    }
    const Vec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    if (ends.size() == 2) segment(ends[0], ends[1], flat(normal));
  }

  void sphere(const Sphere& sphere) {
    const double away = height(sphere.center);
    if (std::abs(away) >= sphere.radius) return;
    const glm::dvec2 center = place(sphere.center);
    circles_.push_back({center.x, center.y, std::sqrt(sphere.radius * sphere.radius - away * away)});
  }

  void plane(const Plane& shape) {
    const glm::dvec2 normal = flat(shape.normal), through = place(shape.point);
    if (normal.y == 0.0) return;  // upright: no flatland has one
    const auto at = [&](double x) {
      return glm::dvec2(x, through.y - (x - through.x) * normal.x / normal.y);
    };
    segment(at(window_.left), at(window_.right), normal);
  }

  Json json() const { return {{"segments", segments_}, {"circles", circles_}}; }

 private:
  void segment(glm::dvec2 a, glm::dvec2 b, const glm::dvec2& normal) {
    const double size = glm::length(normal);
    if (a == b || size == 0.0) return;
    for (const double side : {window_.left, window_.right}) {
      const double sign = side == window_.left ? 1.0 : -1.0, of_a = sign * (a.x - side),
                   of_b = sign * (b.x - side);
      if (of_a < 0.0 && of_b < 0.0) return;
      if (of_a < 0.0) a = a + (b - a) * (of_a / (of_a - of_b)), a.x = side;
      if (of_b < 0.0) b = b + (a - b) * (of_b / (of_b - of_a)), b.x = side;
    }
    if (a != b) segments_.push_back({a.x, a.y, b.x, b.y, normal.x / size, normal.y / size});
  }

  CutPlane plane_;
  CutWindow window_;
  Vec3 across_;
  Json segments_ = Json::array(), circles_ = Json::array();
};

Json light_json(const Light& light, const Cut& cut) {
  Json json = Json::object();
  const bool is_sun = light.type == LightType::directional;
  const glm::dvec2 flat = is_sun ? glm::normalize(cut.flat(light.direction)) : cut.place(light.position);
  json[is_sun ? "direction" : "position"] = {flat.x, flat.y};
  json["radius"] = is_sun ? 0.0 : shape_size(light.extent);
  return json;
}

}  // namespace

nlohmann::ordered_json cut_world(const World& world, const CutPlane& plane, const CutWindow& window) {
  Cut cut(plane, window);
  const report::SectionMesh mesh = report::section_mesh(world);
  for (const auto& [a, b, c] : mesh.triangles)
    cut.triangle({mesh.positions[a], mesh.positions[b], mesh.positions[c]});
  for (const Shape& shape : world.shapes) {
    if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) cut.sphere(*sphere);
    if (const auto* flat = std::get_if<Plane>(&shape.geometry)) cut.plane(*flat);
  }
  return cut.json();
}

Expected<nlohmann::ordered_json> flatland(const std::string& name) {
  const auto all = all_flatlands();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Flatland& f) { return f.name == name; });
  if (found == all.end()) return fail(ErrorKind::internal, fmt::format("no such flatland (got {})", name));
  const auto scene = load_scene(std::string(found->scene));
  if (!scene) return fail(scene.error());
  const World world = make_world(*scene);
  Json json = cut_world(world, found->plane, found->window);
  const CutWindow& w = found->window;
  json["scene"] = found->scene;
  json["window"] = {w.left, w.right, w.bottom, w.top};
  json["light"] = light_json(scene->lights.front(), Cut(found->plane, w));
  return json;
}

Expected<nlohmann::ordered_json> whitted_cut() {
  auto json = flatland("whitted");
  if (!json) return json;
  const auto scene = load_scene("whitted");
  if (!scene) return fail(scene.error());
  (*json)["materials"] = Json::array();
  for (const Shape& shape : scene->shapes) {
    const Material& m = scene->materials[shape.material];
    if (std::holds_alternative<Sphere>(shape.geometry))
      (*json)["materials"].push_back(
          {{"name", shape.name}, {"mirror", m.mirror}, {"transmission", m.transmission}, {"ior", m.ior}});
  }
  (*json)["least_share"] = raytrace::RaytraceOptions{}.min_contribution;
  (*json)["fresnel"] = Json::array();
  for (const double ratio : {1.0 / 1.5, 1.5, 1.0 / 1.33})
    for (const double cosine : {1.0, 0.9, 0.75, 0.7, 0.3, 0.01}) {
      const Vec3 incoming(std::sqrt(1.0 - cosine * cosine), -cosine, 0.0);
      const auto made = raytrace::refract(incoming, Vec3(0.0, 1.0, 0.0), ratio);
      (*json)["fresnel"].push_back({{"cosine", cosine}, {"ratio", ratio}, {"reflected", made.reflectance}});
    }
  return json;
}

}  // namespace gnomon::lab::lessons
