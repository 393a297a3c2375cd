#include "hybrid/solid_columns.h"

#include "raytrace/precision/error_bounds.h"
#include "raytrace/shapes/along_ray.h"

namespace gnomon::hybrid {
namespace {

using raytrace::Bounds;

/// Depth is cut into up to 2^levels slabs, of which so many are looked at: where the bounds stay wide (thin
/// walls, many terms) more would not tell either.
constexpr int levels = 5, most_slabs = 24;

}  // namespace

/// What is known of a column so far, from one end on.
struct SolidColumns::Scan {
  bool backwards = false;
  double first = 0.0;    ///< depth where the solid may begin
  double crossed = 0.0;  ///< every ray has met the surface before this depth
  bool begun = false, sure = false;
  int left = most_slabs;
  Slab last = Slab::unknown;  ///< the last sign of an open surface that was sure, unknown: none since a gap
};

SolidColumns::SolidColumns(const SheetGrid& grid, int face, int tile_x, int tile_y,
                           const ShapeGeometry& solid, bool masked)
    : solid_(solid),
      perspective_(grid.perspective),
      masked_(masked),
      closed_(is_closed(solid)),
      convex_(is_convex(solid)),
      box_(local_box(solid)),
      first_cut_(closed_ ? raytrace::first_cut_axis(solid) : 0) {
  const Sphere ball = ball_around(solid);
  const SphereColumns around(grid, face, tile_x, tile_y, ball, true);
  misses_ = around.misses_tile() && !around.is_everywhere();
  const LightView& view = grid.view;
  const LightFace& f = view.faces[static_cast<std::size_t>(face)];
  const TileSquare at = place_of(view, face, tile_x, tile_y);
  x0_ = at.x, y0_ = at.y, step_x_ = at.step_x, step_y_ = at.step_y;
  error_ = 16.0 * grid.bounds.position_error + 0x1p-30 * box_.diagonal();
  const ShapeFrame& frame = frame_of(solid);
  start_ = to_local(frame, view.origin);
  const Mat3 turn = glm::transpose(frame.axes);
  right_ = turn * f.right, up_ = turn * f.up, forward_ = turn * f.forward;
  const double depth = glm::dot(f.forward, ball.center - view.origin), reach = ball.radius + error_;
  ends_ = {depth - reach, depth + reach};
  if (!perspective_) return;
  // Rays are (x, y, 1) times depth: as long as they are shorter than the way to the ball they are not in it.
  const double longest = 1.01 * glm::length(Vec3(glm::abs(f.center) + f.half_extent, 1.0));
  const double before = (glm::length(ball.center - view.origin) - reach) / longest;
  everywhere_ = !misses_ && !(before > grid.near_limit + error_);
  ends_[0] = std::max(ends_[0], before);
  misses_ = misses_ || everywhere_ || !(ends_[1] > ends_[0]);
}

// Perspective: the rays are (x, y, 1) times depth. Orthographic: (x, y, depth).
SolidColumns::Column SolidColumns::column(int x, int y, int texels) const {
  constexpr double slack = 2.0 * texel_slack;
  const Bounds across(x0_ + (x - slack) * step_x_, x0_ + (x + texels + slack) * step_x_);
  const Bounds along(y0_ + (y - slack) * step_y_, y0_ + (y + texels + slack) * step_y_);
  Column out;
  for (int a = 0; a < 3; ++a) {
    const auto k = static_cast<std::size_t>(a);
    const Bounds sideways = across * Bounds(right_[a]) + along * Bounds(up_[a]);
    const Bounds origin(start_[a] - error_, start_[a] + error_);
    out.start[k] = perspective_ ? origin : origin + sideways;
    out.direction[k] = perspective_ ? sideways + Bounds(forward_[a]) : Bounds(forward_[a]);
  }
  return out;
}

std::array<Bounds, 3> SolidColumns::places(const Column& column, double from, double to) const {
  const Bounds depth(std::min(from, to), std::max(from, to));
  return {column.start[0] + depth * column.direction[0], column.start[1] + depth * column.direction[1],
          column.start[2] + depth * column.direction[2]};
}

SolidColumns::Slab SolidColumns::slab(const Column& column, double from, double to, bool& continuous) const {
  const std::array<Bounds, 3> p = places(column, from, to);
  bool in_box = true;
  for (int a = 0; a < 3; ++a) {
    const auto k = static_cast<std::size_t>(a);
    if (a < first_cut_ && closed_) continue;
    if (p[k].hi < box_.min[a] || p[k].lo > box_.max[a]) return Slab::outside;
    in_box = in_box && p[k].lo > box_.min[a] && p[k].hi < box_.max[a];
  }
  const Bounds value = solid_value(solid_, p[0], p[1], p[2]);
  continuous = value.sure && in_box;
  if (closed_) {
    if (value.positive() || value.is_empty()) return Slab::outside;
    return value.negative() && continuous ? Slab::inside : Slab::unknown;
  }
  if (!value.without_zero() && !value.is_empty()) return Slab::unknown;
  if (!continuous) return Slab::outside;
  return value.positive() ? Slab::positive : Slab::negative;
}

double SolidColumns::depth_at(int level, int index, bool backwards) const {
  const double share = static_cast<double>(index) / static_cast<double>(1 << level);
  return backwards ? ends_[1] - share * (ends_[1] - ends_[0]) : ends_[0] + share * (ends_[1] - ends_[0]);
}

bool SolidColumns::scan(const Column& column, int level, int index, Scan& scan) const {
  const double from = depth_at(level, index, scan.backwards), to = depth_at(level, index + 1, scan.backwards);
  bool continuous = false;
  const Slab what = scan.left-- > 0 ? slab(column, from, to, continuous) : Slab::unknown;
  if (what == Slab::unknown && level < levels && scan.left > 0)
    return this->scan(column, level + 1, 2 * index, scan) &&
           this->scan(column, level + 1, 2 * index + 1, scan);
  if (what == Slab::outside) {
    scan.last = Slab::unknown;
    return true;
  }
  const bool is_sign = what == Slab::negative || what == Slab::positive;
  const bool changed = is_sign && scan.last != Slab::unknown && scan.last != what;
  if (!scan.begun && !is_sign) scan.first = from, scan.begun = true;
  if (what == Slab::inside || changed) {
    scan.crossed = from, scan.sure = true;
    return false;
  }
  if (is_sign)
    scan.last = what;
  else if (!continuous)
    scan.last = Slab::unknown;
  return true;
}

// Of a closed solid the function with its cuts; an open one must lie within its box all the way.
bool SolidColumns::met_once(const Column& column, double from, double to) const {
  constexpr int steps = 4;
  int falls = 0, rises = 0;
  for (int i = 0; i < steps; ++i) {
    const double begin = from + (to - from) * i / steps, end = from + (to - from) * (i + 1) / steps;
    const std::array<Bounds, 3> p = places(column, begin, end);
    const raytrace::Slope f = raytrace::body_slope(solid_, {p[0], column.direction[0]},
                                                   {p[1], column.direction[1]}, {p[2], column.direction[2]});
    if (!f.value.sure) return false;
    falls += f.change.negative() ? 1 : 0, rises += f.change.positive() ? 1 : 0;
    for (int a = 0; a < 3 && !closed_; ++a) {
      const Bounds& at = p[static_cast<std::size_t>(a)];
      if (!(at.lo > box_.min[a] && at.hi < box_.max[a])) return false;
    }
  }
  return falls == steps || rises == steps;
}

float SolidColumns::nearest(double depth) const {
  return raytrace::float_above(perspective_ ? (1.0 + 0x1p-40) / depth : -depth);
}
float SolidColumns::farthest(double depth) const {
  return raytrace::float_below(perspective_ ? (1.0 - 0x1p-40) / depth : -depth);
}

bool SolidColumns::misses(int x, int y, int texels) const {
  const Column rays = column(x, y, texels);
  Scan front;
  scan(rays, 0, 0, front);
  return !front.begun && !front.sure;
}

SolidColumns::Pieces SolidColumns::at(int x, int y) const {
  const Column rays = column(x, y, 1);
  Scan front;
  scan(rays, 0, 0, front);
  Pieces out;
  if (!front.begun && !front.sure) return out;
  const double begin = front.begun ? front.first : front.crossed;
  Piece anywhere{.low = farthest(ends_[1]), .high = nearest(begin), .boundary = true};
  if (!front.sure || masked_) {
    out.add(anywhere);
    return out;
  }
  out.add({.low = farthest(front.crossed), .high = anywhere.high, .facing = Facing::towards, .covers = true});
  if (!convex_) {
    if (met_once(rays, begin, front.crossed)) anywhere.high = nearest(front.crossed);
    out.add(anywhere);
    return out;
  }
  Scan back{.backwards = true};
  scan(rays, 0, 0, back);
  const double end = back.begun ? back.first : back.crossed;
  out.add({.low = farthest(end),
           .high = nearest(back.sure ? back.crossed : front.crossed),
           .facing = Facing::away,
           .boundary = !back.sure,
           .covers = true});
  return out;
}

}  // namespace gnomon::hybrid
