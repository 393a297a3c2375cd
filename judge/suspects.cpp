#include "judge/suspects.h"

#include <fmt/core.h>

namespace gnomon::judge {
namespace {

void add_flips(std::vector<Suspect>& out) {
  constexpr std::array names{"is upside down", "is mirrored left to right", "is turned by half a turn"};
  for (const bool alone : {false, true})
    for (int k = 0; k < 3; ++k) {
      Suspect suspect;
      suspect.what = fmt::format("{} {}{}", alone ? "the shadow's picture" : "the picture",
                                 names[static_cast<std::size_t>(k)], alone ? ", the others are not" : "");
      suspect.flip_y = k != 1, suspect.flip_x = k != 0;
      suspect.visibility_only = alone, suspect.geometric = !alone;
      out.push_back(suspect);
    }
}

/// Adds as many steps to each side, of so many pixels. A bias, too, moves shadows by whole pixels.
void add_shifts(double step, int steps, std::vector<Suspect>& out) {
  for (int i = -steps; i <= steps; ++i)
    for (int j = -steps; j <= steps; ++j) {
      if (i == 0 && j == 0) continue;
      Suspect suspect;
      suspect.shift = {step * i, step * j};
      suspect.what =
          fmt::format("the picture is {} off (x {:+g}, y {:+g})", step < 1.0 ? "half a pixel" : "some pixels",
                      suspect.shift.x, suspect.shift.y);
      suspect.by_shadows = step < 1.0;
      out.push_back(suspect);
    }
}

void add_views(const SuspectInput& in, std::vector<Suspect>& out) {
  const View view = make_view(in.camera, in.size);
  const bool parallel = view.orthographic();
  const double half_x = parallel ? view.half_x : view.tan_half_x,
               half_y = parallel ? view.half_y : view.tan_half_y;
  const auto add = [&](std::string what, double x, double y) {
    Suspect suspect;
    suspect.what = std::move(what);
    suspect.view = view;
    (parallel ? suspect.view->half_x : suspect.view->tan_half_x) = x;
    (parallel ? suspect.view->half_y : suspect.view->tan_half_y) = y;
    out.push_back(suspect);
  };
  const double aspect = half_x / half_y;
  if (std::abs(aspect - 1.0) > 0.01) {
    const auto name = [&](const char* which) {
      return fmt::format("the {} {}", which, parallel ? "size of the orthographic picture" : "field of view");
    };
    add(name("vertical") + " was taken for the horizontal one", half_y, half_y / aspect);
    add(name("horizontal") + " was taken for the vertical one", half_x * aspect, half_x);
  }
  if (parallel) {
    add("half the orthographic picture's height was taken for the whole", 2.0 * half_x, 2.0 * half_y);
    add("the orthographic picture's height was taken for half of it", 0.5 * half_x, 0.5 * half_y);
  }
  for (const double other : {1.0, 4.0 / 3.0, 1.5, 1.6, 16.0 / 9.0, 2.0, 21.0 / 9.0, 1.0 / aspect})
    if (std::abs(other / aspect - 1.0) > 0.01)
      add(fmt::format("the picture was drawn for an aspect of {:.4g}, not {:.4g}", other, aspect),
          other * half_y, half_y);
}

const Vec3 x_axis(1, 0, 0), y_axis(0, 1, 0), z_axis(0, 0, 1);

/// Columns: where the captured x, y and z axis point in the scene.
const Mat3 z_up(x_axis, -z_axis, y_axis), y_up(x_axis, z_axis, -y_axis);

/// The single differences, of which a whole picture may be off.
std::vector<Mat3> other_axes() {
  return {z_up, y_up, Mat3(x_axis, y_axis, -z_axis), Mat3(-x_axis, y_axis, z_axis), Mat3(0.01), Mat3(100.0)};
}

std::string axis_text(const Vec3& axis) {
  for (int k = 0; k < 3; ++k)
    if (std::abs(axis[k]) > 0.5) return fmt::format("{}{}", axis[k] < 0.0 ? "-" : "", "xyz"[k]);
  return "?";
}

std::string axes_text(const Mat3& axes) {
  if (axes == z_up) return "z-up, the scene y-up";
  if (axes == y_up) return "y-up, the scene z-up";
  int turned = 0, of = 0;
  for (int k = 0; k < 3; ++k)
    if (axes[k][k] == -1.0) ++turned, of = k;
  const bool straight = std::abs(axes[0][0]) + std::abs(axes[1][1]) + std::abs(axes[2][2]) == 3.0;
  if (straight && turned == 1) return fmt::format("left-handed ({} the other way)", "xyz"[of]);
  const std::string up = axes[2] == y_axis   ? "z-up, the scene y-up, "
                         : axes[1] == z_axis ? "y-up, the scene z-up, "
                                             : "";
  return fmt::format("{}{} (its x, y, z are the scene's {}, {}, {})", up,
                     glm::determinant(axes) < 0.0 ? "left-handed" : "turned", axis_text(axes[0]),
                     axis_text(axes[1]), axis_text(axes[2]));
}

View transformed(const Camera& camera, const ImageSize& size, const Mat3& axes) {
  View view = make_view(camera, size);
  view.eye = axes * view.eye;
  const double scale = std::cbrt(std::abs(glm::determinant(axes)));
  view.right = axes * view.right / scale, view.up = axes * view.up / scale;
  view.forward = axes * view.forward / scale;
  view.half_x *= scale, view.half_y *= scale;
  return view;
}

void add_axes(const SuspectInput& in, std::vector<Suspect>& out) {
  for (const Mat3& world : other_axes()) {
    const std::string words = world_words(world);
    Suspect suspect;
    suspect.place_from_captured = world;
    const double scale = std::cbrt(std::abs(glm::determinant(world)));
    const bool scaled = std::abs(scale - 1.0) > 0.5;
    if (in.has_positions || (in.has_depths && scaled)) {
      suspect.what = fmt::format("the {} are {}", in.has_positions ? "positions" : "depths", words);
      if (scaled) suspect.depth_scale = scale;
      out.push_back(suspect);
    }
    suspect.what = fmt::format("the camera's world is {}", words);
    suspect.view = transformed(in.camera, in.size, world);
    out.push_back(suspect);
  }
}

template <class T>
void flip(bool flip_x, bool flip_y, Image<T>& image) {
  if (image.data.empty() || (!flip_x && !flip_y)) return;
  const Image<T> from = image;
  for (int y = 0; y < image.size.height; ++y)
    for (int x = 0; x < image.size.width; ++x) {
      const auto [cx, cy] = flipped(flip_x, flip_y, image.size, x, y);
      image.at(x, y) = from.at(cx, cy);
    }
}

/// The signed axes that lie nearest, if these columns are such.
std::optional<Mat3> signed_axes(const Mat3& columns) {
  constexpr double slack = 0.02;  // positions of other surfaces are among the places
  Mat3 axes(0.0);
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i) {
      axes[k][i] = std::round(columns[k][i]);
      if (std::abs(columns[k][i] - axes[k][i]) > slack) return std::nullopt;
    }
  if (std::abs(std::abs(glm::determinant(axes)) - 1.0) > 0.5) return std::nullopt;
  return axes;
}

/// 1, or a power of ten, where it is nearly that.
double round_unit(double scale) {
  const double power = std::pow(10.0, std::round(std::log10(scale)));
  return std::abs(scale / power - 1.0) < 0.01 ? power : scale;
}

}  // namespace

std::string world_words(const Mat3& world) {
  const double scale = std::cbrt(std::abs(glm::determinant(world)));
  const bool scaled = std::abs(scale - 1.0) > 1e-6;
  const Mat3 axes = *signed_axes(world / scale);
  std::string text = axes == Mat3(1.0) ? "" : axes_text(axes);
  if (!scaled) return text;
  const std::string unit = std::abs(scale - 0.01) < 1e-6 ? "in centimetres, the scene in metres"
                           : std::abs(scale - 100.0) < 1e-6
                               ? "in metres, the scene in centimetres"
                               : fmt::format("in units of {:.4g} of the scene's", scale);
  return text.empty() ? unit : text + ", and " + unit;
}

std::vector<Mat3> usual_worlds() {
  // Unity: left-handed, y up. Unreal: left-handed, z up, centimetres, x forward. Blender, CAD: z up.
  const Mat3 unreal(-z_axis, x_axis, y_axis), left_z_up(x_axis, z_axis, y_axis);
  std::vector<Mat3> out;
  for (const double scale : {1.0, 0.01, 100.0})
    for (const Mat3& axes : {Mat3(1.0), z_up, y_up, Mat3(x_axis, y_axis, -z_axis),
                             Mat3(-x_axis, y_axis, z_axis), unreal, left_z_up})
      if (scale != 1.0 || axes != Mat3(1.0)) out.push_back(scale * axes);
  return out;
}

std::optional<Mat3> find_world(const Image<Vec3>& position, const raytrace::RayTracedFrame& frame) {
  Mat3 both(0.0), own(0.0);  // sums of q p^T and p p^T
  std::size_t count = 0;
  for (std::size_t i = 0; i < position.data.size(); i += 7) {
    const Vec3& p = position.data[i];
    if (frame.receiver.data[i].primitive == no_id || p == Vec3(0.0)) continue;
    both += glm::outerProduct(frame.receiver.data[i].position, p), own += glm::outerProduct(p, p);
    ++count;
  }
  if (count < 50 || !(std::abs(glm::determinant(own)) > 0.0)) return std::nullopt;
  const Mat3 world = both * glm::inverse(own);
  const double scale = round_unit(std::cbrt(std::abs(glm::determinant(world))));
  if (!std::isfinite(scale) || !(scale > 0.0)) return std::nullopt;
  const auto axes = signed_axes(world / scale);
  if (!axes || (*axes == Mat3(1.0) && scale == 1.0)) return std::nullopt;
  return scale * *axes;
}

std::vector<Suspect> usual_suspects(const SuspectInput& in) {
  std::vector<Suspect> out;
  add_flips(out);
  add_shifts(0.5, 1, out);
  add_shifts(1.0, 3, out);
  add_views(in, out);
  add_axes(in, out);
  if (in.has_depths) {
    Suspect suspect;
    suspect.what = "the depths are along the ray where the axis was said, or the reverse";
    suspect.other_depth = true;
    out.push_back(suspect);
  }
  if (in.has_direction) {
    Suspect suspect;
    suspect.what = "the light shines the other way (the sign of its direction), or nothing is lit at all";
    suspect.light_turned = true, suspect.geometric = false;
    out.push_back(suspect);
  }
  Suspect inverted;
  inverted.what = "the shadow's picture has 1 for shadow and 0 for light, or its comparison is swapped";
  inverted.inverted = true, inverted.geometric = false;
  out.push_back(inverted);
  return out;
}

void undo(const Suspect& suspect, CapturedPictures& pictures, Sight& sight) {
  flip(suspect.flip_x, suspect.flip_y, pictures.visibility);
  flip(suspect.flip_x, suspect.flip_y, pictures.reached);
  flip(suspect.flip_x, suspect.flip_y, pictures.color);
  flip(suspect.flip_x, suspect.flip_y, pictures.unshadowed);
  if (!suspect.visibility_only) {
    flip(suspect.flip_x, suspect.flip_y, pictures.drawn);
    flip(suspect.flip_x, suspect.flip_y, pictures.position);
    flip(suspect.flip_x, suspect.flip_y, pictures.depth);
  }
  if (suspect.inverted)
    for (float& v : pictures.visibility.data) v = 1.0f - v;
  sight.shift += suspect.shift;
  if (suspect.view) sight.view = *suspect.view;
  if (suspect.place_from_captured != Mat3(1.0))
    for (Vec3& place : pictures.position.data) place = suspect.place_from_captured * place;
  for (double& depth : pictures.depth.data) depth *= suspect.depth_scale;
  if (suspect.other_depth) pictures.depth_is_distance = !pictures.depth_is_distance;
}

}  // namespace gnomon::judge
