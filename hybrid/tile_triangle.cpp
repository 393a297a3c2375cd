#include "hybrid/tile_triangle.h"

#include "raytrace/precision/error_bounds.h"

namespace gnomon::hybrid {
namespace {

using raytrace::float_above;
using raytrace::float_below;

/// The plane is used where its coefficients are known to this relative error; else the corners' reciprocal depth.
constexpr double plane_error = 0x1p-22;

TileFunction to_float(double u, double v, double c) {
  return {static_cast<float>(u), static_cast<float>(v), static_cast<float>(c)};
}

}  // namespace

/// Corners relative to the tile; `size` bounds their coordinates with w in units of a tile.
struct TileFrame::Corners {
  std::array<double, 3> u, v, w, size, error;
  std::array<double, 3> a, b, c, norm, edge_error;  // edge functions before scaling
  double det = 0.0;
  bool clipped = false;
};

TileFrame::TileFrame(const SheetGrid& grid, int face, int tile_x, int tile_y)
    : grid_(grid),
      u0_(tile_x * tile_texels),
      v0_(tile_y * tile_texels),
      width_(std::min(tile_texels, grid.view.size - tile_x * tile_texels)),
      height_(std::min(tile_texels, grid.view.size - tile_y * tile_texels)),
      handedness_(grid.faces[static_cast<std::size_t>(face)].handedness) {}

bool TileFrame::set_up(const std::array<ProjectedPoint, 3>& points, TriangleFacing facing,
                       TileTriangle& out) const {
  Corners corners;
  for (std::size_t k = 0; k < 3; ++k) {
    const ProjectedPoint& p = points[k];
    corners.u[k] = p.u - u0_ * p.w, corners.v[k] = p.v - v0_ * p.w, corners.w[k] = p.w;
    corners.size[k] = std::max({std::abs(corners.u[k]), std::abs(corners.v[k]), tile_texels * std::abs(p.w)});
    corners.error[k] = grid_.grid_error + 0x1p-50 * grid_.view.size * std::abs(p.w);
    corners.clipped = corners.clipped || !(p.w > grid_.near_limit);
  }
  if (!find_box(corners, out)) return false;
  out.boundary = facing.boundary;
  out.facing = facing.facing > 0 ? Facing::towards : facing.facing < 0 ? Facing::away : Facing::edge_on;
  // A triangle that faces the light has its normal against forward.
  const double inside = -facing.facing * handedness_;
  find_edges(corners, inside, out);
  if (out.facing == Facing::edge_on) out.boundary |= TriangleFacing::whole;
  for (std::size_t k = 0; k < 3; ++k) {
    const float middle = 0.5f * tile_texels;
    const float farthest = out.edge[k].at(middle, middle) + middle + static_cast<float>(texel_slack);
    if (out.facing != Facing::edge_on && farthest < -out.error[k]) return false;
  }
  find_reciprocal_depth(points, corners, out);
  return true;
}

bool TileFrame::find_box(const Corners& t, TileTriangle& out) const {
  out.x0 = 0, out.x1 = width_ - 1, out.y0 = 0, out.y1 = height_ - 1;
  out.box.fill({-inf, inf, -inf, inf});
  out.clipped = t.clipped;
  if (t.clipped) return true;
  std::array<double, 3> u, v;
  for (std::size_t k = 0; k < 3; ++k) u[k] = t.u[k] / t.w[k], v[k] = t.v[k] / t.w[k];
  constexpr double slack = 2.0 * texel_slack;  // of the grid and of what is looked up
  const auto [u_min, u_max] = std::minmax({u[0], u[1], u[2]});
  const auto [v_min, v_max] = std::minmax({v[0], v[1], v[2]});
  if (!(u_max > -slack && v_max > -slack && u_min < width_ + slack && v_min < height_ + slack)) return false;
  const auto texel = [](double at, int count) {
    return static_cast<int>(std::clamp(std::floor(at), 0.0, count - 1.0));
  };
  out.x0 = texel(u_min - slack, width_), out.x1 = texel(u_max + slack, width_);
  out.y0 = texel(v_min - slack, height_), out.y1 = texel(v_max + slack, height_);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t j = (k + 1) % 3;
    out.corner[k] = {u[k], v[k]};
    out.box[k] = {float_below(std::min(u[k], u[j]) - slack), float_above(std::max(u[k], u[j]) + slack),
                  float_below(std::min(v[k], v[j]) - slack), float_above(std::max(v[k], v[j]) + slack)};
  }
  return true;
}

// inside: 1 or -1 turns the edge functions; 0 (edge-on) turns each towards the corner across it.
void TileFrame::find_edges(Corners& t, double inside, TileTriangle& out) const {
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = k, j = (k + 1) % 3, other = (k + 2) % 3;
    t.a[k] = t.v[i] * t.w[j] - t.w[i] * t.v[j];
    t.b[k] = t.w[i] * t.u[j] - t.u[i] * t.w[j];
    t.c[k] = t.u[i] * t.v[j] - t.v[i] * t.u[j];
    t.norm[k] = std::abs(t.a[k]) + std::abs(t.b[k]);
    // Six products of one component each; u and v up to a tile's width, as tile_texels * w.
    t.edge_error[k] =
        7.0 * (t.error[i] * t.size[j] + t.error[j] * t.size[i] + 0x1p-49 * t.size[i] * t.size[j]);
    const double across = t.a[k] * t.u[other] + t.b[k] * t.v[other] + t.c[k] * t.w[other];
    if (k == 0) t.det = across;
    const double sign = inside != 0.0 ? inside : across < 0.0 ? -1.0 : 1.0;
    const double scale = sign / t.norm[k];
    const double error = t.edge_error[k] / t.norm[k];
    out.edge[k] = to_float(scale * t.a[k], scale * t.b[k], scale * t.c[k]);
    out.error[k] = float_above(error + 0x1p-21 * (2.0 * tile_texels + std::abs(scale * t.c[k])));
    out.depth[k] = t.clipped ? inf : float_above(std::abs(across) / (t.norm[k] * t.w[other]) + error);
    if (std::isfinite(scale) && std::isfinite(error)) continue;
    out.edge[k] = {}, out.error[k] = out.depth[k] = inf;  // an edge without direction tells nothing
  }
}

void TileFrame::find_reciprocal_depth(const std::array<ProjectedPoint, 3>& p, const Corners& t,
                                      TileTriangle& out) const {
  double low = infinity, high = -infinity, well = infinity, reach = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double n = t.clipped && !(p[k].w > grid_.near_limit) ? infinity : p[k].reciprocal_depth;
    const double error = std::isfinite(n) ? grid_.reciprocal_depth_error(n) : 0.0;
    low = std::min(low, n - error), high = std::max(high, n + error);
    // The height of the corner across edge k against the edge's error.
    const std::size_t other = (k + 2) % 3;
    const double w = std::max(std::abs(p[other].w), grid_.near_limit);
    well = std::min(well, std::abs(t.det) / (w * t.edge_error[k]));
    reach = std::max(reach, 1.0 / w);
  }
  if (!grid_.perspective) reach = high - low;
  out.low = float_below(low), out.high = float_above(high);
  out.reciprocal_depth = {}, out.reciprocal_depth_error = inf;
  if (out.facing == Facing::edge_on || !(well * plane_error > 1.0)) return;
  // n = sum over the corners of b_k n_k, with b_k the edge function across from the corner over det.
  double u = 0.0, v = 0.0, c = grid_.perspective ? 0.0 : p[0].reciprocal_depth;
  for (std::size_t k = 0; k < 3; ++k) {
    const double weight =
        (grid_.perspective ? 1.0 : p[(k + 2) % 3].reciprocal_depth - p[0].reciprocal_depth) / t.det;
    u += weight * t.a[k], v += weight * t.b[k], c += weight * t.c[k];
  }
  const double slope = std::abs(u) + std::abs(v);
  const double error = 4.0 * plane_error * reach + 0x1p-21 * (tile_texels * slope + std::abs(c));
  if (!std::isfinite(error) || !std::isfinite(slope)) return;
  out.reciprocal_depth = to_float(u, v, c);
  out.reciprocal_depth_error = float_above(error);
}

bool TileFrame::covers_tile(const TileTriangle& t) {
  // Edge-on, an edge may cross the tile: no edge is known to pass beside it, and the whole triangle is boundary.
  const bool edge_on = t.facing == Facing::edge_on;
  if (edge_on && (!t.clipped || t.reciprocal_depth_error < inf)) return false;
  const float middle = 0.5f * tile_texels;
  for (std::size_t k = 0; k < 3; ++k) {
    const float least = t.edge[k].at(middle, middle) - middle - static_cast<float>(texel_slack);
    if (!(least > (edge_on ? -t.error[k] : t.error[k]))) return false;
  }
  return true;
}

}  // namespace gnomon::hybrid
