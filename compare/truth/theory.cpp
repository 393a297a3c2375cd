#include "compare/truth/theory.h"

#include <algorithm>
#include <memory>
#include <numeric>
#include <span>

#include "compare/ladder/biased_test.h"
#include "scene/base/parallel.h"
#include "scene/camera.h"

namespace gnomon::compare {
namespace {

using raytrace::SurfacePoint;

}  // namespace

Distribution distribution(std::span<double> values) {
  const auto end = std::remove_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); });
  Distribution out;
  out.count = static_cast<std::size_t>(end - values.begin());
  if (out.count == 0) return out;
  auto above = values.begin();  // from here on are the values that are not below the last share's
  const auto at = [&](double share) {
    const auto place =
        values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(out.count - 1));
    std::nth_element(above, place, end);
    above = place;
    return *place;
  };
  out.median = at(0.5);
  out.p90 = at(0.9);
  out.p99 = at(0.99);
  out.max = *std::max_element(above, end);
  return out;
}

namespace {

struct PixelTheory {
  double acne_free_bias = infinity, perspective = infinity, projection = infinity, measured = infinity;
};

// Area of a texel square to the light ray at the receiver.
double texel_area(const LightView& view, const TexelCoordinate& at) {
  if (view.projection == LightProjection::orthographic) {
    const LightFace& face = view.face(at.face);
    if (face.warp == 0.0)
      return 4.0 * face.half_extent.x * face.half_extent.y / (double(view.size) * view.size);
    const auto c = column_corners(view, at.face, at.column(), at.row());  // a trapezium
    const Vec2 a = c[2] - c[0], b = c[3] - c[1];
    return 0.5 * std::abs(a.x * b.y - a.y * b.x);
  }
  const Vec2 half = view.face(at.face).half_extent;
  const double across = 2.0 * half.x / view.size, up = 2.0 * half.y / view.size;
  const double cosine = at.depth / at.distance;  // between the ray and the face's axis
  return across * up * at.depth * at.depth * cosine;
}

class Predictor {
 public:
  Predictor(const LadderInput& in, const Image<Label>& labels, int picture_height)
      : in_(in),
        labels_(labels),
        camera_(in.world().scene->camera),
        pixel_side_(gnomon::picture_height(camera_, 1.0) / picture_height),
        forward_(glm::normalize(camera_.target - camera_.eye)) {}

  PixelTheory at(int x, int y) const {
    const std::size_t pixel = labels_.index(x, y);
    const SurfacePoint& receiver = in_.traced.receiver.data[pixel];
    const LightView& view = in_.record().map.view;
    const TexelCoordinate texel = project_to_face(view, in_.record().face.data[pixel], receiver.position);
    PixelTheory out;
    out.acne_free_bias = texel_depth_slope(view, texel, receiver.position, receiver.normal);
    const Vec3 from_eye = camera_.orthographic() ? forward_ : receiver.position - camera_.eye;
    const double distance = glm::length(from_eye), cos_axis = glm::dot(from_eye, forward_) / distance;
    const double pixel_area = distance * distance * pixel_solid_angle(cos_axis);
    const double cos_eye = -glm::dot(from_eye, receiver.normal) / distance;
    const double cos_light = glm::dot(light_at(in_.light(), receiver.position).to_light, receiver.normal);
    out.perspective = std::sqrt(texel_area(view, texel) / pixel_area);
    out.projection = std::sqrt(cos_eye / cos_light);
    out.measured = measured(x, y);
    return out;
  }

 private:
  // Area of a pixel, square to its ray, at a distance along it, over the squared distance.
  double pixel_solid_angle(double cos_axis) const {
    return pixel_side_ * pixel_side_ * cos_axis * cos_axis * cos_axis;
  }
  // From the neighbours to the right and below, where they show the same primitive on the same face.
  double measured(int x, int y) const {
    if (x + 1 >= labels_.size.width || y + 1 >= labels_.size.height) return infinity;
    const std::size_t here = labels_.index(x, y), right = labels_.index(x + 1, y),
                      below = labels_.index(x, y + 1);
    for (const std::size_t other : {right, below})
      if (in_.drawn.primitive.data[other] != in_.drawn.primitive.data[here] ||
          in_.record().face.data[other] != in_.record().face.data[here])
        return infinity;
    const Vec2 a = texel(right) - texel(here), b = texel(below) - texel(here);
    return 1.0 / std::sqrt(std::abs(a.x * b.y - a.y * b.x));
  }
  Vec2 texel(std::size_t pixel) const { return Vec2(in_.record().texel_uv.data[pixel]); }

  const LadderInput& in_;
  const Image<Label>& labels_;
  const Camera& camera_;
  double
      pixel_side_;  ///< on the plane at distance 1, where an orthographic camera's rays may as well be taken to end
  Vec3 forward_;
};

/// Where each row's compared pixels begin among all of them; at last their number.
std::vector<std::size_t> compared_before(const Image<Label>& labels, const PictureRows& rows) {
  std::vector<std::size_t> before(static_cast<std::size_t>(rows.count) + 1, 0);
  parallel_for(rows.count, [&](int i) {
    for (int x = 0; x < labels.size.width; ++x)
      before[static_cast<std::size_t>(i) + 1] += is_compared(labels.at(x, rows.first + i)) ? 1 : 0;
  });
  std::partial_sum(before.begin(), before.end(), before.begin());
  return before;
}

}  // namespace

TheoryValues theory_values(const LadderInput& in, const Image<Label>& labels, const PictureRows& rows,
                           int picture_height) {
  const std::vector<std::size_t> before = compared_before(labels, rows);
  TheoryValues values;
  for (std::vector<double>& v : values) v.resize(before.back());
  const Predictor predictor(in, labels, picture_height);
  parallel_for(rows.count, [&](int row) {
    std::size_t i = before[static_cast<std::size_t>(row)];
    const int y = rows.first + row;
    for (int x = 0; x < labels.size.width; ++x) {
      if (!is_compared(labels.at(x, y))) continue;
      const PixelTheory p = predictor.at(x, y);
      values[0][i] = p.acne_free_bias, values[1][i] = p.perspective, values[2][i] = p.projection;
      values[3][i] = p.perspective * p.projection, values[4][i] = p.measured;
      ++i;
    }
  });
  return values;
}

Distribution& distribution_of(TheoryStats& stats, std::size_t value) {
  const std::array<Distribution*, 5> places{&stats.acne_free_bias, &stats.perspective, &stats.projection,
                                            &stats.aliasing, &stats.measured_aliasing};
  return *places[value];
}

}  // namespace gnomon::compare
