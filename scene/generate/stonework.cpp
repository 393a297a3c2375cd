// Balustrades, stairs and windows. Closed bodies that run a few millimetres into what they rest on.
#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/generate/generator.h"
#include "scene/generate/mesh_builder.h"

namespace gnomon {
namespace {

// ---- balustrade along x, from 0 to length: pedestals, turned balusters, a base and a hand rail

// A vase-shaped baluster of unit height, its widest radius 0.16: pairs of radius and height from foot to
// head.
constexpr std::array<std::array<double, 2>, 15> baluster{{{0.0, 0.0},
                                                          {0.15, 0.0},
                                                          {0.15, 0.08},
                                                          {0.10, 0.11},
                                                          {0.085, 0.15},
                                                          {0.11, 0.21},
                                                          {0.15, 0.29},
                                                          {0.16, 0.36},
                                                          {0.14, 0.45},
                                                          {0.10, 0.56},
                                                          {0.072, 0.68},
                                                          {0.065, 0.80},
                                                          {0.10, 0.86},
                                                          {0.14, 1.0},
                                                          {0.0, 1.0}}};

Mesh one_baluster(double height, int segments) {
  std::vector<ProfilePoint> profile;
  for (const auto& [radius, y] : baluster) profile.push_back({height * radius, height * y});
  for (const std::size_t crease : {1, 2, 3, 12, 13}) profile[crease].crease = true;
  MeshBuilder b;
  b.lathe(profile, segments);
  return b.take();
}

Expected<GeneratedModel> make_balustrade(const Values& v) {
  const double length = v.number("length"), height = v.number("height"),
               pedestal = v.number("pedestal_width");
  const double depth = 0.75 * pedestal, rail = 0.14 * height, base = 0.12 * height;
  const int spans = std::max(1, static_cast<int>(std::lround(length / v.number("pedestal_spacing"))));
  const double pitch = (length - pedestal) / spans, clear = pitch - pedestal;
  if (clear < v.number("spacing"))
    return fail_parameter("length", "leaves no room for a baluster between the pedestals");
  const double bevel = std::min({0.01 * height, 0.1 * pedestal, 0.1 * clear});
  MeshBuilder pedestals, rails, balusters;
  for (int i = 0; i <= spans; ++i) {
    const double x = 0.5 * pedestal + i * pitch, w = 0.5 * pedestal;
    pedestals.box({x - w, -stone_overlap, -w}, {x + w, height, w}, bevel);
    pedestals.box({x - 1.14 * w, height - stone_overlap, -1.14 * w},
                  {x + 1.14 * w, height + 0.06 * height, 1.14 * w}, bevel);
    pedestals.box({x - 1.1 * w, -2.0 * stone_overlap, -1.1 * w}, {x + 1.1 * w, 0.1 * height, 1.1 * w}, bevel);
  }
  const Mesh one = one_baluster(height - rail - base + 2.0 * stone_overlap, v.count("segments"));
  for (int i = 0; i < spans; ++i) {
    const double x0 = pedestal + i * pitch - stone_overlap, x1 = x0 + clear + 2.0 * stone_overlap;
    rails.box({x0, -1.5 * stone_overlap, -0.45 * depth}, {x1, base, 0.45 * depth}, bevel);
    rails.box({x0, height - rail, -0.5 * depth}, {x1, height - 0.02 * height, 0.5 * depth}, bevel);
    const int count = std::max(1, static_cast<int>(std::floor(clear / v.number("spacing"))));
    for (int k = 0; k < count; ++k) {
      const double x = pedestal + i * pitch + clear * (k + 0.5) / count;
      balusters.append(one, glm::translate(Mat4(1.0), Vec3(x, base - stone_overlap, 0.0)));
    }
  }
  GeneratedModel model;
  model.parts.push_back({"pedestal", pedestals.take()});
  model.parts.push_back({"rail", rails.take()});
  model.parts.push_back({"baluster", balusters.take()});
  return model;
}

const std::array<std::string_view, 3> balustrade_parts{"pedestal", "rail", "baluster"};
const std::array<ParameterInfo, 6> balustrade_parameters{{
    length_parameter("length", 6.0, 0.3, 1000.0, "from the first pedestal's outer side to the last one's"),
    length_parameter("height", 0.9, 0.1, 10.0, "of the pedestals, without their caps"),
    length_parameter("spacing", 0.26, 0.02, 5.0, "between balusters, about: they are spread evenly"),
    length_parameter("pedestal_width", 0.3, 0.05, 5.0, "of a pedestal's square section"),
    length_parameter("pedestal_spacing", 3.0, 0.2, 100.0, "between pedestals, about: they are spread evenly"),
    count_parameter("segments", 14, 4, 256, "sides of a baluster"),
}};

// ---- stairs: they climb towards -z, the first riser at z = 0, each tread a slab that overhangs its riser

// The body below the treads: side faces fan from corners that leave no triangle flat, so that it closes
// without T-junctions.
Mesh stair_body(int steps, double rise, double tread, double width, double drop) {
  MeshBuilder b;
  const double x = 0.5 * width;
  for (int i = 0; i < steps; ++i) {
    const double z0 = -i * tread, z1 = -(i + 1) * tread;
    const double below = i == 0 ? -stone_overlap : i * rise - drop, y = (i + 1) * rise - drop;
    const double foot = -stone_overlap;
    const auto quad = [&](const std::array<Vec3, 4>& c) { b.polygon(c); };
    quad({Vec3(-x, below, z0), Vec3(x, below, z0), Vec3(x, y, z0), Vec3(-x, y, z0)});
    quad({Vec3(-x, y, z0), Vec3(x, y, z0), Vec3(x, y, z1), Vec3(-x, y, z1)});
    quad({Vec3(-x, foot, z1), Vec3(x, foot, z1), Vec3(x, foot, z0), Vec3(-x, foot, z0)});
    std::vector<Vec3> right{Vec3(x, foot, z1), Vec3(x, y, z1), Vec3(x, y, z0)};
    if (i > 0) right.emplace_back(x, below, z0);
    right.emplace_back(x, foot, z0);
    b.polygon(right);
    std::vector<Vec3> left{Vec3(-x, foot, z1), Vec3(-x, foot, z0)};
    if (i > 0) left.emplace_back(-x, below, z0);
    left.insert(left.end(), {Vec3(-x, y, z0), Vec3(-x, y, z1)});
    b.polygon(left);
  }
  const double z = -steps * tread, y = steps * rise - drop;
  const std::array<Vec3, 4> back{Vec3(x, -stone_overlap, z), Vec3(-x, -stone_overlap, z), Vec3(-x, y, z),
                                 Vec3(x, y, z)};
  b.polygon(back);
  return b.take();
}

Expected<GeneratedModel> make_stairs(const Values& v) {
  const int steps = v.count("steps");
  const double rise = v.number("rise"), tread = v.number("tread"), width = v.number("width");
  const double slab = 0.3 * rise, nose = v.number("nosing");
  const double bevel = std::min({0.06 * rise, 0.2 * tread, 0.2 * width});
  MeshBuilder treads;
  for (int i = 0; i < steps; ++i) {
    const double y = (i + 1) * rise, z0 = -i * tread + nose;
    // The next tread's riser stands on this slab; the last one ends with the body.
    const double z1 = -(i + 1) * tread - (i + 1 < steps ? 0.25 * tread : 0.0);
    treads.box({-0.5 * width - nose, y - slab, z1 - stone_overlap}, {0.5 * width + nose, y, z0}, bevel);
  }
  GeneratedModel model;
  model.parts.push_back({"riser", stair_body(steps, rise, tread, width, 0.5 * slab)});
  model.parts.push_back({"tread", treads.take()});
  return model;
}

const std::array<std::string_view, 2> stairs_parts{"riser", "tread"};
const std::array<ParameterInfo, 5> stairs_parameters{{
    count_parameter("steps", 4, 1, 500, "treads"),
    length_parameter("rise", 0.16, 0.02, 5.0, "of one step"),
    length_parameter("tread", 0.32, 0.02, 5.0, "depth of one step"),
    length_parameter("width", 3.0, 0.05, 500.0, "along x, without the treads' overhang"),
    length_parameter("nosing", 0.02, 0.001, 0.5, "overhang of the treads in front and at the sides"),
}};

// ---- window: frame, pane and shutters before a wall whose face is z = 0

constexpr double stile = 0.05;  // metres, the width of a shutter's upright

// An open shutter from x = left to right, flat against the wall: two stiles and slats that lean.
void add_shutter(MeshBuilder& b, double left, double right, double height) {
  const double back = 0.004, front = 0.022, foot = 0.01, head = height - 0.01;
  b.box({left, foot, back}, {left + stile, head, front});
  b.box({right - stile, foot, back}, {right, head, front});
  const int slats = std::max(2, static_cast<int>(height / 0.075));
  // The slats' section lies in the (z, y) plane and is drawn along -x.
  const Mat4 place{Vec4(0, 0, 1, 0), Vec4(0, 1, 0, 0), Vec4(-1, 0, 0, 0), Vec4(0, 0, 0, 1)};
  for (int i = 0; i < slats; ++i) {
    const double y = 0.05 + (height - 0.1) * (i + 0.5) / slats;
    const std::array<Vec2, 4> section{
        {{0.016, y - 0.02}, {0.020, y - 0.02}, {0.010, y + 0.02}, {0.006, y + 0.02}}};
    b.prism(section, -(right - stile + stone_overlap), -(left + stile - stone_overlap), 0.0, place);
  }
}

void add_window_frame(MeshBuilder& b, double w, double h, double f, double proud) {
  const double bevel = 0.1 * std::min(f, proud), ledge = w + 1.4 * f;
  b.box({-w - f, h - stone_overlap, -stone_overlap}, {w + f, h + f, proud}, bevel);  // lintel
  b.box({-ledge, h + f - stone_overlap, -stone_overlap}, {ledge, h + 1.5 * f, 1.5 * proud},
        bevel);                                                                   // drip mould
  b.box({-ledge, -0.7 * f, -stone_overlap}, {ledge, 0.0, 1.6 * proud}, bevel);    // sill
  b.box({-w - f, -stone_overlap, -stone_overlap}, {-w, h, 0.96 * proud}, bevel);  // jambs
  b.box({w, -stone_overlap, -stone_overlap}, {w + f, h, 0.96 * proud}, bevel);
}

Expected<GeneratedModel> make_window(const Values& v) {
  const double w = 0.5 * v.number("width"), h = v.number("height"), f = v.number("frame");
  const double proud = v.number("depth"), shutter = 0.9 * w, hinge = w + f + 0.02;
  if (v.flag("shutters") && shutter < 3.0 * stile) {
    return fail_parameter("width", "must be at least 0.34 m for a window with shutters");
  }
  MeshBuilder frame, pane, shutters;
  add_window_frame(frame, w, h, f, proud);
  pane.box({-w - stone_overlap, -stone_overlap, -stone_overlap},
           {w + stone_overlap, h + 0.5 * stone_overlap, 0.25 * proud});
  if (v.flag("shutters")) {
    add_shutter(shutters, -hinge - shutter, -hinge, h);
    add_shutter(shutters, hinge, hinge + shutter, h);
  }
  GeneratedModel model;
  model.parts.push_back({"frame", frame.take()});
  model.parts.push_back({"pane", pane.take()});
  if (!shutters.empty()) model.parts.push_back({"shutter", shutters.take()});
  return model;
}

const std::array<std::string_view, 3> window_parts{"frame", "pane", "shutter"};
const std::array<ParameterInfo, 5> window_parameters{{
    length_parameter("width", 0.9, 0.1, 20.0, "of the opening"),
    length_parameter("height", 1.5, 0.2, 20.0, "of the opening, which begins at y = 0"),
    length_parameter("frame", 0.14, 0.02, 2.0, "width of the frame"),
    length_parameter("depth", 0.07, 0.01, 1.0, "how far the frame stands out of the wall"),
    {"shutters", "", true, -infinity, infinity, "an open shutter on each side"},
}};

}  // namespace

std::span<const MeshGenerator> stonework_generators() {
  static const std::array<MeshGenerator, 3> list{{
      {{"balustrade", "Turned balusters between pedestals along x, with a base and a hand rail.",
        balustrade_parameters, balustrade_parts},
       make_balustrade},
      {{"stairs", "Steps that climb towards -z from a first riser at z = 0.", stairs_parameters,
        stairs_parts},
       make_stairs},
      {{"window", "A window before a wall's face at z = 0: frame, pane, open shutters.", window_parameters,
        window_parts},
       make_window},
  }};
  return list;
}

}  // namespace gnomon
