#include "hybrid/sheet_grid.h"

namespace gnomon::hybrid {

SheetGrid::SheetGrid(const World& world, const LightView& light_view)
    : view(light_view),
      bounds(world_bounds(world, light_view)),
      perspective(light_view.projection == LightProjection::perspective),
      tiles((light_view.size + tile_texels - 1) / tile_texels) {
  const double half_size = 0.5 * view.size;
  double half = infinity;
  for (std::size_t f = 0; f < static_cast<std::size_t>(view.face_count); ++f) {
    const LightFace& frame = view.faces[f];
    GridFace& face = faces[f];
    const Vec2 scale = half_size / frame.half_extent;
    face.u = frame.right * scale.x;
    face.v = frame.up * scale.y;
    face.w = frame.forward;
    if (perspective)
      face.u += half_size * frame.forward, face.v += half_size * frame.forward;
    else
      face.u_shift = half_size - scale.x * frame.center.x,
      face.v_shift = half_size - scale.y * frame.center.y;
    half = std::min({half, frame.half_extent.x, frame.half_extent.y});
    hopeless = hopeless || frame.warp != 0.0;
    face.handedness = glm::dot(glm::cross(frame.right, frame.up), frame.forward) < 0.0 ? -1.0 : 1.0;
  }
  // U = size / 2 (x / half + w): both parts carry the position's error. Orthographic: w is 1. The sums' own rounding is in
  // units of U, texels times w.
  grid_error = std::max(view.size, 2 * tile_texels) * (1.0 / half + (perspective ? 1.0 : 0.0)) *
                   bounds.position_error +
               0x1p-48 * view.size * (perspective ? bounds.reach : 1.0);
  if (perspective)
    near_limit = grid_error / texel_slack;
  else
    hopeless = hopeless || !(grid_error < texel_slack);
}

double SheetGrid::reciprocal_depth_error(double reciprocal_depth) const {
  const double by_position = perspective ? 2.0 * reciprocal_depth * reciprocal_depth * bounds.position_error
                                         : 2.0 * bounds.position_error;
  return by_position + 0x1p-21 * std::abs(reciprocal_depth);
}

}  // namespace gnomon::hybrid
