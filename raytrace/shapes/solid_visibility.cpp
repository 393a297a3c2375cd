#include "raytrace/precision/ambiguous_ray.h"

#include "raytrace/shapes/along_ray.h"

namespace gnomon::raytrace {
namespace {

enum class Place : std::uint8_t { inside, outside, unknown };

/// The march along the ray. A closed solid is seen as one function, less than 0 in the body: the greatest of
/// f and the distances over its cuts. A crossing is then a change of sign, and two places of different sign
/// prove one. Of an open solid only those crossings of f count that lie within its box.
class March {
 public:
  /// `source_sign`: that of the side to which a ray leaves the solid it starts on; else 0.
  March(const AlongRay& f, const Aabb& box, bool closed, int source_sign)
      : f_(f), box_(box), closed_(closed), source_sign_(source_sign), first_cut_(first_cut_axis(*f.solid)) {}

  /// `from_start`: the ray starts at lo.
  Intersects run(double lo, double hi, bool from_start) {
    const bool at_start = from_start && (source_sign_ != 0 || !function(Bounds(lo)).value.without_zero());
    constexpr double first_share = 0x1p-2, least_share = 0x1p-48;
    constexpr int most_stretches = 4096;
    const double longest = (hi - lo) * first_share, least = (hi - lo) * least_share;
    double at = lo, step = longest;
    for (int n = 0; n < most_stretches && at < hi; ++n) {
      const double end = at + step < hi ? at + step : hi;
      if (!(end > at)) break;
      switch (look(at, end, at_start && at == lo, step <= least)) {
        case Look::divide:
          step *= 0.5;
          continue;
        case Look::crossed:
          return Intersects::surely;
        case Look::ambiguous:
          ambiguous_ = true;
          break;
        case Look::done:
          break;
      }
      if (above_ && below_) return Intersects::surely;
      at = end;
      step = std::min(2.0 * step, longest);
    }
    return ambiguous_ || at < hi ? Intersects::perhaps : Intersects::no;
  }

 private:
  enum class Look : std::uint8_t { done, divide, crossed, ambiguous };

  // A sign hit on the way; of an open solid's f it proves nothing elsewhere.
  Look note(bool positive) {
    if (closed_) (positive ? above_ : below_) = true;
    return Look::done;
  }

  Look look(double at, double end, bool is_start, bool is_least) {
    const Bounds stretch(at, end);
    const Place place = closed_ ? Place::inside : place_of(stretch);
    if (place == Place::outside) return Look::done;
    const Slope h = function(stretch);
    if (h.value.is_empty()) return Look::done;
    if (h.value.without_zero()) return note(h.value.positive());
    const bool monotone = h.value.sure && h.change.without_zero();
    if (is_start && monotone && (source_sign_ == 0 || h.change.positive() == (source_sign_ > 0)))
      return note(h.change.positive());
    if (monotone && place == Place::inside) {
      const Bounds a = function(Bounds(at)).value, b = function(Bounds(end)).value;
      if (a.without_zero() && b.without_zero())
        return a.positive() == b.positive() ? note(a.positive()) : Look::crossed;
      // A root at an end shared with the next stretch: only dividing elsewhere would help.
      if (is_least || a.width() + b.width() > 0.25 * hull(a, b).width()) return Look::ambiguous;
      return Look::divide;
    }
    const double middle = at + 0.5 * (end - at);
    const Bounds here = function(Bounds(middle)).value, all = narrowed(h, here, stretch - Bounds(middle));
    if (all.without_zero()) return note(all.positive());
    const bool rounding = !here.without_zero() && all.width() <= 4.0 * here.width();
    return is_least || rounding ? Look::ambiguous : Look::divide;
  }

  Slope function(const Bounds& s) const {
    return body_slope(*f_.solid, f_.coordinate(0, s), f_.coordinate(1, s), f_.coordinate(2, s));
  }

  Place place_of(const Bounds& s) const {
    Place place = Place::inside;
    for (int a = first_cut_; a < 3; ++a) {
      const Bounds p = f_.coordinate(a, s).value;
      if (p.hi < box_.min[a] || p.lo > box_.max[a]) return Place::outside;
      if (!(p.lo > box_.min[a] && p.hi < box_.max[a])) place = Place::unknown;
    }
    return place;
  }

  const AlongRay& f_;
  const Aabb box_;
  const bool closed_;
  const int source_sign_;
  const int first_cut_;  // the axes from here on cut the solid
  bool above_ = false, below_ = false, ambiguous_ = false;
};

}  // namespace

Intersects intersects_solid(const RayFrame& ray, double surely_out, const Vec3& error,
                            const ShapeGeometry& solid, const Vec3* source_normal) {
  const ShapeFrame& frame = frame_of(solid);
  LocalRay local = local_ray(ray, solid);
  const Vec3 world(ray.origin[0], ray.origin[1], ray.origin[2]);
  const Vec3 size = glm::abs(world) + glm::abs(frame.origin);
  Vec3 local_error;
  for (int a = 0; a < 3; ++a)
    local_error[a] = glm::dot(glm::abs(frame.axes[a]), error + error_gamma(8) * size);
  const Aabb box = local_box(solid);
  // The direction's own rounding moves the far end; it enters as a part of the origin's.
  const double reach = glm::length(box.center() - local.origin) + box.diagonal();
  local_error += Vec3(error_gamma(16) * reach);
  const Interval range = box_range(local, {box.min - 2.0 * local_error, box.max + 2.0 * local_error});
  const double from = std::max(range.min, ray.t.min), to = std::min(range.max, surely_out);
  if (range.empty() || !(from < to)) return Intersects::no;

  int source_sign = 0;
  const bool from_start = from == ray.t.min;
  if (from_start && source_normal != nullptr) {
    const bool outside = glm::dot(solid_normal(solid, world), *source_normal) > 0.0;
    if (outside && is_convex(solid)) return Intersects::no;
    source_sign = outside ? 1 : -1;
  }
  const AlongRay f{&solid, local.origin + from * local.direction, local.direction, local_error};
  March march(f, box, is_closed(solid), source_sign);
  const double sure_end = std::min(to, ray.t.max);
  Intersects intersects = sure_end > from ? march.run(0.0, sure_end - from, from_start) : Intersects::no;
  if (intersects == Intersects::no && to > sure_end &&
      march.run(std::max(0.0, sure_end - from), to - from, false) != Intersects::no)
    intersects = Intersects::perhaps;
  return intersects;
}

}  // namespace gnomon::raytrace
