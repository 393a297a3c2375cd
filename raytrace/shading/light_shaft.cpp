#include "raytrace/shading/light_shaft.h"

#include "raytrace/bvh/wide_shaft.h"
#include "raytrace/bvh/wide_single.h"
#include "raytrace/precision/ray_offset.h"
#include "raytrace/tracer.h"

namespace gnomon::raytrace {
namespace {

// Doubles are compared with this share of their size to spare, thousands of times what their rounding, and
// that of the rays and of their tests, can be.
constexpr double margin = 0x1p-40;

double dot_abs(const Vec3& a, const Vec3& b) {
  return glm::dot(glm::abs(a), glm::abs(b));
}

double sum_abs(const Vec3& v) {
  return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

/// All rays of LightSamples, if the light is above the horizon: then they share their origin.
class LightShaft {
 public:
  LightShaft(const SurfacePoint& from, const Light& light) : from_(from) {
    const bool endless = light.type == LightType::directional;
    shaft_.origin = offset_origin(from, from.normal), shaft_.endless = endless;
    center_ = endless ? -light.direction : light.position - shaft_.origin;
    half_ = shape_half_extent(light.extent);
    half_ += margin * (max_component(glm::abs(center_)) + max_component(half_) +
                       (endless ? 0.0 : max_component(glm::abs(shaft_.origin))));
    shaft_.low = center_ - half_, shaft_.high = center_ + half_;
    size_ = max_component(glm::max(glm::abs(shaft_.low), glm::abs(shaft_.high)));
    least_height_ = least(from.normal);
    make_sides();
  }

  const Shaft& shaft() const { return shaft_; }
  bool is_above_horizon() const { return least_height_ > margin * size_; }
  /// A point as the rays' origin sees it.
  Vec3 seen(const Vec3& point) const { return point - shaft_.origin; }

  /// Whether a plane through a, seen from the origin, has the whole light on the origin's side.
  /// normal_error: how far each of the normal's components may be off.
  bool spares(const Vec3& normal, double normal_error, const Vec3& a) const {
    const double height = glm::dot(normal, a);
    const double error = margin * dot_abs(normal, a) + normal_error * sum_abs(a);
    const double light_error = size_ * (margin * sum_abs(normal) + 3.0 * normal_error);
    const double plane = shaft_.endless ? 0.0 : height;
    if (height > error) return -least(-normal) < plane - error - light_error;
    if (height < -error) return least(normal) > plane + error + light_error;
    return false;
  }

  /// Whether a ball lies on the outer side of a plane through the origin that has the shaft on its inner one.
  bool has_outside(const Vec3& center, double radius) const {
    if (glm::dot(from_.normal, center) + radius < -margin * dot_abs(from_.normal, center)) return true;
    for (std::size_t i = 0; i < sides_; ++i)
      if (glm::dot(side_[i], center) - radius * glm::length(side_[i]) > margin * dot_abs(side_[i], center))
        return true;
    return false;
  }

  bool has_outside(const std::array<Vec3, 3>& a) const {
    const auto outside = [&](const Vec3& outwards) {
      return std::all_of(a.begin(), a.end(), [&](const Vec3& v) {
        return glm::dot(outwards, v) > margin * dot_abs(outwards, v);
      });
    };
    if (outside(-from_.normal)) return true;
    for (std::size_t i = 0; i < sides_; ++i)
      if (outside(side_[i])) return true;
    return false;
  }

  /// Whether the shaft has risen above a triangle with corners a, which is no higher above the horizon than
  /// rounding makes it, before it comes there.
  bool rises_above(const std::array<Vec3, 3>& a, const Vec3& normal, double normal_error) const {
    double height = 0.0, error = 0.0, far = 0.0;
    for (const Vec3& v : a) {
      height = std::max(height, glm::dot(from_.normal, v));
      error = std::max(error, margin * dot_abs(from_.normal, v));
      far = std::max(far, sum_abs(v));
    }
    if (height > 2.0 * error) return false;
    // What is r away from the origin is above r least_height_ / (sqrt(3) size_).
    const double risen_at = 4.0 * error * size_ / least_height_;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 edge = a[(k + 1) % 3] - a[k], inwards = glm::cross(normal, edge);
      const double edge_error = margin * dot_abs(inwards, a[k]) + 6.0 * normal_error * sum_abs(edge) * far;
      if (glm::dot(inwards, a[k]) > risen_at * glm::length(inwards) + edge_error) return true;
    }
    return false;
  }

 private:
  /// The least of dot(v, d).
  double least(const Vec3& v) const { return glm::dot(v, center_) - glm::dot(glm::abs(v), half_); }

  /// For each two axes the planes along the third that touch the shaft, where it lies on one side of any.
  void make_sides() {
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      std::array<Vec2, 4> corners;
      for (std::size_t c = 0; c < 4; ++c)
        corners[c] = {((c & 1) != 0 ? shaft_.high : shaft_.low)[i],
                      ((c & 2) != 0 ? shaft_.high : shaft_.low)[j]};
      for (const Vec2& corner : corners)
        for (const Vec2& outwards : {Vec2(-corner.y, corner.x), Vec2(corner.y, -corner.x)}) {
          const bool touches = std::all_of(corners.begin(), corners.end(), [&](const Vec2& other) {
            return outwards.x * other.x + outwards.y * other.y <= 0.0;
          });
          if (!touches || sides_ == side_.size()) continue;
          side_[sides_] = Vec3(0.0);
          side_[sides_][i] = outwards.x, side_[sides_++][j] = outwards.y;
        }
    }
  }

  const SurfacePoint& from_;
  Shaft shaft_;
  Vec3 center_, half_;
  double size_ = 0.0, least_height_ = 0.0;
  std::array<Vec3, 6> side_;
  std::size_t sides_ = 0;
};

/// is_source: it is the point's. A ray does not intersect the triangle that it leaves upwards
/// (raytrace/precision/ray_offset.h), if this is no needle, whose normal rounding makes another.
bool spares_triangle(const LightShaft& shaft, const LeafPrimitive& triangle, bool is_source) {
  constexpr double least_sine = 0x1p-5;
  std::array<Vec3, 3> a;
  for (std::size_t k = 0; k < 3; ++k) a[k] = shaft.seen(triangle.corner(k));
  const Vec3 e1 = a[1] - a[0], e2 = a[2] - a[0], normal = glm::cross(e1, e2);
  const double edge = std::max(sum_abs(e1), sum_abs(e2)), far = edge + sum_abs(a[0]);
  if (is_source) return sum_abs(normal) > least_sine * edge * edge;
  const double normal_error = 0x1p-48 * edge * far;
  return shaft.spares(normal, normal_error, a[0]) || shaft.has_outside(a) ||
         shaft.rises_above(a, normal, normal_error);
}

/// is_source: it is the point's. Seen from outside, it lies below the horizon; from within, all around.
bool spares_sphere(const LightShaft& shaft, const Sphere& sphere, const SurfacePoint& from, bool is_source) {
  if (is_source) return glm::dot(from.normal, from.position - sphere.center) > 0.0;
  return shaft.has_outside(shaft.seen(sphere.center), sphere.radius);
}

/// Whether the shaft surely passes by the leaf's primitive.
bool spares_leaf(const Structures& s, const LightShaft& shaft, std::uint32_t leaf, const SurfacePoint& from) {
  const std::uint32_t id = s.bvh.id_at(leaf);
  const bool is_source = id == from.primitive;
  if (!s.has_shapes || s.world->is_triangle(id))
    return spares_triangle(shaft, s.bvh.primitive_at(leaf), is_source);
  const auto* sphere = std::get_if<Sphere>(&s.world->shape(id).geometry);
  return sphere != nullptr && spares_sphere(shaft, *sphere, from, is_source);
}

bool spares_planes(const Structures& s, const LightShaft& shaft, std::uint32_t source) {
  return std::all_of(s.planes.begin(), s.planes.end(), [&](std::uint32_t id) {
    const auto& plane = std::get<Plane>(s.world->shape(id).geometry);
    return id == source || shaft.spares(plane.normal, 0.0, shaft.seen(plane.point));
  });
}

}  // namespace

void prepare_light_shafts(const Tracer& tracer, int rays) {
  if (rays >= least_shaft_rays) prepare_single_rays(tracer);
}

bool LightBlockers::add(std::uint32_t leaf, bool placed) {
  price_ += placed ? placed_price : 1;
  if (price_ > most) return false;
  leaf_[count_++] = leaf;
  return true;
}

LightBlockers find_light_blockers(const Tracer& tracer, const SurfacePoint& from, const Light& light,
                                  int rays) {
  const Structures& s = tracer.structures();
  if (rays < least_shaft_rays) return {};
  if (s.precision == Precision::fast) return {};  // its rays start where they may intersect anything
  const WideTree* tree = wide_tree(s);
  if (tree == nullptr) return {};
  const LightShaft shaft(from, light);
  if (!shaft.is_above_horizon()) return {};
  ShaftLeaves leaves;
  if (!leaves_in_shaft(*tree, shaft.shaft(), leaves)) return {};
  LightBlockers blockers;
  for (const LeafRange& range : leaves.ranges())
    for (std::uint32_t leaf = range.first; leaf < range.first + range.count; ++leaf)
      if (!spares_leaf(s, shaft, leaf, from) && !blockers.add(leaf, leaf >= s.bvh.ids.size())) return {};
  blockers.known_ = true, blockers.planes_ = !spares_planes(s, shaft, from.primitive);
  return blockers;
}

}  // namespace gnomon::raytrace
