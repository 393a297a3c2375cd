// Columns and arcades, after the Tuscan order in Vignola's "Regola delli cinque ordini d'architettura"
// (1562): plinth, torus, shaft with entasis, astragal, echinus, abacus. Every stone is a closed body; stones
// that rest on each other run a few millimetres into each other, so that no two faces coincide.
#include <fmt/core.h>

#include <glm/gtc/matrix_transform.hpp>

#include "scene/generate/generator.h"
#include "scene/generate/mesh_builder.h"

namespace gnomon {
namespace {

// The turned body between plinth and abacus. All in units of the radius at the foot, heights from the ground.
std::vector<ProfilePoint> column_profile(double radius, double plinth_top, double abacus_bottom) {
  const double r = radius, y0 = plinth_top - stone_overlap, y1 = abacus_bottom + stone_overlap;
  std::vector<ProfilePoint> p{{0.0, y0}};
  const auto bulge = [&](double inner, double bottom, double height) {  // a half round
    for (const Vec2& q : arc({inner, bottom + 0.5 * height}, 0.5 * height, -0.5 * pi, 0.5 * pi, 6))
      p.push_back({q.x, q.y});
    p[p.size() - 7].crease = p.back().crease = true;
  };
  bulge(1.18 * r, y0, 0.30 * r);                                                               // torus
  p.push_back({1.12 * r, y0 + 0.30 * r, true}), p.push_back({1.12 * r, y0 + 0.40 * r, true});  // fillet
  const double foot = y0 + 0.40 * r, neck = y1 - 0.95 * r;
  p.push_back({r, foot, true});
  constexpr int steps =
      6;  // the shaft: straight for a third, then narrowing to 5/6 along a quarter of a cosine
  for (int i = 0; i < steps; ++i) {
    const double t = 1.0 / 3.0 + 2.0 / 3.0 * i / steps, lean = 1.5 * (t - 1.0 / 3.0);
    p.push_back(
        {r * (1.0 - (1.0 - 5.0 / 6.0) * (1.0 - std::cos(0.5 * pi * lean))), foot + (neck - foot) * t});
  }
  bulge(5.0 / 6.0 * r, neck, 0.16 * r);               // astragal
  p.push_back({5.0 / 6.0 * r, y1 - 0.40 * r, true});  // the neck, up to the echinus
  for (const Vec2& q : arc({0.86 * r, y1 - 0.02 * r}, 0.36 * r, -0.5 * pi, 0.0, 5)) p.push_back({q.x, q.y});
  p[p.size() - 6].crease = p.back().crease = true;
  p.push_back({1.22 * r, y1, true}), p.push_back({0.0, y1});
  return p;
}

void add_column(MeshBuilder& b, double height, double radius, int segments, const Vec3& foot) {
  const double r = radius, plinth = 0.35 * r, abacus = 0.32 * r;
  MeshBuilder column;
  column.box({-1.36 * r, -stone_overlap, -1.36 * r}, {1.36 * r, plinth, 1.36 * r}, 0.03 * r);
  column.lathe(column_profile(r, plinth, height - abacus), segments);
  column.box({-1.34 * r, height - abacus, -1.34 * r}, {1.34 * r, height, 1.34 * r}, 0.03 * r);
  b.append(column.take(), glm::translate(Mat4(1.0), foot));
}

Expected<GeneratedModel> make_column(const Values& v) {
  const double height = v.number("height"), radius = v.number("radius");
  if (height < 6.0 * radius) return fail_parameter("height", "must be at least six times the radius");
  MeshBuilder b;
  add_column(b, height, radius, v.count("segments"), Vec3(0.0));
  GeneratedModel model;
  model.parts.push_back({"column", b.take()});
  return model;
}

// ---- arcade: columns along x that carry semicircular arches

struct ArcadeShape {
  int bays;
  double bay, column, radius, arch, top, depth;
  int arch_segments;
};

// The wall's underside from left to right: flat on the columns, round over the openings.
std::vector<Vec2> underside(const ArcadeShape& a, double end) {
  std::vector<Vec2> line{{-end, a.column}};
  for (int i = 0; i < a.bays; ++i) {
    for (const Vec2& p : arc({(i + 0.5) * a.bay, a.column}, a.arch, pi, 0.0, a.arch_segments))
      line.push_back(p);
  }
  line.push_back({a.bays * a.bay + end, a.column});
  return line;
}

// A closed wall over a profiled underside: faces in vertical strips, so that it has no T-junctions.
Mesh spandrel_wall(const ArcadeShape& a, double end) {
  const std::vector<Vec2> line = underside(a, end);
  const double z = 0.5 * a.depth;
  MeshBuilder b;
  const auto quad = [&](const std::array<Vec3, 4>& c) { b.polygon(c); };
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Vec2 p = line[i], q = line[i + 1];
    quad({Vec3(p.x, p.y, z), Vec3(q.x, q.y, z), Vec3(q.x, a.top, z), Vec3(p.x, a.top, z)});
    quad({Vec3(q.x, q.y, -z), Vec3(p.x, p.y, -z), Vec3(p.x, a.top, -z), Vec3(q.x, a.top, -z)});
    quad({Vec3(p.x, p.y, -z), Vec3(q.x, q.y, -z), Vec3(q.x, q.y, z), Vec3(p.x, p.y, z)});
    quad({Vec3(p.x, a.top, z), Vec3(q.x, a.top, z), Vec3(q.x, a.top, -z), Vec3(p.x, a.top, -z)});
  }
  const Vec2 l = line.front(), r = line.back();
  quad({Vec3(l.x, l.y, -z), Vec3(l.x, l.y, z), Vec3(l.x, a.top, z), Vec3(l.x, a.top, -z)});
  quad({Vec3(r.x, r.y, z), Vec3(r.x, r.y, -z), Vec3(r.x, a.top, -z), Vec3(r.x, a.top, z)});
  return b.take();
}

// A band around each arch that stands out of the wall on both sides, and a keystone.
Mesh archivolts(const ArcadeShape& a, double width) {
  MeshBuilder b;
  const double z = 0.5 * a.depth + 0.03, inner = a.arch - stone_overlap, outer = a.arch + width;
  for (int bay = 0; bay < a.bays; ++bay) {
    const Vec2 c{(bay + 0.5) * a.bay, a.column - 0.5 * stone_overlap};
    const auto in = arc(c, inner, 0.0, pi, a.arch_segments), out = arc(c, outer, 0.0, pi, a.arch_segments);
    std::vector<std::vector<Vec3>> rings;
    for (std::size_t i = 0; i < in.size(); ++i) {
      rings.push_back({Vec3(in[i], z), Vec3(out[i], z), Vec3(out[i], -z), Vec3(in[i], -z)});
    }
    b.loft(rings);
    const double low = c.y + inner - 0.05, high = c.y + outer + 0.06, half = 0.055 * a.bay;
    const std::array<Vec2, 4> key{
        {{c.x - 0.7 * half, low}, {c.x + 0.7 * half, low}, {c.x + half, high}, {c.x - half, high}}};
    b.prism(key, -z - 0.03, z + 0.03, 0.008, Mat4(1.0));
  }
  return b.take();
}

// Three courses that step outwards, under the top edge.
Mesh cornice(const ArcadeShape& a, double end) {
  MeshBuilder b;
  const double x0 = -end, x1 = a.bays * a.bay + end;
  constexpr std::array<std::array<double, 3>, 3> courses{
      {{-0.30, -0.20, 0.05}, {-0.205, -0.10, 0.11}, {-0.105, 0.006, 0.19}}};
  for (const auto& [low, high, out] : courses) {
    b.box({x0 - out, a.top + low, -0.5 * a.depth - out}, {x1 + out, a.top + high, 0.5 * a.depth + out}, 0.01);
  }
  // The uppermost course caps the wall.
  b.box({x0 - 0.15, a.top - stone_overlap, -0.5 * a.depth - 0.15},
        {x1 + 0.15, a.top + 0.04, 0.5 * a.depth + 0.15}, 0.01);
  return b.take();
}

Expected<GeneratedModel> make_arcade(const Values& v) {
  const ArcadeShape a{v.count("bays"),           v.number("bay"),         v.number("column_height"),
                      v.number("column_radius"), v.number("arch_radius"), v.number("height"),
                      v.number("depth"),         v.count("arch_segments")};
  const double band = std::min(0.16, 0.45 * (a.bay - 2.0 * a.arch));
  if (2.0 * a.arch >= a.bay - 1.5 * a.radius)
    return fail_parameter("arch_radius", "leaves no room for the columns between");
  if (a.column < 6.0 * a.radius)
    return fail_parameter("column_height", "must be at least six times the column's radius");
  if (a.top < a.column + a.arch + band + 0.4) {
    return fail_parameter(
        "height",
        fmt::format("must exceed the arches' crown by the band and the cornice: {:.2f} m", band + 0.4));
  }
  const double end = v.number("end");
  MeshBuilder columns;
  for (int i = v.flag("first_column") ? 0 : 1; i <= a.bays - (v.flag("last_column") ? 0 : 1); ++i) {
    add_column(columns, a.column + stone_overlap, a.radius, v.count("segments"), Vec3(i * a.bay, 0.0, 0.0));
  }
  GeneratedModel model;
  if (!columns.empty()) model.parts.push_back({"column", columns.take()});
  model.parts.push_back({"wall", spandrel_wall(a, end)});
  model.parts.push_back({"archivolt", archivolts(a, band)});
  model.parts.push_back({"cornice", cornice(a, end)});
  return model;
}

const std::array<std::string_view, 1> column_parts{"column"};
const std::array<ParameterInfo, 3> column_parameters{{
    length_parameter("height", 3.0, 0.1, 100.0, "from the ground to the abacus's top"),
    length_parameter("radius", 0.2, 0.01, 10.0, "of the shaft at its foot"),
    count_parameter("segments", 32, 6, 512, "sides of the shaft"),
}};
const std::array<std::string_view, 4> arcade_parts{"column", "wall", "archivolt", "cornice"};
const std::array<ParameterInfo, 12> arcade_parameters{{
    count_parameter("bays", 5, 1, 200, "openings"),
    length_parameter("bay", 2.4, 0.3, 50.0, "between the columns' axes"),
    length_parameter("column_height", 2.6, 0.3, 50.0, "to the springing of the arches"),
    length_parameter("column_radius", 0.17, 0.02, 5.0, "of the shafts at their feet"),
    length_parameter("arch_radius", 0.98, 0.1, 20.0, "of the semicircular openings"),
    length_parameter("height", 4.4, 0.5, 100.0, "of the wall's top"),
    length_parameter("depth", 0.4, 0.05, 10.0, "of the wall"),
    length_parameter("end", 0.2, 0.0, 10.0, "how far the wall goes on past the first and last axis"),
    {"first_column", "", true, -infinity, infinity, "false: another arcade brings the column at x = 0"},
    {"last_column", "", true, -infinity, infinity, "false: another arcade brings the column at the far end"},
    count_parameter("segments", 24, 6, 512, "sides of the shafts"),
    count_parameter("arch_segments", 24, 4, 512, "segments of each arch"),
}};

}  // namespace

std::span<const MeshGenerator> architecture_generators() {
  static const std::array<MeshGenerator, 2> list{{
      {{"arcade", "Columns along x, the first at x = 0, that carry a wall of round arches with a cornice.",
        arcade_parameters, arcade_parts},
       make_arcade},
      {{"column", "A Tuscan column: square plinth, turned shaft with entasis, square abacus.",
        column_parameters, column_parts},
       make_column},
  }};
  return list;
}

}  // namespace gnomon
