// The plain generators: floor, box, turned profile, tessellated sphere.
#include <map>

#include "scene/generate/generator.h"
#include "scene/generate/mesh_builder.h"

namespace gnomon {
namespace {

GeneratedModel one_part(std::string_view name, MeshBuilder& builder) {
  GeneratedModel model;
  model.parts.push_back({std::string(name), builder.take()});
  return model;
}

// ---- floor: an open sheet at y = 0, facing up

Expected<GeneratedModel> make_floor(const Values& values) {
  const Vec2 size = values.vec2("size");
  const int nx = static_cast<int>(values.list("divisions")[0]),
            nz = static_cast<int>(values.list("divisions")[1]);
  MeshBuilder b;
  for (int k = 0; k <= nz; ++k) {
    for (int i = 0; i <= nx; ++i) {
      const Vec2 p{(static_cast<double>(i) / nx - 0.5) * size.x,
                   (static_cast<double>(k) / nz - 0.5) * size.y};
      b.vertex({p.x, 0.0, p.y}, {0.0, 1.0, 0.0}, p);
    }
  }
  const auto at = [&](int i, int k) { return static_cast<std::uint32_t>(k * (nx + 1) + i); };
  for (int k = 0; k < nz; ++k) {
    for (int i = 0; i < nx; ++i) {
      b.triangle(at(i, k), at(i, k + 1), at(i + 1, k + 1));
      b.triangle(at(i, k), at(i + 1, k + 1), at(i + 1, k));
    }
  }
  return one_part("floor", b);
}

const std::array<std::string_view, 1> floor_parts{"floor"};
const std::array<ParameterInfo, 2> floor_parameters{{
    {"size", "m", std::vector<double>{10.0, 10.0}, 1e-3, 1e6, "extent along x and z"},
    {"divisions", "", std::vector<double>{1.0, 1.0}, 1.0, 2000.0, "quads along x and z", true},
}};

// ---- box: foot at y = 0, closed

Expected<GeneratedModel> make_box(const Values& values) {
  const Vec3 size = values.vec3("size");
  const double bevel = values.number("bevel");
  if (2.0 * bevel >= std::min({size.x, size.y, size.z})) {
    return fail_parameter("bevel", "must be less than half of the box's smallest side");
  }
  MeshBuilder b;
  b.box({-0.5 * size.x, 0.0, -0.5 * size.z}, {0.5 * size.x, size.y, 0.5 * size.z}, bevel);
  return one_part("box", b);
}

const std::array<std::string_view, 1> box_parts{"box"};
const std::array<ParameterInfo, 2> box_parameters{{
    {"size", "m", std::vector<double>{1.0, 1.0, 1.0}, 1e-6, 1e6, "extent along x, y and z"},
    length_parameter("bevel", 0.0, 0.0, 1e6, "width that the chamfers take off each edge"),
}};

// ---- lathe: any turned thing: pots, basins, posts

Expected<GeneratedModel> make_lathe(const Values& values) {
  const std::vector<double>& p = values.list("profile");
  const std::vector<double>& creases = values.list("creases");
  if (p.size() % 2 != 0)
    return fail_parameter("profile", "needs radius and height in turn: an even number of elements");
  std::vector<ProfilePoint> profile;
  for (std::size_t i = 0; i < p.size(); i += 2) {
    const ProfilePoint point{p[i], p[i + 1]};
    if (point.radius < 0.0) return fail_parameter("profile", "radii must not be negative");
    if (!profile.empty() && profile.back().radius == point.radius && profile.back().height == point.height) {
      return fail_parameter("profile", "holds the same point twice in a row");
    }
    if (!profile.empty() && profile.back().radius == 0.0 && point.radius == 0.0) {
      return fail_parameter("profile", "runs along its own axis");
    }
    profile.push_back(point);
  }
  for (const double c : creases) {
    if (c >= static_cast<double>(profile.size()))
      return fail_parameter("creases", "names a point that the profile lacks");
    profile[static_cast<std::size_t>(c)].crease = true;
  }
  MeshBuilder b;
  b.lathe(profile, values.count("segments"));
  return one_part("lathe", b);
}

const std::array<std::string_view, 1> lathe_parts{"lathe"};
const std::array<ParameterInfo, 3> lathe_parameters{{
    {"profile", "m", std::vector<double>{0.0, 0.0, 0.5, 0.0, 0.5, 1.0, 0.0, 1.0}, -1e4, 1e4,
     "radius and height in turn, from the axis at the foot, up the outer side, back to the axis", false, 4,
     400},
    {"creases", "", std::vector<double>{}, 0.0, 199.0, "points, from 0, where the surface has an edge", true,
     0, 200},
    count_parameter("segments", 48, 3, 1000, "sides of the turned body"),
}};

// ---- sphere: a subdivided icosahedron, to set beside the exact one

using Edge = std::pair<std::uint32_t, std::uint32_t>;

struct Icosphere {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;

  Icosphere() {
    const double g = std::numbers::phi;
    for (const double s : {-1.0, 1.0}) {
      for (const double t : {-g, g}) {
        points.push_back(glm::normalize(Vec3(0.0, s, t)));
        points.push_back(glm::normalize(Vec3(s, t, 0.0)));
        points.push_back(glm::normalize(Vec3(t, 0.0, s)));
      }
    }
    // Two corners of the icosahedron are neighbours when their dot product is 1/sqrt(5).
    const auto near = [&](std::uint32_t a, std::uint32_t b) { return glm::dot(points[a], points[b]) > 0.4; };
    for (std::uint32_t a = 0; a < 12; ++a) {
      for (std::uint32_t b = a + 1; b < 12; ++b) {
        for (std::uint32_t c = b + 1; c < 12; ++c) {
          if (!near(a, b) || !near(b, c) || !near(a, c)) continue;
          const bool outward =
              glm::dot(glm::cross(points[b] - points[a], points[c] - points[a]), points[a]) > 0.0;
          triangles.push_back(outward ? std::array{a, b, c} : std::array{a, c, b});
        }
      }
    }
  }

  void subdivide() {
    std::map<Edge, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [it, fresh] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(points.size()));
      if (fresh) points.push_back(glm::normalize(points[a] + points[b]));
      return it->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    triangles = std::move(finer);
  }
};

Expected<GeneratedModel> make_sphere(const Values& values) {
  Icosphere sphere;
  for (int i = 0; i < values.count("subdivisions"); ++i) sphere.subdivide();
  const double radius = values.number("radius");
  MeshBuilder b;
  for (const Vec3& p : sphere.points) {
    const Vec2 uv{0.5 + std::atan2(p.x, p.z) / (2.0 * pi), std::acos(std::clamp(p.y, -1.0, 1.0)) / pi};
    b.vertex(radius * p + Vec3(0.0, radius, 0.0), p, uv);
  }
  for (const auto& [i, j, k] : sphere.triangles) b.triangle(i, j, k);
  return one_part("sphere", b);
}

const std::array<std::string_view, 1> sphere_parts{"sphere"};
const std::array<ParameterInfo, 2> sphere_parameters{{
    length_parameter("radius", 0.5, 1e-6, 1e6, "radius; the corners lie on the true sphere"),
    count_parameter("subdivisions", 4, 0, 8, "each multiplies the 20 triangles by 4"),
}};

}  // namespace

std::span<const MeshGenerator> basic_generators() {
  static const std::array<MeshGenerator, 4> list{{
      {{"floor", "A flat rectangle at y = 0 that faces up, not closed.", floor_parameters, floor_parts},
       make_floor},
      {{"box", "A box that stands on y = 0, with or without chamfered edges.", box_parameters, box_parts},
       make_box},
      {{"lathe", "A profile turned about the y axis.", lathe_parameters, lathe_parts}, make_lathe},
      {{"sphere",
        "A tessellated sphere that rests on y = 0; texture coordinates are longitude and colatitude.",
        sphere_parameters, sphere_parts},
       make_sphere},
  }};
  return list;
}

}  // namespace gnomon
