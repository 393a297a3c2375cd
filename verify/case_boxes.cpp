// The slab test must never cull a box that the ray meets. Oracles: whole numbers, where membership is exact,
// and rays made to pass through a point of the box.
#include <array>
#include <limits>

#include "raytrace/bvh/traverse.h"
#include "verify/cases.h"

namespace gnomon::verify {

namespace {

struct WholeBox {
  std::array<int, 3> min, max;
};

/// One child of a node; the other three are the same.
raytrace::BvhNode node_of(const Vec3& min, const Vec3& max) {
  raytrace::BvhNode node{};
  for (int a = 0; a < 3; ++a) {
    for (float& bound : node.bounds[a]) bound = static_cast<float>(min[a]);
    for (float& bound : node.bounds[3 + a]) bound = static_cast<float>(max[a]);
  }
  return node;
}

bool meets(const Ray& ray, const Vec3& min, const Vec3& max) {
  const auto frame = raytrace::make_ray_frame(ray);
  if (!frame) return false;
  alignas(16) std::array<float, 4> t_near;
  const raytrace::BoxRay boxes(*frame, Vec3(0.0));
  return raytrace::intersect_boxes(node_of(min, max), boxes, boxes.t_max, t_near.data()) == 15;
}

/// The textbook's slab test, in floats: min and max of the two planes, which let NaN (0 * inf) through.
bool naively_meets(const Ray& ray, const Vec3& min, const Vec3& max) {
  float near = 0.0f, far = std::numeric_limits<float>::infinity();
  for (int a = 0; a < 3; ++a) {
    const float inverse = 1.0f / static_cast<float>(ray.direction[a]), o = static_cast<float>(ray.origin[a]);
    const float t0 = (static_cast<float>(min[a]) - o) * inverse,
                t1 = (static_cast<float>(max[a]) - o) * inverse;
    // Not std::fmax and std::fmin, which would drop a NaN: it is to reach the comparison.
    const float low = std::min(t0, t1), high = std::max(t0, t1);
    near = std::isnan(low) ? low : std::max(low, near), far = std::isnan(high) ? high : std::min(high, far);
  }
  return near <= far;
}

bool meets(const Run& run, const Ray& ray, const Vec3& min, const Vec3& max) {
  return run.is_textbook() ? naively_meets(ray, min, max) : meets(ray, min, max);
}

/// Exactly, with origins and directions that are small whole numbers: t of each plane is a fraction, compared
/// by cross products.
bool truly_meets(const WholeBox& box, const std::array<int, 3>& origin, const std::array<int, 3>& d) {
  long near_n = 0, near_d = 1, far_n = 1, far_d = 0;  // 0 and infinity
  for (std::size_t a = 0; a < 3; ++a) {
    if (d[a] == 0) {
      if (origin[a] < box.min[a] || origin[a] > box.max[a]) return false;
      continue;
    }
    const long scale = std::abs(d[a]);
    const long lo = d[a] > 0 ? box.min[a] - origin[a] : origin[a] - box.max[a];
    const long hi = d[a] > 0 ? box.max[a] - origin[a] : origin[a] - box.min[a];
    if (lo * near_d > near_n * scale) near_n = lo, near_d = scale;
    if (hi * far_d < far_n * scale) far_n = hi, far_d = scale;
  }
  return near_n * far_d <= far_n * near_d;
}

}  // namespace

void slab_faces(Run& run) {
  run.sample("culled", run.rays(), [&](Random& r, Tally& tally) {
    WholeBox box{};
    std::array<int, 3> origin{}, d{};
    Vec3 min, max, o, direction;
    for (std::size_t a = 0; a < 3; ++a) {
      const int i = static_cast<int>(a);
      box.min[a] = r.integer(-8, 8), box.max[a] = box.min[a] + r.integer(0, 6);
      // In a face, more often than not.
      const std::uint32_t where = r.below(4);
      origin[a] = where == 0 ? box.min[a] : where == 1 ? box.max[a] : r.integer(-16, 16);
      d[a] = r.below(2) == 0 ? 0 : r.integer(-3, 3);
      min[i] = box.min[a], max[i] = box.max[a], o[i] = origin[a];
      direction[i] = d[a] == 0 && r.coin() ? -0.0 : d[a];
    }
    if (d == std::array<int, 3>{} || !truly_meets(box, origin, d)) return;
    tally.check(meets(run, {o, direction}, min, max));
  });
}

void slab_corners(Run& run) {
  const auto aimed = [&](const Vec3& point, const Vec3& min, const Vec3& max, Random& r, Tally& tally) {
    const Vec3 away = r.direction();
    const Vec3 origin = point + away * r.power_of_ten(-3.0, 0.5);
    tally.check(meets(run, {origin, point - origin}, min, max));
  };
  run.sample("points", run.rays(0.5), [&](Random& r, Tally& tally) {
    const Vec3 point = Vec3(Vec3f(r.in_box(1.0)));
    aimed(point, point, point, r, tally);
  });
  run.sample("corners of flat boxes", run.rays(0.5), [&](Random& r, Tally& tally) {
    const Vec3 min = Vec3(Vec3f(r.in_box(1.0)));
    Vec3 max = Vec3(Vec3f(min + glm::abs(r.in_box(1.0)))), corner;
    const int flat = r.integer(0, 2);
    max[flat] = min[flat];
    for (int a = 0; a < 3; ++a) max[a] = std::max(max[a], min[a]), corner[a] = r.coin() ? min[a] : max[a];
    aimed(corner, min, max, r, tally);
  });
}

}  // namespace gnomon::verify
