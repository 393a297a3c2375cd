#include "hybrid/tile_shapes.h"

#include "raytrace/precision/error_bounds.h"

namespace gnomon::hybrid {
namespace {

using raytrace::error_gamma;
using raytrace::float_above;
using raytrace::float_below;

/// Linear functions are used where their divisor is known to 1 in `well`.
constexpr double well = 0x1p22;

Vec3 to_light_space(const LightFace& face, const Vec3& d) {
  return {glm::dot(face.right, d), glm::dot(face.up, d), glm::dot(face.forward, d)};
}

}  // namespace

TileSquare place_of(const LightView& view, int face, int tile_x, int tile_y) {
  const LightFace& f = view.face(face);
  const double step_x = 2.0 * f.half_extent.x / view.size, step_y = 2.0 * f.half_extent.y / view.size;
  return {tile_x * tile_texels * step_x - f.half_extent.x + f.center.x,
          tile_y * tile_texels * step_y - f.half_extent.y + f.center.y, step_x, step_y};
}

Piece Cover::at(float x, float y, float half_texels) const {
  Piece piece{
      .low = low, .high = high, .facing = facing, .boundary = boundary, .covers = true, .triangle = triangle};
  if (!(error < inf)) return piece;
  piece.middle = reciprocal_depth.at(x, y);
  piece.slope_u = reciprocal_depth.u, piece.slope_v = reciprocal_depth.v, piece.error = error;
  const float spread = half_texels * (std::abs(reciprocal_depth.u) + std::abs(reciprocal_depth.v)) + error;
  piece.low = std::max(low, piece.middle - spread), piece.high = std::min(high, piece.middle + spread);
  return piece;
}

// Perspective: 1/z = (n.x x + n.y y + n.z) / height; else -z = (n.x x + n.y y - height) / n.z.
std::optional<Cover> plane_cover(const SheetGrid& grid, int face, int tile_x, int tile_y, const Plane& plane,
                                 bool masked) {
  const LightView& view = grid.view;
  const Vec3 n = to_light_space(view.faces[static_cast<std::size_t>(face)], plane.normal);
  const double height = glm::dot(plane.normal, plane.point - view.origin);
  const double height_error =
      3.0 * grid.bounds.position_error +
      error_gamma(64) * glm::dot(glm::abs(plane.point) + glm::abs(view.origin), Vec3(1.0));
  const double divisor = grid.perspective ? height : n.z, constant = grid.perspective ? n.z : -height;
  const double divisor_error = grid.perspective ? height_error : error_gamma(64);
  if (!(std::abs(divisor) > well * divisor_error)) return Cover{{}, inf, -inf, inf, Facing::edge_on, true};
  const TileSquare at = place_of(view, face, tile_x, tile_y);
  const double u = n.x * at.step_x / divisor, v = n.y * at.step_y / divisor;
  const double c = (n.x * at.x + n.y * at.y + constant) / divisor;
  const double slope = std::abs(u) + std::abs(v);
  const double size = tile_texels * slope +
                      (std::abs(n.x * at.x) + std::abs(n.y * at.y) + std::abs(constant)) / std::abs(divisor);
  const double error =
      (4.0 / well + 0x1p-20) * size + (grid.perspective ? 0.0 : 2.0 * height_error / std::abs(divisor));
  const bool faces_light = grid.perspective ? height < 0.0 : n.z < 0.0;
  Cover cover{{static_cast<float>(u), static_cast<float>(v), static_cast<float>(c)},
              float_above(error),
              -inf,
              inf,
              faces_light ? Facing::towards : Facing::away,
              masked};
  if (!grid.perspective) return cover;
  const double middle = c + 0.5 * tile_texels * (u + v), most = (0.5 * tile_texels + 1.0) * slope + error;
  if (middle < -most) return std::nullopt;
  cover.low = 0.0f;
  cover.boundary = masked || !(middle > most);  // the horizon may cross the tile
  return cover;
}

Sphere ball_around(const ShapeGeometry& geometry) {
  return {solid_center(geometry), (0.5 + 0x1p-40) * local_box(geometry).diagonal()};
}

SphereColumns::SphereColumns(const SheetGrid& grid, int face, int tile_x, int tile_y, const Sphere& sphere,
                             bool masked)
    : perspective_(grid.perspective), masked_(masked), radius_(sphere.radius) {
  const TileSquare at = place_of(grid.view, face, tile_x, tile_y);
  x0_ = at.x, y0_ = at.y, step_x_ = at.step_x, step_y_ = at.step_y;
  center_ = to_light_space(grid.view.faces[static_cast<std::size_t>(face)], sphere.center - grid.view.origin);
  const double reach = radius_ + 8.0 * grid.bounds.position_error;
  const double slack = 2.0 * texel_slack;
  const Vec2 low(x0_ - slack * step_x_, y0_ - slack * step_y_);
  const Vec2 high(x0_ + (tile_texels + slack) * step_x_, y0_ + (tile_texels + slack) * step_y_);
  const double z = center_.z;
  // Distances from the planes x = low.x (times z) and so on.
  const auto beyond = [&](double c, double bound, double sign) {
    const double off =
        perspective_ ? sign * (bound * z - c) / std::sqrt(1.0 + bound * bound) : sign * (bound - c);
    return off > reach;
  };
  misses_ = beyond(center_.x, low.x, 1.0) || beyond(center_.x, high.x, -1.0) ||
            beyond(center_.y, low.y, 1.0) || beyond(center_.y, high.y, -1.0) || (perspective_ && z < -reach);
  if (!perspective_) {
    most_ = radius_ - z, least_ = -radius_ - z;
    return;
  }
  everywhere_ = !misses_ && !(z > reach + grid.near_limit);
  misses_ = misses_ || everywhere_;
  most_ = 1.0 / (z - radius_), least_ = 1.0 / (z + radius_);
}

// The point (x, y, 1) s of a perspective map's ray, or (x, y, s).
std::optional<SphereColumns::Crossing> SphereColumns::cross(double x, double y) const {
  if (!perspective_) {
    const double dx = x - center_.x, dy = y - center_.y;
    const double square = (radius_ - std::hypot(dx, dy)) * (radius_ + std::hypot(dx, dy));
    if (!(square >= 0.0)) return std::nullopt;
    return Crossing{std::sqrt(square) - center_.z, -std::sqrt(square) - center_.z};
  }
  const Vec3 d(x, y, 1.0);
  const double dd = glm::dot(d, d), along = glm::dot(center_, d);
  const Vec3 off = center_ - (along / dd) * d;
  const double square = (radius_ * radius_ - glm::dot(off, off)) / dd;
  if (!(square >= 0.0)) return std::nullopt;
  const double middle = along / dd, half = std::sqrt(square);
  return Crossing{1.0 / (middle - half), 1.0 / (middle + half)};
}

// Every ray of the column passes within half a texel's diagonal of the centre's, at any depth.
bool SphereColumns::surely_misses(double x, double y) const {
  const double half_diagonal = (0.5 + 4.0 * texel_slack) * std::hypot(step_x_, step_y_);
  if (!perspective_) return std::hypot(x - center_.x, y - center_.y) > radius_ + half_diagonal;
  const Vec3 d(x, y, 1.0);
  const Vec3 off = center_ - (glm::dot(center_, d) / glm::dot(d, d)) * d;
  return glm::length(off) > radius_ + half_diagonal * (center_.z + radius_);
}

std::optional<std::array<Piece, 2>> SphereColumns::at(int x, int y) const {
  constexpr double slack = 2.0 * texel_slack;
  const double x_low = x0_ + (x - slack) * step_x_, x_high = x0_ + (x + 1 + slack) * step_x_;
  const double y_low = y0_ + (y - slack) * step_y_, y_high = y0_ + (y + 1 + slack) * step_y_;
  const double middle_x = 0.5 * (x_low + x_high), middle_y = 0.5 * (y_low + y_high);
  // Near the outline the root magnifies rounding, the more the farther the sphere.
  const double rounding = 0x1p-20 * (most_ - least_) * std::sqrt(1.0 + glm::length(center_) / radius_) +
                          0x1p-40 * std::abs(most_);
  Piece near{.low = float_below(least_ - rounding),
             .high = float_above(most_ + rounding),
             .facing = Facing::towards,
             .boundary = true};
  const std::array<std::optional<Crossing>, 5> crossing{cross(x_low, y_low), cross(x_high, y_low),
                                                        cross(x_low, y_high), cross(x_high, y_high),
                                                        cross(middle_x, middle_y)};
  if (!std::all_of(crossing.begin(), crossing.end(), [](const auto& c) { return c.has_value(); })) {
    Piece far = near;
    far.facing = Facing::away;
    // The outline is convex: a texel farther from it than its own half diagonal misses.
    if (!crossing[4] && surely_misses(middle_x, middle_y)) return std::nullopt;
    return std::array<Piece, 2>{near, far};
  }
  double enters = infinity, leaves = -infinity;
  for (std::size_t i = 0; i < 4; ++i)
    enters = std::min(enters, crossing[i]->enters), leaves = std::max(leaves, crossing[i]->leaves);
  near.low = float_below(enters - rounding);
  near.high = std::min(near.high, float_above(2.0 * crossing[4]->enters - enters + rounding));
  near.boundary = masked_, near.covers = true;
  const Piece far{.low = float_below(2.0 * crossing[4]->leaves - leaves - rounding),
                  .high = float_above(leaves + rounding),
                  .facing = Facing::away,
                  .boundary = masked_,
                  .covers = true};
  return std::array<Piece, 2>{near, far};
}

}  // namespace gnomon::hybrid
