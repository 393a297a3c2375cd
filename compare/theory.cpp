#include "compare/theory.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>

#include "compare/biased_test.h"
#include "scene/camera.h"

namespace gnomon::compare {
namespace {

using raytrace::SurfacePoint;

// The median, the 90th and 99th percentile and the largest of the finite values.
Distribution distribution(std::vector<double>& values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  Distribution out;
  out.count = values.size();
  if (values.empty()) return out;
  auto above = values.begin();  // from here on are the values that are not below the last share's
  const auto at = [&values, &above](double share) {
    const auto place =
        values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(above, place, values.end());
    above = place;
    return *place;
  };
  out.median = at(0.5);
  out.p90 = at(0.9);
  out.p99 = at(0.99);
  out.max = *std::max_element(above, values.end());
  return out;
}

struct PixelTheory {
  double acne_free_bias = infinity, perspective = infinity, projection = infinity, measured = infinity;
};

// Area of a texel square to the light ray at the receiver.
double texel_area(const LightView& view, const TexelCoordinate& at) {
  if (view.projection == LightProjection::orthographic) {
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
  Predictor(const LadderInput& in, const Image<Label>& labels)
      : in_(in),
        labels_(labels),
        camera_(in.world.scene->camera),
        pixel_side_(2.0 * std::tan(0.5 * camera_.vertical_fov) / labels.size.height),
        forward_(glm::normalize(camera_.target - camera_.eye)) {}

  PixelTheory at(int x, int y) const {
    const std::size_t pixel = labels_.index(x, y);
    const SurfacePoint& receiver = in_.traced.receiver.data[pixel];
    const LightView& view = in_.record.map.view;
    const TexelCoordinate texel = project_to_face(view, in_.record.face.data[pixel], receiver.position);
    PixelTheory out;
    out.acne_free_bias = texel_depth_slope(view, texel, receiver.position, receiver.normal);
    const Vec3 from_eye = receiver.position - camera_.eye;
    const double distance = glm::length(from_eye), cos_axis = glm::dot(from_eye, forward_) / distance;
    const double pixel_area = distance * distance * pixel_solid_angle(cos_axis);
    const double cos_eye = -glm::dot(from_eye, receiver.normal) / distance;
    const double cos_light = glm::dot(light_at(in_.light, receiver.position).to_light, receiver.normal);
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
          in_.record.face.data[other] != in_.record.face.data[here])
        return infinity;
    const Vec2 a = texel(right) - texel(here), b = texel(below) - texel(here);
    return 1.0 / std::sqrt(std::abs(a.x * b.y - a.y * b.x));
  }
  Vec2 texel(std::size_t pixel) const { return Vec2(in_.record.texel_uv.data[pixel]); }

  const LadderInput& in_;
  const Image<Label>& labels_;
  const Camera& camera_;
  double pixel_side_;  ///< on the plane at distance 1
  Vec3 forward_;
};

}  // namespace

TheoryStats predict(const LadderInput& in, const Image<Label>& labels) {
  std::vector<PixelTheory> pixels(labels.data.size());
  const Predictor predictor(in, labels);
  tbb::parallel_for(0, labels.size.height, [&](int y) {
    for (int x = 0; x < labels.size.width; ++x)
      if (is_compared(labels.at(x, y))) pixels[labels.index(x, y)] = predictor.at(x, y);
  });
  const auto collect = [&pixels](Distribution& out, const auto& value) {
    return [&pixels, &out, value] {
      std::vector<double> values(pixels.size());
      for (std::size_t i = 0; i < pixels.size(); ++i) values[i] = value(pixels[i]);
      out = distribution(values);
    };
  };
  TheoryStats stats;
  tbb::parallel_invoke(
      collect(stats.acne_free_bias, [](const PixelTheory& p) { return p.acne_free_bias; }),
      collect(stats.perspective, [](const PixelTheory& p) { return p.perspective; }),
      collect(stats.projection, [](const PixelTheory& p) { return p.projection; }),
      collect(stats.aliasing, [](const PixelTheory& p) { return p.perspective * p.projection; }),
      collect(stats.measured_aliasing, [](const PixelTheory& p) { return p.measured; }));
  return stats;
}

}  // namespace gnomon::compare
