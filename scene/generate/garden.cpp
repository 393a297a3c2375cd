// Things of a garden floor: flagstones, stepping stones, tufts of grass. Stones are closed bodies that reach
// below y = 0, so that the ground hides their feet; grass blades are open.
#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/generate/generator.h"
#include "scene/generate/mesh_builder.h"
#include "scene/generate/random.h"

namespace gnomon {
namespace {

// A stone with vertical sides from y = bottom to top, its upper edge chamfered; outline counter-clockwise in
// (x, -z).
void add_stone(MeshBuilder& b, std::span<const Vec2> outline, double bottom, double top, double bevel,
               const Mat4& place) {
  const std::vector<Vec2> upper = inset(outline, bevel);
  const auto ring = [&](std::span<const Vec2> points, double y) {
    std::vector<Vec3> out;
    for (const Vec2& p : points) out.emplace_back(place * Vec4(p.x, y, -p.y, 1.0));
    return out;
  };
  const std::array rings{ring(outline, bottom), ring(outline, top - bevel), ring(upper, top)};
  b.loft(rings);
}

// ---- paving: rows of flags across z, every other row shifted, cut to the rectangle

Expected<GeneratedModel> make_paving(const Values& v) {
  const Vec2 size = v.vec2("size"), flag = v.vec2("flag");
  const double joint = v.number("joint"), jitter = v.number("jitter"), bevel = v.number("bevel");
  const double thickness = v.number("thickness"), rise = v.number("rise");
  const int rows = std::max(1, static_cast<int>(std::lround(size.y / flag.y)));
  const double depth = size.y / rows, least = joint + 3.0 * bevel;
  if (std::min({flag.x, flag.y, size.x, depth}) <= joint + 2.5 * bevel)
    return fail_parameter("joint", "leaves nothing of the flags");
  if (thickness <= bevel + 0.003 * jitter)
    return fail_parameter("thickness", "must exceed the bevel, and with jitter by 3 mm more");
  Random random(v.seed());
  MeshBuilder b;
  for (int row = 0; row < rows; ++row) {
    double x = -0.5 * size.x;
    double width = flag.x * (row % 2 ? 0.55 : 1.0);
    while (x < 0.5 * size.x - 1e-9 * size.x) {
      const double wanted = width * (1.0 + 0.18 * jitter * random.between(-1.0, 1.0));
      double next = std::min(x + std::max(wanted, least), 0.5 * size.x);
      if (0.5 * size.x - next < std::max(least, 0.25 * flag.x)) next = 0.5 * size.x;
      const Vec2 half{0.5 * (next - x - joint), 0.5 * (depth - joint)};
      const double top = rise + jitter * random.between(-0.003, 0.003);
      const double turn = jitter * random.between(-0.004, 0.004);
      Mat4 place = glm::translate(Mat4(1.0), Vec3(0.5 * (x + next), 0.0, (row + 0.5) * depth - 0.5 * size.y));
      place = glm::rotate(place, turn, Vec3(0.0, 1.0, 0.0));
      const std::array<Vec2, 4> outline{
          {{-half.x, -half.y}, {half.x, -half.y}, {half.x, half.y}, {-half.x, half.y}}};
      add_stone(b, outline, rise - thickness, top, bevel, place);
      x = next;
      width = flag.x;
    }
  }
  GeneratedModel model;
  model.parts.push_back({"stone", b.take()});
  return model;
}

const std::array<std::string_view, 1> stone_parts{"stone"};
const std::array<ParameterInfo, 8> paving_parameters{{
    {"size", "m", std::vector<double>{1.4, 6.0}, 0.05, 200.0, "extent along x and z"},
    {"flag", "m", std::vector<double>{0.55, 0.4}, 0.02, 10.0, "a flagstone's extent along x and z, about"},
    length_parameter("joint", 0.015, 0.0, 0.5, "gap between flags"),
    length_parameter("thickness", 0.06, 0.005, 1.0, "of the flags"),
    length_parameter("rise", 0.02, -1.0, 1.0, "height of the flags' upper side"),
    length_parameter("bevel", 0.006, 0.001, 0.1, "chamfer of the upper edges"),
    {"jitter", "", 1.0, 0.0, 3.0, "how irregular the flags are; 0 is perfect"},
    seed_parameter(),
}};

// ---- stepping stones: rounded irregular slabs along z

Expected<GeneratedModel> make_stepping_stones(const Values& v) {
  Random random(v.seed());
  const double radius = v.number("radius"), sway = v.number("sway");
  const int count = v.count("count");
  MeshBuilder b;
  for (int i = 0; i < count; ++i) {
    const double along = (i - 0.5 * (count - 1)) * v.number("spacing");
    const double across = sway * std::sin(0.9 * i + random.between(-0.3, 0.3));
    const double size = radius * random.between(0.85, 1.15), aspect = random.between(0.72, 0.95);
    // Equal angles on a superellipse: convex for any exponent from 1 on.
    constexpr int sides = 18;
    const double power = random.between(2.1, 2.8), shift = random.between(0.0, 1.0);
    std::vector<Vec2> outline;
    for (int s = 0; s < sides; ++s) {
      const double angle = 2.0 * pi * (s + shift) / sides;
      const double c = std::cos(angle), d = std::sin(angle);
      const double r = std::pow(std::pow(std::abs(c), power) + std::pow(std::abs(d), power), -1.0 / power);
      outline.push_back(size * r * Vec2(c, aspect * d));
    }
    const Mat4 place = glm::rotate(glm::translate(Mat4(1.0), Vec3(across, 0.0, along)),
                                   random.between(0.0, pi), Vec3(0.0, 1.0, 0.0));
    const double bevel = std::min(0.35 * v.number("rise"), 0.15 * size * aspect);
    add_stone(b, outline, -0.05, v.number("rise") * random.between(0.7, 1.3), bevel, place);
  }
  GeneratedModel model;
  model.parts.push_back({"stone", b.take()});
  return model;
}

const std::array<ParameterInfo, 6> stepping_parameters{{
    count_parameter("count", 7, 1, 1000, "stones"),
    length_parameter("spacing", 0.62, 0.05, 10.0, "between the stones' middles along z"),
    length_parameter("radius", 0.24, 0.05, 5.0, "of a stone, about"),
    length_parameter("rise", 0.035, 0.005, 1.0, "height above the ground, about"),
    length_parameter("sway", 0.12, 0.0, 10.0, "how far the row winds to both sides"),
    seed_parameter(),
}};

// ---- grass: bent blades in clumps

void add_blade(MeshBuilder& b, const Vec3& foot, double height, double width, double heading, double lean) {
  const Vec3 along{std::cos(heading), 0.0, std::sin(heading)}, across{-along.z, 0.0, along.x};
  const Vec3 middle = foot + Vec3(0.0, 0.6 * height, 0.0) + 0.3 * lean * height * along;
  const Vec3 tip = foot + Vec3(0.0, (1.0 - 0.35 * lean) * height, 0.0) + lean * height * along;
  const Vec3 w = 0.5 * width * across;
  const Vec3 n0 = glm::normalize(glm::cross(across, middle - foot)),
             n1 = glm::normalize(glm::cross(across, tip - foot));
  const std::uint32_t a = b.vertex(foot - w, n0, {0.0, 1.0}), c = b.vertex(foot + w, n0, {1.0, 1.0});
  const std::uint32_t d = b.vertex(middle + 0.8 * w, n1, {1.0, 0.4}),
                      e = b.vertex(middle - 0.8 * w, n1, {0.0, 0.4});
  const std::uint32_t f = b.vertex(tip, n1, {0.5, 0.0});
  b.triangle(a, c, d);
  b.triangle(a, d, e);
  b.triangle(e, d, f);
}

Expected<GeneratedModel> make_grass(const Values& v) {
  Random random(v.seed());
  const Vec2 size = v.vec2("size");
  const double clump = v.number("clump_radius");
  constexpr int per_clump = 9;
  MeshBuilder b;
  Vec3 middle{0.0};
  for (int i = 0; i < v.count("blades"); ++i) {
    if (i % per_clump == 0) {
      middle = {size.x * random.between(-0.5, 0.5), 0.0, size.y * random.between(-0.5, 0.5)};
    }
    const Vec3 off = random.in_ball();
    const double height = v.number("height") * random.between(0.45, 1.0);
    const double lean = random.between(0.1, 0.8), heading = random.between(0.0, 2.0 * pi);
    add_blade(b, middle + clump * Vec3(off.x, 0.0, off.z) - Vec3(0.0, 0.002, 0.0), height, v.number("width"),
              heading, lean);
  }
  GeneratedModel model;
  model.parts.push_back({"blade", b.take()});
  return model;
}

const std::array<std::string_view, 1> grass_parts{"blade"};
const std::array<ParameterInfo, 6> grass_parameters{{
    {"size", "m", std::vector<double>{1.0, 1.0}, 0.0, 200.0, "extent along x and z of the clumps' middles"},
    count_parameter("blades", 900, 1, 500000, "blades, three triangles each"),
    length_parameter("height", 0.09, 0.005, 3.0, "of the longest blade"),
    length_parameter("width", 0.006, 0.0005, 0.2, "of a blade at its foot"),
    length_parameter("clump_radius", 0.05, 0.0, 2.0, "of the clumps that blades grow in, nine to each"),
    seed_parameter(),
}};

}  // namespace

std::span<const MeshGenerator> garden_generators() {
  static const std::array<MeshGenerator, 3> list{{
      {{"paving", "Flagstones in shifted rows over a rectangle, each its own closed stone.",
        paving_parameters, stone_parts},
       make_paving},
      {{"stepping_stones", "A winding row of rounded slabs along z.", stepping_parameters, stone_parts},
       make_stepping_stones},
      {{"grass", "Clumps of bent grass blades, open; texture coordinates run 0 to 1 on each blade.",
        grass_parameters, grass_parts},
       make_grass},
  }};
  return list;
}

}  // namespace gnomon
