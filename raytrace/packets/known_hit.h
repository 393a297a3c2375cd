// What a tile's receivers are found from when it is known which primitive a pixel shows.
#pragma once

#include "raytrace/kernels.h"
#include "raytrace/packets/passes.h"

namespace gnomon::raytrace {

/// The world axis along which a vector is longest.
inline int longest_axis(const Vec3& v) {
  const Vec3 size = glm::abs(v);
  return size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
}

/// The world axis along which the tile's rays are longest, for most of them.
inline int axis_of(const View& view, const TileRect& rect) {
  return longest_axis(pixel_ray(view, 0.5 * (rect.x0 + rect.x1), 0.5 * (rect.y0 + rect.y1)).direction);
}

/// Where the ray sees the one primitive at this leaf position: no hole of a mask, and no back that is not seen.
inline std::optional<Hit> hit_at(const Structures& s, const Ray& ray, std::uint32_t leaf) {
  const std::optional<RayFrame> frame = make_ray_frame(ray);
  if (!frame || leaf == nothing_hit) return std::nullopt;
  Hit hit;
  const bool intersected = leaf >= first_plane ? intersect_plane(s, *frame, s.planes[leaf - first_plane], hit)
                                               : intersect_leaf(s, *frame, leaf, hit);
  if (!intersected || is_hidden_back(s, ray.direction, hit.primitive) ||
      (s.has_masks && !passes_alpha_test(s, *frame, hit)))
    return std::nullopt;
  hit.t /= frame->kernel_t_from_t;
  return hit;
}

}  // namespace gnomon::raytrace
