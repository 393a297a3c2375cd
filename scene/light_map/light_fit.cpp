// Fitting a light's depth map to what matters. Directional: the casters' rectangle in light space, cut with
// the camera frustum projected along the light. A shadow has the light-space position of its caster, so
// nothing outside the casters' rectangle can be in shadow, and nothing outside the frustum can be seen. Spot
// and point: the light's own cone or cube, with the tightest depth range that clips nothing.

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "scene/light_map/light_fit_parts.h"
#include "scene/light_map/light_view.h"
#include "scene/shapes/solid.h"
#include "scene/shapes/triangle_blocks.h"

namespace gnomon {
namespace {

using light_fit::face_along;
using light_fit::Rect;
using light_fit::to_light_space;

// The camera frustum down to `reach`, projected along the light and cut with the rectangle; the whole rectangle where the
// camera sees none of it.
Rect visible_part(const Rect& rect, const LightFace& face, const Vec3& reference, const View& view,
                  double reach) {
  if (!(reach > 0.0)) return rect;
  Rect out;
  for (const Vec2& p :
       light_fit::hull_in_rect(light_fit::frustum_corners(view, 0.0, reach, face, reference), rect))
    out.grow(p);
  return out.empty() ? rect : out;
}

double view_reach(const World& world, const View& view) {
  const bool has_plane = std::any_of(world.shapes.begin(), world.shapes.end(), [](const Shape& s) {
    return std::holds_alternative<Plane>(s.geometry);
  });
  const double far_away =
      1e4 * (world.finite_bounds.diagonal() + glm::length(world.finite_bounds.center() - view.eye));
  return has_plane ? far_away : light_fit::finite_reach(world, view);
}

// The light-space box of a box, by so much too large that no rounding puts a corner outside it.
Aabb extent_of(const Aabb& bounds, const LightFace& face, const Vec3& reference) {
  const Aabb from{bounds.min - reference, bounds.max - reference};
  Aabb box;
  for (int a = 0; a < 3; ++a) {
    const Vec3& axis = a == 0 ? face.right : a == 1 ? face.up : face.forward;
    box.min[a] = -farthest_along(from, -axis), box.max[a] = farthest_along(from, axis);
  }
  const Vec3 size = glm::abs(box.min) + glm::abs(box.max);
  const Vec3 margin(1e-9 * (size.x + size.y + size.z));
  return {box.min - margin, box.max + margin};
}

struct Extent {
  Rect rect;
  double z_min, z_max;
};

Extent extent_of(const WorldPart& part, std::uint32_t triangle, const LightFace& face,
                 const Vec3& reference) {
  Aabb box;
  for (const Vec3& corner : part.corners(triangle)) box.grow(to_light_space(face, corner - reference));
  return {{Vec2(box.min), Vec2(box.max)}, box.min.z, box.max.z};
}

/// Returns the extent of a finite shape.
Extent extent_of(const Shape& shape, const LightFace& face, const Vec3& reference) {
  const auto* sphere = std::get_if<Sphere>(&shape.geometry);
  const Vec3 center = sphere != nullptr ? sphere->center : solid_center(shape.geometry);
  const auto reach = [&](const Vec3& axis) {
    return sphere != nullptr ? sphere->radius : reach_along(shape.geometry, axis);
  };
  const Vec3 c = to_light_space(face, center - reference);
  const Vec3 half(reach(face.right), reach(face.up), reach(face.forward));
  return {{Vec2(c - half), Vec2(c + half)}, c.z - half.z, c.z + half.z};
}

// Adds up the light-space extents of all finite primitives, by add(sum, extent) and join(sum, other sum), as over_blocks()
// does; makes_no_difference(sum, box) is asked with boxes in light space.
template <class Sum, class Without, class Add, class Join>
Sum over_extents(const World& world, const LightFace& face, const Vec3& reference, const Sum& none,
                 const Without& makes_no_difference, const Add& add, const Join& join) {
  Sum sum = over_blocks(
      world, none,
      [&](const Sum& so_far, const Aabb& box) {
        return makes_no_difference(so_far, extent_of(box, face, reference));
      },
      [&](Sum& so_far, const WorldPart& part, std::uint32_t triangle) {
        add(so_far, extent_of(part, triangle, face, reference));
      },
      join);
  for (const Shape& shape : world.shapes)
    if (!std::holds_alternative<Plane>(shape.geometry)) add(sum, extent_of(shape, face, reference));
  return sum;
}

// Where the pixel rays of a coarse grid meet the infinite planes, within 50 camera distances.
Rect visible_plane_part(const World& world, const LightFace& face, const Vec3& reference, const View& view) {
  constexpr int steps = 64;
  Rect rect;
  for (const Shape& shape : world.shapes) {
    const auto* plane = std::get_if<Plane>(&shape.geometry);
    if (plane == nullptr) continue;
    const double height = std::abs(glm::dot(plane->normal, view.eye - plane->point));
    for (int i = 0; i <= steps * steps + 2 * steps; ++i) {
      const int column = i % (steps + 1), row = i / (steps + 1);
      const Ray ray =
          pixel_ray(view, view.size.width * double(column) / steps, view.size.height * double(row) / steps);
      const double t =
          glm::dot(plane->normal, plane->point - ray.origin) / glm::dot(plane->normal, ray.direction);
      if (t > 0.0 && t <= 50.0 * height) rect.grow(Vec2(to_light_space(face, ray.at(t) - reference)));
    }
  }
  return rect;
}

/// What a directional light's map is fitted to, whatever the camera.
struct Casters {
  LightFace face;
  std::optional<Vec3> middle;  ///< of what is finite
  Rect rect;
  Casters(const World& world, const Light& light) : face(face_along(light.direction)) {
    if (world.finite_bounds.empty()) return;
    middle = world.finite_bounds.center();
    rect = light_fit::casters_rect(world, face, *middle);
  }
  Vec3 reference(const View& view) const { return middle.value_or(view.eye); }
};

/// The part of it that the camera sees.
Expected<Rect> fit_rect(const World& world, const Casters& casters, const View& view) {
  const Vec3 reference = casters.reference(view);
  const Rect rect = casters.middle
                        ? visible_part(casters.rect, casters.face, reference, view, view_reach(world, view))
                        : visible_plane_part(world, casters.face, reference, view);
  if (rect.empty())
    return fail(ErrorKind::graphics, "the shadow map has nothing to cover: the camera sees no surface");
  return rect;
}

double widest(const Rect& rect) {
  return std::max(rect.max.x - rect.min.x, rect.max.y - rect.min.y);
}

/// The map over the rectangle, or over the window given, without depths.
LightView window_over(const Casters& casters, const Rect& rect, const View& view, int size,
                      const LightWindow& given) {
  LightView out;
  out.size = size;
  out.projection = LightProjection::orthographic;
  out.faces[0] = casters.face;
  const Vec2 middle = rect.middle();
  out.origin = casters.reference(view) + middle.x * casters.face.right + middle.y * casters.face.up;
  if (!given.origin.empty()) out.origin = Vec3(given.origin[0], given.origin[1], given.origin[2]);
  // One texel of margin on each side, so that no caster's silhouette falls on the border.
  Vec2 half =
      glm::max(0.5 * (rect.max - rect.min), Vec2(1e-6 * widest(rect))) * (size / std::max(1.0, size - 2.0));
  if (!given.size.empty()) half = 0.5 * Vec2(given.size[0], given.size[1]);
  out.set_extent(half, 0.0, 1.0);
  return out;
}

/// What the window covers of light space, measured from `reference`.
Rect covered(const LightView& window, const Vec3& reference) {
  const LightFace& face = window.faces[0];
  const Vec2 middle(to_light_space(face, window.origin - reference));
  return {middle - face.half_extent, middle + face.half_extent};
}

Expected<LightView> fit_directional(const World& world, const Light& light, const View& view, int size,
                                    const LightWindow& given) {
  const Casters casters(world, light);
  auto rect = fit_rect(world, casters, view);
  if (!rect && (given.size.empty() || given.origin.empty())) return fail(rect.error());
  if (given.size.empty() && !(widest(*rect) > 0.0))
    return fail(ErrorKind::bad_input, "the shadow map has nothing to cover: the casters are a point");
  const Vec3 reference = casters.reference(view);
  LightView out = window_over(casters, rect ? *rect : Rect{}, view, size, given);
  const Vec2 half = out.faces[0].half_extent;
  // A fitted origin lies across the light from the reference, and rounding shall not say otherwise.
  const double origin_depth =
      given.origin.empty() ? 0.0 : to_light_space(casters.face, out.origin - reference).z;
  if (!given.depths.empty()) {
    // Without an origin, depths are counted from the middle of what is finite, as they are fitted.
    out.set_extent(half, given.depths[0], given.depths[1]);
    return out;
  }
  const bool moved = !given.size.empty() || !given.origin.empty();
  const Rect over = moved ? covered(out, reference) : *rect;
  const Interval z = light_fit::depths_over(world, casters.face, reference, over, over);
  const double margin = 1e-3 * std::max(z.max - z.min, 1e-3 * widest(over));
  out.set_extent(half, z.min - margin - origin_depth, z.max + margin - origin_depth);
  return out;
}

// Depth range of a perspective map: nothing closer than `near` exists; finite things end before `far`, and an
// infinite plane is kept until the shadow of anything finite has left it (ten times the scene, or 50
// heights).
void fit_depth(const World& world, const Vec2& half_extent, LightView& view) {
  const double closest = light_fit::closest_distance(world, view.origin);
  double far_depth = light_fit::farthest_distance(world, view.origin);
  for (const Shape& shape : world.shapes) {
    if (const auto* plane = std::get_if<Plane>(&shape.geometry))
      far_depth = std::max({10.0 * far_depth, far_depth,
                            50.0 * std::abs(glm::dot(plane->normal, plane->point - view.origin))});
  }
  const double diagonal = std::sqrt(1.0 + half_extent.x * half_extent.x + half_extent.y * half_extent.y);
  far_depth *= 1.001;
  view.set_extent(half_extent, std::max(0.999 * closest / diagonal, 1e-4 * far_depth), far_depth);
}

}  // namespace

namespace light_fit {

Rect casters_rect(const World& world, const LightFace& face, const Vec3& reference) {
  const auto inside = [](const Rect& rect, const Aabb& box) {
    return box.min.x > rect.min.x && box.min.y > rect.min.y && box.max.x < rect.max.x &&
           box.max.y < rect.max.y;
  };
  const auto grow = [](Rect& rect, const Rect& more) { rect.grow(more.min), rect.grow(more.max); };
  return over_extents(
      world, face, reference, Rect{}, inside, [&](Rect& rect, const Extent& e) { grow(rect, e.rect); },
      [&](Rect& rect, const Rect& more) {
        if (!more.empty()) grow(rect, more);
      });
}

Interval depths_over(const World& world, const LightFace& face, const Vec3& reference, const Rect& casters,
                     const Rect& rect) {
  const auto beside_or_inside = [&](const Interval& z, const Aabb& box) {
    return !Rect{Vec2(box.min), Vec2(box.max)}.overlaps(casters) || (box.min.z > z.min && box.max.z < z.max);
  };
  const auto grow = [](Interval& z, double min, double max) {
    z.min = std::min(z.min, min), z.max = std::max(z.max, max);
  };
  Interval z = over_extents(
      world, face, reference, Interval{infinity, -infinity}, beside_or_inside,
      [&](Interval& sum, const Extent& e) {
        if (e.rect.overlaps(casters)) grow(sum, e.z_min, e.z_max);
      },
      [&](Interval& sum, const Interval& more) { grow(sum, more.min, more.max); });
  for (const Shape& shape : world.shapes) {
    const auto* plane = std::get_if<Plane>(&shape.geometry);
    if (plane == nullptr) continue;
    const Vec3 n = to_light_space(face, plane->normal);
    if (std::abs(n.z) < 1e-6) continue;  // edge-on: the light travels along the plane
    const double offset = glm::dot(plane->normal, plane->point - reference);
    for (const Vec2 c : {rect.min, rect.max, Vec2(rect.min.x, rect.max.y), Vec2(rect.max.x, rect.min.y)}) {
      const double depth = (offset - n.x * c.x - n.y * c.y) / n.z;
      z.min = std::min(z.min, depth), z.max = std::max(z.max, depth);
    }
  }
  if (!z.empty()) return z;
  const Rect everything{Vec2(-infinity), Vec2(infinity)};
  return casters.min.x == -infinity ? Interval{0.0, 1.0}
                                    : depths_over(world, face, reference, everything, rect);
}

}  // namespace light_fit

Expected<LightView> fit_light_view(const World& world, const Light& light, const Camera& camera,
                                   double aspect, int size, const LightWindow& window) {
  if (light.type == LightType::directional)
    return fit_directional(world, light, light_fit::view_of(camera, aspect), size, window);
  if (!window.size.empty() || !window.origin.empty())
    return fail(
        ErrorKind::usage,
        "a window's size and origin are those of a directional light's map (got the spot or point light " +
            light.name + "; its window follows from the light, and its depths alone can be given)");
  if (!window.depths.empty() && !(window.depths[0] > 0.0))
    return fail(ErrorKind::usage,
                "the near depth of a spot or point light's map is above 0 (light " + light.name + ")");
  LightView out;
  out.size = size;
  out.projection = LightProjection::perspective;
  out.origin = light.position;
  Vec2 half_extent(1.0);
  if (light.type == LightType::spot) {
    out.faces[0] = face_along(light.direction);
    half_extent = Vec2(std::tan(light.outer_angle) * size / std::max(1.0, size - 2.0));
  } else {
    out.face_count = 6;
    std::ranges::copy(cube_faces(), out.faces.begin());
  }
  if (world.primitive_count() == 0)
    return fail(ErrorKind::graphics, "the shadow map has nothing to cover: the scene has no surface");
  if (window.depths.empty())
    fit_depth(world, half_extent, out);
  else
    out.set_extent(half_extent, window.depths[0], window.depths[1]);
  return out;
}

WindowCasters window_casters(const World& world, const LightView& view) {
  const LightFace& face = view.face(0);
  const Rect window = covered(view, view.origin);
  const auto count = [&](WindowCasters& sum, const Extent& e) {
    const bool wholly = e.rect.min.x >= window.min.x && e.rect.min.y >= window.min.y &&
                        e.rect.max.x <= window.max.x && e.rect.max.y <= window.max.y;
    const bool between = e.z_min >= face.near_depth && e.z_max <= face.far_depth;
    ++(!e.rect.overlaps(window)    ? sum.beside
       : e.z_max < face.near_depth ? sum.before
       : e.z_min > face.far_depth  ? sum.beyond
       : wholly && between         ? sum.inside
                                   : sum.cut);
  };
  const auto count_blocks = [&](std::size_t first, std::size_t last, WindowCasters sum) {
    for (std::size_t b = first; b < last; ++b) {
      const TriangleBlock& block = world.blocks[b];
      const WorldPart& part = world.parts[block.part];
      for (std::uint32_t i = block.first; i < block.first + block.count; ++i)
        if (world.scene->materials[part.material_of(i)].casts_shadow)
          count(sum, extent_of(part, i, face, view.origin));
    }
    return sum;
  };
  WindowCasters sum = parallel_reduce(world.blocks.size(), 16, WindowCasters{}, count_blocks,
                                      [](WindowCasters a, const WindowCasters& b) {
                                        a.inside += b.inside, a.cut += b.cut, a.beside += b.beside;
                                        a.before += b.before, a.beyond += b.beyond;
                                        return a;
                                      });
  for (const Shape& shape : world.shapes)
    if (!std::holds_alternative<Plane>(shape.geometry) && world.scene->materials[shape.material].casts_shadow)
      count(sum, extent_of(shape, face, view.origin));
  return sum;
}

bool window_moves(const World& world, const Light& light, const std::array<Camera, 2>& cameras, double aspect,
                  int size, const LightWindow& window) {
  if (!window.size.empty() && !window.origin.empty()) return false;
  const Casters casters(world, light);
  const Vec3 point = world.finite_bounds.empty() ? Vec3(0.0) : world.finite_bounds.center();
  std::array<TexelCoordinate, 2> at;
  for (std::size_t i = 0; i < 2; ++i) {
    const View view = light_fit::view_of(cameras[i], aspect);
    const auto rect = fit_rect(world, casters, view);
    if (!rect || !(widest(*rect) > 0.0)) return false;
    at[i] = project_to_texel(window_over(casters, *rect, view, size, window), point);
  }
  constexpr double rounding = 1e-6;  // texels: of the fit's doubles, in maps of up to 2^16
  return std::abs(at[0].u - at[1].u) > rounding || std::abs(at[0].v - at[1].v) > rounding;
}

}  // namespace gnomon
