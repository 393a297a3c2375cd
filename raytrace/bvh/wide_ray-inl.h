// A ray made ready for the wide tree: fills WideRay, whose bounds are derived in raytrace/bvh/wide_ray.h.

#if defined(GNOMON_RAYTRACE_BVH_WIDE_RAY_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)  // once per instruction set: Highway's own pattern
#ifdef GNOMON_RAYTRACE_BVH_WIDE_RAY_INL_H_
#undef GNOMON_RAYTRACE_BVH_WIDE_RAY_INL_H_
#else
#define GNOMON_RAYTRACE_BVH_WIDE_RAY_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>

#include "raytrace/bvh/wide_traverse.h"
#include "raytrace/mask_bits-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
namespace {

/// A ray's numbers; of origin and direction a fourth may be read but means nothing.
struct RayNumbers {
  const double *origin, *direction;
  Interval t;
  double start = 0.0;  ///< of the ray that it is a part of: that one's t at this origin
};
static_assert(sizeof(Ray) == 8 * sizeof(double) && offsetof(Ray, direction) == 3 * sizeof(double));
inline RayNumbers numbers_of(const Ray& ray) {
  const auto* numbers = reinterpret_cast<const double*>(&ray);
  return {numbers, numbers + 3, ray.t};
}

/// The origin, counted from the tree's centre, and the direction as it is.
HWY_INLINE void set_floats_of(const WideTree& tree, const RayNumbers& given, WideRay& ray) {
  constexpr hn::CappedTag<double, 4> d;
  constexpr hn::Rebind<float, hn::CappedTag<double, 4>> half;
  for (std::size_t i = 0; i < 4; i += hn::MaxLanes(d)) {
    const auto from_center = hn::Sub(hn::LoadU(d, given.origin + i), hn::Load(d, tree.center.data() + i));
    const auto direction = hn::DemoteTo(half, hn::LoadU(d, given.direction + i));
    hn::Store(hn::DemoteTo(half, from_center), half, ray.origin + i);
    hn::Store(direction, half, ray.direction + i);
    hn::Store(hn::Abs(direction), half, ray.size + i);
  }
}

/// Returns the largest size of a vector's three components.
inline float largest_of(const float* v) {
  const auto larger = [](float a, float b) { return a > b ? a : b; };
  return larger(larger(v[0], v[1]), v[2]);
}

/// The direction times the power of two that RayFrame has it by. Returns what t is to be multiplied by; 0: refused.
[[gnu::noinline]] inline double set_scaled(const double* direction, WideRay& ray) {
  const double largest =
      std::max(std::max(std::abs(direction[0]), std::abs(direction[1])), std::abs(direction[2]));
  if (!(largest >= 0x1p-900 && largest <= 0x1p900)) return 0.0;
  const std::uint64_t exponent = std::bit_cast<std::uint64_t>(largest) & (0x7ffull << 52);
  const double scale = std::bit_cast<double>((2045ull << 52) - exponent);
  for (std::size_t a = 0; a < 3; ++a) {
    ray.direction[a] = static_cast<float>(direction[a] * scale);
    ray.size[a] = std::abs(ray.direction[a]);
  }
  return std::bit_cast<double>(exponent + (1ull << 52));
}

/// What the tests of boxes and triangles read. `largest`: of the direction's components, in size. False: the
/// bounds would not hold.
HWY_INLINE bool set_slabs(float r, float largest, WideRay& ray) {
  constexpr hn::CappedTag<float, 4> four;
  const auto every = [&](float v) { return hn::Set(four, v); };
  unsigned good = 0, backwards = 0, is_largest = 0;
  for (std::size_t i = 0; i < 4; i += hn::MaxLanes(four)) {
    const auto o = hn::Load(four, ray.origin + i), d = hn::Load(four, ray.direction + i);
    const auto size = hn::Load(four, ray.size + i), distance = hn::Abs(o);
    const auto widest = hn::CopySign(hn::Max(size, every(WideRay::least_direction)), d);
    const auto inverse = hn::Div(every(1.0f), widest);
    const auto slack = hn::Mul(hn::Mul(hn::Add(distance, every(r)), every(0x1p-20f)), hn::Abs(inverse));
    hn::Store(inverse, four, ray.inverse + i);
    hn::Store(hn::NegMulSub(o, inverse, slack), four, ray.near + i);
    hn::Store(hn::NegMulAdd(o, inverse, slack), four, ray.far + i);
    const auto bits = [&](auto mask) { return mask_bits(four, mask) << i; };
    good |= bits(hn::And(hn::Le(distance, every(64.0f * r)), hn::Le(size, every(1.0f))));
    backwards |= bits(hn::Lt(inverse, hn::Zero(four)));
    is_largest |= bits(hn::Eq(size, every(largest)));
  }
  constexpr unsigned axes = 7;
  ray.octant = backwards & axes;
  ray.z = static_cast<std::uint32_t>(std::countr_zero(is_largest));
  ray.coordinate_error = 0x1.7p-23f * r;
  return (good & axes) == axes;
}

/// Returns false where the ray is refused.
HWY_INLINE bool set_interval(const Interval& t, double kernel_t, double beyond, WideRay& ray) {
  const double t_min = t.min * kernel_t, t_max = t.max * kernel_t;
  ray.least = static_cast<float>(t_min), ray.most = static_cast<float>(t_max);
  const float last = beyond > 0.0 ? static_cast<float>(t_max + beyond * kernel_t) : ray.most;
  const float t_above = last * (WideRay::up * WideRay::widening) + FLT_MIN;
  ray.t_min = ray.least * WideRay::down - FLT_MIN;
  ray.t_max = t_above < FLT_MAX ? t_above : FLT_MAX;
  return t_min >= 0.0;
}

HWY_INLINE void set_units(double start, double kernel_t, double frame_t, WideRay& ray) {
  ray.unit = ray.per_unit_below = ray.per_unit_above = 1.0f;
  ray.start = static_cast<float>(start * kernel_t);
  if (frame_t > 0.0) {
    ray.unit = static_cast<float>(kernel_t / frame_t);
    ray.per_unit_below = ray.per_unit_above = static_cast<float>(frame_t / kernel_t);
  }
  if (ray.start > 0.0f) ray.per_unit_below *= 1.0f - 0x1p-21f, ray.per_unit_above *= WideRay::widening;
}

/// What PlainTest needs; false: its floats would not be those of the textbook but for their scale.
inline bool set_plain(const RayNumbers& given, double kernel_t, WideRay& ray) {
  for (int a = 0; a < 3; ++a) {
    ray.plain_origin[a] = static_cast<float>(given.origin[a]);
    ray.plain_direction[a] = static_cast<float>(given.direction[a]);
  }
  ray.kernel_t = static_cast<float>(kernel_t);
  return kernel_t >= 0x1p-60 && kernel_t <= 0x1p60;
}

/// Fills the ray, and returns what t is multiplied by; 0: refused.
HWY_INLINE double prepare(const WideTree& tree, const RayNumbers& given, const TraversalLimits& limits,
                          WideRay& ray) {
  set_floats_of(tree, given, ray);
  double kernel_t = 1.0;
  float largest = largest_of(ray.size);
  if (!(largest > 0.5f && largest < 1.0f)) [[unlikely]] {  // of unit directions few; those have scale 1
    kernel_t = set_scaled(given.direction, ray), largest = largest_of(ray.size);
    if (!(kernel_t > 0.0)) return 0.0;
  }
  if (!set_slabs(tree.reach, largest, ray) || !set_interval(given.t, kernel_t, limits.beyond, ray) ||
      limits.origin_error > 0x1p-44 * static_cast<double>(tree.reach))
    return 0.0;
  set_units(given.start, kernel_t, limits.frame_t, ray);
  ray.limit(limits.t_above);
  return !tree.plain || set_plain(given, kernel_t, ray) ? kernel_t : 0.0;
}

}  // namespace
}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target guard
