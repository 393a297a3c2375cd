#include "scene/light_map/cascade_fit.h"

#include "scene/light_map/light_fit_parts.h"
#include "scene/shapes/solid.h"
#include "scene/shapes/triangle_blocks.h"

namespace gnomon {
namespace {

using light_fit::Rect;
using light_fit::to_light_space;

// The nearest slice starts here at the latest, as a share of the farthest depth: below it, slices would cover
// what no pixel shows.
constexpr double nearest_share = 0.01;
// Shadows on infinite planes are followed no farther than so many times the scene's size and distance.
constexpr double farthest_shadow = 20.0;
// What moves by steps goes by so many to its size.
constexpr double steps_per_side = 16.0;

struct Fit {
  const World& world;
  const View view;
  const Vec3 towards;  // the way the light travels
  LightFace frame;
  Vec3 reference;
  Rect casters;
};

double view_depth(const Fit& fit, const Vec3& p) {
  return glm::dot(p - fit.view.eye, fit.view.forward);
}

// Farthest depth at which the camera can see a finite thing or its shadow on an infinite plane, and the nearest depth of a
// finite thing; of an orthographic camera, whose first slice begins there, the nearest of their shadows too.
Interval seen_depths(const Fit& fit) {
  const Aabb& box = fit.world.finite_bounds;
  const double limit = farthest_shadow * (box.diagonal() + glm::length(box.center() - fit.view.eye));
  Interval seen{infinity, 0.0};
  for (int k = 0; k < 8; ++k) {
    const Vec3 p((k & 1) ? box.max.x : box.min.x, (k & 2) ? box.max.y : box.min.y,
                 (k & 4) ? box.max.z : box.min.z);
    seen.min = std::min(seen.min, view_depth(fit, p)), seen.max = std::max(seen.max, view_depth(fit, p));
    for (const Shape& shape : fit.world.shapes) {
      const auto* plane = std::get_if<Plane>(&shape.geometry);
      if (plane == nullptr) continue;
      const double t = glm::dot(plane->normal, plane->point - p) / glm::dot(plane->normal, fit.towards);
      if (!(t > 0.0)) continue;
      const double depth = std::isfinite(t) ? view_depth(fit, p + t * fit.towards) : 0.0;
      seen.max = std::max(seen.max, std::min(depth, limit));
      if (fit.view.orthographic()) seen.min = std::min(seen.min, std::max(depth, -limit));
    }
  }
  return seen;
}

Interval sample_depths(const Fit& fit, std::span<const Vec3> visible) {
  Interval seen{infinity, 0.0};
  for (const Vec3& p : visible) {
    const double depth = view_depth(fit, p);
    seen.min = std::min(seen.min, depth), seen.max = std::max(seen.max, depth);
  }
  return seen;
}

// The part of a polygon on the inner side of a plane through the origin (Sutherland and Hodgman 1974).
std::vector<Vec3> clipped(const std::vector<Vec3>& polygon, const Vec3& inwards) {
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double at_a = glm::dot(inwards, a), at_b = glm::dot(inwards, b);
    if (at_a >= 0.0) out.push_back(a);
    if ((at_a < 0.0) != (at_b < 0.0)) out.push_back(a + at_a / (at_a - at_b) * (b - a));
  }
  return out;
}

// The nearest depth at which the camera can see a surface, at most `limit`: triangles cut with the view's
// pyramid, the boxes of shapes, the planes along the pyramid's edges.
double nearest_seen(const World& world, const View& view, double limit) {
  const std::array<Vec3, 4> sides{
      view.forward * view.tan_half_x + view.right, view.forward * view.tan_half_x - view.right,
      view.forward * view.tan_half_y + view.up, view.forward * view.tan_half_y - view.up};
  const auto depth = [&](const Vec3& p) { return glm::dot(p - view.eye, view.forward); };
  // By a little more than roundings are.
  const auto is_no_nearer = [&](double nearest, const Aabb& box) {
    const Aabb from{box.min - view.eye, box.max - view.eye};
    const double spare = 1e-9 * glm::dot(Vec3(1.0), glm::abs(from.min) + glm::abs(from.max));
    return -farthest_along(from, -view.forward) > nearest + spare ||
           std::any_of(sides.begin(), sides.end(),
                       [&](const Vec3& side) { return farthest_along(from, side) < -spare; });
  };
  const auto keep_less = [](double& nearest, double other) { nearest = std::min(nearest, other); };
  double nearest = over_blocks(
      world, limit, is_no_nearer,
      [&](double& sum, const WorldPart& part, std::uint32_t triangle) {
        const auto corners = part.corners(triangle);
        if (std::min({depth(corners[0]), depth(corners[1]), depth(corners[2])}) >= sum) return;
        std::vector<Vec3> polygon;
        for (const Vec3& corner : corners) polygon.push_back(corner - view.eye);
        for (const Vec3& side : sides) polygon = clipped(polygon, side);
        for (const Vec3& p : polygon) keep_less(sum, std::max(0.0, glm::dot(p, view.forward)));
      },
      keep_less);
  for (const Shape& shape : world.shapes) {
    if (const auto* plane = std::get_if<Plane>(&shape.geometry)) {
      for (const Vec2 s : {Vec2(-1, -1), Vec2(1, -1), Vec2(1, 1), Vec2(-1, 1)}) {
        const Vec3 d = view.ray_direction(s);
        const double t = glm::dot(plane->normal, plane->point - view.eye) / glm::dot(plane->normal, d);
        if (t > 0.0) nearest = std::min(nearest, t);
      }
      continue;
    }
    const auto* sphere = std::get_if<Sphere>(&shape.geometry);
    const Vec3 center = sphere != nullptr ? sphere->center : solid_center(shape.geometry);
    const auto reach = [&](const Vec3& direction) {
      return sphere != nullptr ? sphere->radius * glm::length(direction)
                               : reach_along(shape.geometry, direction);
    };
    const bool seen = std::all_of(sides.begin(), sides.end(), [&](const Vec3& side) {
      return glm::dot(side, center - view.eye) >= -reach(side);
    });
    if (seen) nearest = std::min(nearest, std::max(0.0, depth(center) - reach(view.forward)));
  }
  return nearest;
}

// Between the nearest and the farthest depth that an orthographic camera sees, but not behind its eye. `stepped`: begins at whole
// sixteenths, and is as long wherever the eye stands.
Interval orthographic_range(const Interval& seen, bool stepped) {
  if (!stepped) return {std::max(0.0, seen.min), seen.max};
  const double step = up_to_size_step(seen.max - seen.min) / steps_per_side;
  const double begin = std::floor(seen.min / step) * step,
               length = std::ceil((seen.max - seen.min) / step) + 1.0;
  return {std::max(0.0, begin), begin + length * step};
}

// The practical split scheme (Zhang et al. 2006, equation 9). Slice i lies between splits i and i + 1; the
// first begins at the eye, of an orthographic camera at the nearest depth that is seen.
std::vector<double> split_depths(Interval seen, bool orthographic, const CascadeOptions& options) {
  if (!options.splits.empty()) {
    std::vector<double> given{0.0};
    given.insert(given.end(), options.splits.begin(), options.splits.end());
    return given;
  }
  const bool stepped = options.snap && !options.fit_samples;
  if (orthographic) seen = orthographic_range(seen, stepped);
  const double far = stepped && !orthographic ? up_to_size_step(seen.max) : seen.max;
  double near = std::max(seen.min, nearest_share * far);
  if (stepped && !orthographic) near = 0.5 * up_to_size_step(near);
  std::vector<double> splits{orthographic ? seen.min : 0.0};
  for (int i = 1; i <= options.count; ++i) {
    const double share = double(i) / options.count;
    const double even = near + (far - near) * share, logarithmic = near * std::pow(far / near, share);
    splits.push_back(options.lambda * logarithmic + (1.0 - options.lambda) * even);
  }
  splits.back() = far;
  return splits;
}

std::vector<Vec2> slice_corners(const Fit& fit, double from, double to) {
  return light_fit::frustum_corners(fit.view, from, to, fit.frame, fit.reference);
}

Rect around(const std::vector<Vec2>& points) {
  Rect rect;
  for (const Vec2& p : points) rect.grow(p);
  return rect;
}

Rect tight_rect(const Fit& fit, double from, double to) {
  return around(light_fit::hull_in_rect(slice_corners(fit, from, to), fit.casters));
}

Rect sample_rect(const Fit& fit, double from, double to, std::span<const Vec3> visible) {
  Rect rect;
  for (const Vec3& p : visible) {
    const double depth = view_depth(fit, p);
    if (depth >= from && depth <= to) rect.grow(Vec2(to_light_space(fit.frame, p - fit.reference)));
  }
  if (rect.empty()) return rect;
  rect.min = glm::max(rect.min, fit.casters.min), rect.max = glm::min(rect.max, fit.casters.max);
  return rect;
}

struct SliceSphere {
  double middle, radius;  // where along the view's axis
};

// The smallest one around the slice.
SliceSphere sphere_around(const View& view, double from, double to) {
  if (view.orthographic()) {
    const double half = 0.5 * (to - from);
    return {from + half, std::sqrt(half * half + view.half_x * view.half_x + view.half_y * view.half_y)};
  }
  const double k = view.tan_half_x * view.tan_half_x + view.tan_half_y * view.tan_half_y;
  const double middle = std::min(to, 0.5 * (from + to) * (1.0 + k));
  return {middle, std::sqrt((to - middle) * (to - middle) + k * to * to)};
}

// That sphere in light space, as a square of whole texels of a size that only the slice's depths decide.
Rect snapped_square(const Fit& fit, double from, double to, int size) {
  const auto [middle, radius] = sphere_around(fit.view, from, to);
  const double half = radius * size / std::max(1.0, size - 4.0);  // room for the snap and for a border
  const double texel = 2.0 * half / size;
  const Vec2 center(to_light_space(fit.frame, fit.view.eye + middle * fit.view.forward - fit.reference));
  const Vec2 snapped = glm::floor(center / texel + 0.5) * texel;
  return {snapped - half, snapped + half};
}

double area(const Rect& rect) {
  return rect.extent().x * rect.extent().y;
}

Rect with_border(const Rect& rect, int size) {
  const Vec2 half = 0.5 * rect.extent() * (size / std::max(1.0, size - 2.0));
  return {rect.middle() - half, rect.middle() + half};
}

// Along each axis the range of one rectangle or the other, whichever is shorter: where the casters' own is,
// it stands as still as a snapped one.
Rect each_way_smaller(const Rect& a, const Rect& b) {
  Rect out = a;
  for (int axis = 0; axis < 2; ++axis)
    if (b.extent()[axis] < a.extent()[axis]) out.min[axis] = b.min[axis], out.max[axis] = b.max[axis];
  return out;
}

Rect cascade_rect(const Fit& fit, double from, double to, int size, const CascadeOptions& options,
                  std::span<const Vec3> visible) {
  const Rect whole = with_border(fit.casters, size);
  if (options.snap && !options.fit_samples) {
    return each_way_smaller(snapped_square(fit, from, to, size), whole);
  }
  const Rect rect = options.fit_samples ? sample_rect(fit, from, to, visible) : tight_rect(fit, from, to);
  return rect.empty() || !(area(rect) > 0.0) ? whole : with_border(rect, size);
}

LightFace face_of(const Fit& fit, const Rect& rect, const Interval& depths) {
  LightFace face = fit.frame;
  face.center = rect.middle();
  face.half_extent = 0.5 * rect.extent();
  const double widest = std::max(rect.extent().x, rect.extent().y);
  const double margin = 1e-3 * std::max(depths.max - depths.min, 1e-3 * widest);
  face.near_depth = depths.min - margin, face.far_depth = depths.max + margin;
  return face;
}

LightView orthographic_view(const Fit& fit, int size) {
  LightView out;
  out.size = size;
  out.projection = LightProjection::orthographic;
  out.origin = fit.reference;
  return out;
}

Fit make_fit(const World& world, const Light& light, const View& view, const LightFace& frame) {
  Fit fit{world, view, light.direction, frame, world.finite_bounds.center(), {}};
  fit.casters = light_fit::casters_rect(world, frame, fit.reference);
  // A scene that lies in a plane along the light still gets a rectangle.
  const Vec2 extent = fit.casters.extent();
  const Vec2 least(1e-6 * std::max(extent.x, extent.y));
  const Vec2 more = glm::max(Vec2(0.0), 0.5 * (least - extent));
  fit.casters.min -= more, fit.casters.max += more;
  return fit;
}

// A light along the view direction, or opposite to it, has no up that follows the view.
constexpr double least_sine = 1e-3;

struct Warp {
  double middle;           // of the rectangle's x: where the warped lines meet
  double half = infinity;  // half width at its centre
};

// The least half width with |x - middle| <= half (1 + s y) for the whole polygon, y from `center`.
double half_width(const std::vector<Vec2>& polygon, double middle, double center, double warp) {
  double most = 0.0;
  for (const Vec2& p : polygon) most = std::max(most, std::abs(p.x - middle) / (1.0 + warp * (p.y - center)));
  return most;
}

// With the middle that makes it least: a convex function.
Warp narrowest(const std::vector<Vec2>& polygon, const Rect& rect, double warp) {
  const double center = rect.middle().y;
  const auto half = [&](double middle) { return half_width(polygon, middle, center, warp); };
  double low = rect.min.x, high = rect.max.x;
  for (int i = 0; i < 100; ++i) {  // thirds: each step leaves two of three
    const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
    if (half(a) < half(b))
      high = b;
    else
      low = a;
  }
  return {0.5 * (low + high), half(0.5 * (low + high))};
}

// Of a warped map that stands still between steps (fit_warped).
constexpr double angle_step = 2.0 * pi / 64.0;

// The view's direction across the light, turned to the nearest step from a frame that the light alone decides.
Vec3 stepped_up(const Vec3& towards, const Vec3& ahead) {
  const LightFace frame = light_fit::face_along(towards);
  const double angle = std::atan2(glm::dot(ahead, frame.up), glm::dot(ahead, frame.right));
  const double stepped = std::round(angle / angle_step) * angle_step;
  return std::cos(stepped) * frame.right + std::sin(stepped) * frame.up;
}

// Both ends along up moved outwards to whole steps.
Rect stepped_sides(Rect rect) {
  const double step = up_to_size_step(rect.extent().y) / steps_per_side;
  rect.min.y = std::floor(rect.min.y / step) * step, rect.max.y = std::ceil(rect.max.y / step) * step;
  return rect;
}

Warp stepped_width(const std::vector<Vec2>& polygon, const Rect& rect, double warp, const Warp& narrowest) {
  const double step = up_to_size_step(narrowest.half) / steps_per_side;
  const double middle = std::round(narrowest.middle / step) * step;
  return {middle, up_to_size_step(half_width(polygon, middle, rect.middle().y, warp))};
}

}  // namespace

Expected<LightView> fit_cascades(const World& world, const Light& light, const Camera& camera, double aspect,
                                 int size, const CascadeOptions& options, std::span<const Vec3> visible) {
  if (world.finite_bounds.empty()) return fit_light_view(world, light, camera, aspect, size);
  const Fit fit =
      make_fit(world, light, light_fit::view_of(camera, aspect), light_fit::face_along(light.direction));
  if (!(fit.casters.extent().x > 0.0))
    return fail(ErrorKind::bad_input, "the shadow map has nothing to cover: the casters are a point");
  const Interval seen =
      options.fit_samples && !visible.empty() ? sample_depths(fit, visible) : seen_depths(fit);
  if (!(seen.max > 0.0)) return fit_light_view(world, light, camera, aspect, size);
  const std::vector<double> splits = split_depths(seen, fit.view.orthographic(), options);
  LightView out = orthographic_view(fit, size);
  out.face_count = options.count;
  for (int i = 0; i < options.count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const Rect rect = cascade_rect(fit, splits[at], splits[at + 1], size, options, visible);
    const Rect& casters = options.snap && !options.fit_samples ? fit.casters : rect;
    const Interval depths = light_fit::depths_over(world, fit.frame, fit.reference, casters, rect);
    out.faces[at] = face_of(fit, rect, depths);
  }
  return out;
}

Expected<LightView> fit_warped(const World& world, const Light& light, const Camera& camera, double aspect,
                               int size, bool snap) {
  const View view = light_fit::view_of(camera, aspect);
  const double sine = glm::length(glm::cross(view.forward, light.direction));
  if (world.finite_bounds.empty() || sine < least_sine || view.orthographic())
    return fit_light_view(world, light, camera, aspect, size);
  const Vec3 up = snap ? stepped_up(light.direction, view.forward) : view.forward;
  const Fit fit = make_fit(world, light, view, light_fit::face_along(light.direction, up));
  const Interval seen = seen_depths(fit);
  const double far = seen.max, near = std::max(nearest_seen(world, view, far), nearest_share * far);
  if (!(far > 0.0)) return fit_light_view(world, light, camera, aspect, size);
  const std::vector<Vec2> polygon = light_fit::hull_in_rect(slice_corners(fit, near, far), fit.casters);
  Rect rect = around(polygon);
  if (rect.empty() || !(rect.extent().x > 0.0 && rect.extent().y > 0.0))
    return fit_light_view(world, light, camera, aspect, size);
  rect = with_border(rect, size);
  if (snap) rect = stepped_sides(rect);
  // Wimmer et al. 2004, equation 8: the warp's near distance in world units.
  const double exact_n_opt = (near + std::sqrt(near * far)) / sine;
  const double n_opt = snap ? up_to_size_step(exact_n_opt) : exact_n_opt;
  const double half = 0.5 * rect.extent().y;
  LightFace face = fit.frame;
  face.warp = 1.0 / (n_opt + half);
  Warp warp = narrowest(polygon, rect, face.warp);
  if (snap) warp = stepped_width(polygon, rect, face.warp, warp);
  const double half_x = std::max(warp.half, 1e-6 * half) * (size / std::max(1.0, size - 2.0));
  face.center = Vec2(warp.middle, rect.middle().y);
  face.half_extent = Vec2(half_x, half);
  const double reach = half_x * (1.0 + face.warp * half);  // the trapezium's wide end
  const Rect covered{Vec2(warp.middle - reach, rect.min.y), Vec2(warp.middle + reach, rect.max.y)};
  const Interval depths = light_fit::depths_over(world, fit.frame, fit.reference, covered, covered);
  const LightFace ranged = face_of(fit, covered, depths);
  face.near_depth = ranged.near_depth, face.far_depth = ranged.far_depth;
  LightView out = orthographic_view(fit, size);
  out.faces[0] = face;
  return out;
}

}  // namespace gnomon
