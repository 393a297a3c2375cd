#include "raster/clip_sides.h"

namespace gnomon::raster {
namespace {

/// Of its terms' sizes what a sum may be off by: places, coefficients and sums are rounded to floats, less than ten
/// times 2^-24 for each.
constexpr double slack = 0x1p-20;

}  // namespace

ClipSides::ClipSides(const Mat4& clip_from_relative, const Vec3& reference) : reference_(reference) {
  const Mat4 rows = glm::transpose(clip_from_relative);
  const Vec4 &x = rows[0], &y = rows[1], &w = rows[3];
  side_ = {w + x, w - x, w + y, w - y, w};
  const Vec4 beside_x = glm::abs(w) + glm::abs(x), beside_y = glm::abs(w) + glm::abs(y);
  size_ = {beside_x, beside_x, beside_y, beside_y, glm::abs(w)};
}

bool ClipSides::surely_outside(const Aabb& world_box) const {
  const Vec3 low = world_box.min - reference_, high = world_box.max - reference_;
  const Vec3 far = glm::max(glm::abs(low), glm::abs(high));
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 n(side_[i]);
    const double most = glm::dot(glm::max(n * low, n * high), Vec3(1.0)) + side_[i].w;
    if (most < -slack * (glm::dot(Vec3(size_[i]), far) + size_[i].w)) return true;
  }
  return false;
}

}  // namespace gnomon::raster
