// Garden carpentry. A picket fence along the x axis, from x = 0 to x = length, its pickets on the +z side of
// two rails that run between posts. Every picket, rail and post is its own closed body; rails run into the
// posts, pickets stand off the rails by nothing but a hair's overlap, so that no two faces coincide.
#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/generate/generator.h"
#include "scene/generate/mesh_builder.h"
#include "scene/generate/random.h"

namespace gnomon {
namespace {

constexpr double timber_overlap = 0.002;  // metres that touching timbers run into each other

std::vector<Vec2> picket_outline(double width, double height, const std::string& top, double top_height) {
  const double w = 0.5 * width, shoulder = height - top_height;
  std::vector<Vec2> outline{{-w, 0.0}, {w, 0.0}};
  if (top == "pointed") {
    outline.insert(outline.end(), {{w, shoulder}, {0.0, height}, {-w, shoulder}});
  } else if (top == "round") {
    const double s = top_height / w;  // an ellipse's arc, w wide and top_height high
    for (const Vec2& p : arc({0.0, 0.0}, w, 0.0, pi, 12)) outline.push_back({p.x, shoulder + s * p.y});
  } else {
    outline.insert(outline.end(), {{w, height}, {-w, height}});
  }
  return outline;
}

/// None of them turns round when the outline is moved inwards.
bool keeps_its_edges(std::span<const Vec2> outline, double distance) {
  const std::vector<Vec2> moved = inset(outline, distance);
  const std::size_t n = outline.size();
  for (std::size_t i = 0; i < n; ++i)
    if (!(glm::dot(outline[(i + 1) % n] - outline[i], moved[(i + 1) % n] - moved[i]) > 0.0)) return false;
  return true;
}

Mesh pickets(const Values& v, double length) {
  Random random(v.seed());
  const double width = v.number("picket_width"), pitch = width + v.number("gap"), bevel = v.number("bevel");
  const double jitter = v.number("jitter");
  const int count = std::max(1, static_cast<int>(std::floor((length - width) / pitch)) + 1);
  const double start = 0.5 * (length - (count - 1) * pitch);
  MeshBuilder b;
  for (int i = 0; i < count; ++i) {
    const double height = v.number("height") + jitter * random.between(-0.01, 0.01);
    const double lean = jitter * random.between(-0.012, 0.012);
    const double turn = jitter * random.between(-0.03, 0.03);
    const double shift = jitter * random.between(-0.004, 0.004);
    Mat4 place =
        glm::translate(Mat4(1.0), Vec3(start + i * pitch + shift, v.number("ground_gap"), -timber_overlap));
    place = glm::rotate(place, turn, Vec3(0.0, 1.0, 0.0));
    place = glm::rotate(place, lean, Vec3(0.0, 0.0, 1.0));
    const auto outline = picket_outline(width, height, v.text("top"), v.number("top_height"));
    b.prism(outline, 0.0, v.number("picket_thickness"), bevel, place);
  }
  return b.take();
}

Mesh rails(const Values& v, double length) {
  const double height = v.number("rail_height"), thickness = v.number("rail_thickness");
  const double inside = 0.4 * v.number("post_width");  // a rail ends within its post
  const double x0 = v.flag("first_post") ? inside : 0.0, x1 = length - (v.flag("last_post") ? inside : 0.0);
  MeshBuilder b;
  for (const double y : v.list("rails")) {
    b.box({x0, y - 0.5 * height, -thickness}, {x1, y + 0.5 * height, 0.0}, v.number("bevel"));
  }
  return b.take();
}

// Posts stand behind the pickets, one at each end and the rest evenly between, each with a cap shaped like a
// low pyramid.
Mesh posts(const Values& v, double length) {
  const double width = v.number("post_width"), height = v.number("post_height");
  const int spans = std::max(1, static_cast<int>(std::lround(length / v.number("post_spacing"))));
  const double front = -4.0 * timber_overlap, back = front - width, eave = 0.015;
  MeshBuilder b;
  for (int i = v.flag("first_post") ? 0 : 1; i <= spans - (v.flag("last_post") ? 0 : 1); ++i) {
    const double x0 = (length - width) * i / spans, x1 = x0 + width;
    const auto ring = [&](double y, double out) {
      return std::vector<Vec3>{{x0 - out, y, front + out},
                               {x1 + out, y, front + out},
                               {x1 + out, y, back - out},
                               {x0 - out, y, back - out}};
    };
    const std::array shaft{ring(0.0, 0.0), ring(height, 0.0)};
    b.loft(shaft);
    const std::array cap{ring(height - timber_overlap, eave), ring(height + 0.025, eave),
                         ring(height + 0.07, -0.35 * width)};
    b.loft(cap);
  }
  return b.take();
}

Expected<GeneratedModel> make_fence(const Values& v) {
  const double length = v.number("length"), bevel = v.number("bevel");
  if (2.0 * bevel >= std::min(v.number("picket_thickness"), v.number("picket_width")))
    return fail_parameter("bevel", "must be less than half of the picket's thickness and width");
  if (!v.list("rails").empty() &&
      2.0 * bevel >= std::min(v.number("rail_thickness"), v.number("rail_height")))
    return fail_parameter("bevel", "must be less than half of the rails' thickness and height");
  const double lowest = v.number("height") - 0.01 * v.number("jitter"), room = 2.0 * bevel;
  const bool flat = v.text("top") == "flat";
  if (flat && lowest <= room) return fail_parameter("height", "leaves nothing of the lowest picket");
  if (!flat && v.number("top_height") >= lowest - room)
    return fail_parameter("top_height",
                          "must be less than the height of the lowest picket without its bevel");
  if (!keeps_its_edges(
          picket_outline(v.number("picket_width"), lowest, v.text("top"), v.number("top_height")), bevel))
    return fail_parameter("bevel", "is too large for the shape of the pickets' tops");
  if (length < v.number("post_width") + v.number("picket_width")) {
    return fail_parameter("length", "leaves no room for a post and a picket");
  }
  GeneratedModel model;
  model.parts.push_back({"picket", pickets(v, length)});
  if (!v.list("rails").empty()) model.parts.push_back({"rail", rails(v, length)});
  if (Mesh mesh = posts(v, length); !mesh.triangles.empty()) model.parts.push_back({"post", std::move(mesh)});
  return model;
}

const std::array<std::string_view, 3> fence_parts{"picket", "rail", "post"};
const std::array<std::string_view, 3> tops{"pointed", "round", "flat"};
const std::array<ParameterInfo, 19> fence_parameters{{
    length_parameter("length", 4.0, 0.1, 1000.0, "from the first post's outer side to the last one's"),
    length_parameter("height", 1.0, 0.05, 10.0, "of a picket, without the gap under it"),
    length_parameter("picket_width", 0.075, 0.005, 1.0, "of a picket"),
    length_parameter("picket_thickness", 0.02, 0.002, 0.5, "of a picket"),
    length_parameter("gap", 0.06, 0.001, 2.0, "between pickets"),
    length_parameter("ground_gap", 0.05, 0.0, 1.0, "under the pickets"),
    {"top", "", std::string("pointed"), -infinity, infinity, "shape of the pickets' tops", false, 0, 0, tops},
    length_parameter("top_height", 0.07, 0.001, 2.0, "of the pointed or round top"),
    length_parameter("bevel", 0.003, 0.0, 0.1, "chamfer of pickets and rails"),
    {"rails", "m", std::vector<double>{0.3, 0.8}, 0.0, 10.0, "heights of the rails' middles", false, 0, 10},
    length_parameter("rail_height", 0.07, 0.01, 1.0, "of a rail's section"),
    length_parameter("rail_thickness", 0.035, 0.01, 1.0, "of a rail's section"),
    length_parameter("post_width", 0.1, 0.01, 1.0, "of a post's square section"),
    length_parameter("post_height", 1.1, 0.05, 10.0, "of a post without its cap"),
    length_parameter("post_spacing", 2.0, 0.2, 100.0, "between posts, about: they are spread evenly"),
    {"first_post", "", true, -infinity, infinity, "false: another fence brings the post at x = 0"},
    {"last_post", "", true, -infinity, infinity, "false: another fence brings the post at the far end"},
    {"jitter", "", 1.0, 0.0, 4.0, "how irregular the pickets stand; 0 is perfect"},
    seed_parameter(),
}};

// ---- bench: slats on two or three frames; the sitter looks towards +z

// A slat from x = -half to half whose section is a bevelled rectangle, `thickness` along `normal` (in the z-y
// plane).
void add_slat(MeshBuilder& b, double half, const Vec2& middle, double width, double thickness, double tilt) {
  const double bevel = 0.2 * thickness;
  const double w = 0.5 * width, t = 0.5 * thickness;
  const std::array<Vec2, 4> section{{{-w, -t}, {w, -t}, {w, t}, {-w, t}}};
  // Local x runs along -z (or up the back when tilted), local y across the slat, local z along x.
  Mat4 place{Vec4(0, 0, -1, 0), Vec4(0, 1, 0, 0), Vec4(1, 0, 0, 0), Vec4(0, middle.y, middle.x, 1)};
  place = glm::rotate(place, tilt, Vec3(0.0, 0.0, 1.0));
  b.prism(section, -half, half, bevel, place);
}

Expected<GeneratedModel> make_bench(const Values& v) {
  const double half = 0.5 * v.number("length"), seat = v.number("seat_height"), slat = 0.055, gap = 0.014;
  const int frames = v.number("length") > 1.8 ? 3 : 2;
  MeshBuilder slats, wood;
  for (int i = 0; i < 6; ++i) {  // the seat, from front to back
    add_slat(slats, half, {0.21 - i * (slat + gap), seat}, slat, 0.022, 0.0);
  }
  const double lean = 1.35;  // radians from the seat's plane: a comfortable back
  const Vec2 along{-std::cos(lean), std::sin(lean)};
  for (int i = 0; i < 5; ++i) {
    const Vec2 middle = Vec2(-0.21, seat + 0.09) + (i * (slat + gap) + 0.02) * along;
    add_slat(slats, half, middle, slat, 0.022, lean);
  }
  for (int i = 0; i < frames; ++i) {
    const double x = (half - 0.08) * (2.0 * i / (frames - 1) - 1.0), w = 0.03, top = seat - 0.009;
    wood.box({x - w, -timber_overlap, 0.17}, {x + w, top, 0.23}, 0.004);                // front leg
    wood.box({x - 0.8 * w, top - 0.07, -0.2}, {x + 0.8 * w, top - 0.004, 0.2}, 0.004);  // seat bearer
    const double leg = seat + 0.46;  // the back leg leans as the back does
    const Mat4 lean_back = glm::rotate(glm::translate(Mat4(1.0), Vec3(x, -timber_overlap, -0.125)),
                                       lean - 0.5 * pi, Vec3(1, 0, 0));
    MeshBuilder back;
    back.box({-0.9 * w, 0.0, -0.055}, {0.9 * w, leg, 0.0}, 0.004);
    wood.append(back.take(), lean_back);
    if (i == 0 || i == frames - 1) {
      wood.box({x - 0.85 * w, seat - 0.02, 0.175}, {x + 0.85 * w, seat + 0.21, 0.225}, 0.004);  // arm post
      wood.box({x - 1.2 * w, seat + 0.2, -0.24}, {x + 1.2 * w, seat + 0.228, 0.25}, 0.005);     // arm rest
    }
  }
  GeneratedModel model;
  model.parts.push_back({"slat", slats.take()});
  model.parts.push_back({"frame", wood.take()});
  return model;
}

const std::array<std::string_view, 2> bench_parts{"slat", "frame"};
const std::array<ParameterInfo, 2> bench_parameters{{
    length_parameter("length", 1.5, 0.5, 20.0, "of the slats"),
    length_parameter("seat_height", 0.44, 0.2, 2.0, "of the slats' middle"),
}};

}  // namespace

std::span<const MeshGenerator> fence_generators() {
  static const std::array<MeshGenerator, 2> list{{
      {{"bench", "A garden bench of slats, its back towards -z.", bench_parameters, bench_parts}, make_bench},
      {{"fence", "A picket fence along x with rails and capped posts.", fence_parameters, fence_parts},
       make_fence},
  }};
  return list;
}

}  // namespace gnomon
