#include "studies/judge/stored_depths.h"

#include <algorithm>
#include <bit>
#include <tuple>

#include "compare/ladder/biased_test.h"
#include "compare/ladder/moments.h"
#include "compare/ladder/paraboloids.h"

namespace gnomon::compare {
namespace {

constexpr double arithmetic =
    0x1p-22;  ///< of stored numbers: a matrix and a depth between 1/2 and 1, in floats
constexpr double steps_allowed = 0.75;     ///< of the format; rounding takes half of one
constexpr double scene_reach = 1.0 / 8.0;  ///< texels: a rasterizer's sample places are kept in 1/256 of one

/// The step of whole numbers of so many bits, if that is what all values are.
bool are_whole_numbers(const std::vector<float>& values, double most) {
  return std::all_of(values.begin(), values.end(), [most](float v) {
    const double scaled = most * double{v};
    return std::abs(scaled - std::round(scaled)) < 0x1p-20 * most;
  });
}

/// Returns the step of numbers between 1/2 and 1 that have no bits below those that all values have.
double step_of_bits(const std::vector<float>& values) {
  int zeros = 23;
  for (const float v : values)
    if (v != 0.0f) zeros = std::min(zeros, std::countr_zero(std::bit_cast<std::uint32_t>(v)));
  return std::exp2(zeros - 24);
}

/// What the map's numbers have in common, each counted once in so many.
double find_format_step(const raster::ShadowMap& map) {
  std::vector<float> values;
  const std::size_t step = std::max<std::size_t>(1, map.depth.size() / 65536);
  for (std::size_t i = 0; i < map.depth.size(); i += step)
    if (holds_caster(map.view, double{map.depth[i]})) values.push_back(map.depth[i]);
  constexpr std::size_t few = 64;  // numbers tell nothing
  if (values.size() < few) return 0x1p-24;
  for (const double most : {255.0, 65535.0})
    if (are_whole_numbers(values, most)) return 1.0 / most;
  return step_of_bits(values);
}

}  // namespace

std::vector<raytrace::TexelKey> sampled_texels(const LightView& view, int face) {
  constexpr int on_a_side = 192;
  const int step = std::max(1, view.size / on_a_side);
  std::vector<raytrace::TexelKey> keys;
  for (int row = step / 2; row < view.size; row += step)
    for (int column = step / 2; column < view.size; column += step)
      keys.push_back(raytrace::TexelKey::pack(face, column, row));
  return keys;
}

StoredDepths::StoredDepths(const FrameInput& in, const raster::LightRecord& record)
    : in_(in), record_(record), view_(record.map.view), format_step_(find_format_step(record.map)) {}

double StoredDepths::stored(raytrace::TexelKey key) const {
  return record_.map.true_depth()[record_.map.texel_index(key.face(), key.column(), key.row())];
}

double StoredDepths::depth(raytrace::TexelKey key) const {
  return depth_from_stored(view_, key.face(), key.row() + 0.5, stored(key));
}

bool StoredDepths::may_be_empty(raytrace::TexelKey key) const {
  if (!reads_moments(record_)) return is_empty(key);
  return averaged_depths(record_, key).max >= view_.face(key.face()).far_depth;
}

SurfaceOnRay StoredDepths::surface(const Ray& ray, const raytrace::Hit& hit, int face,
                                   const Vec2& place) const {
  const raytrace::SurfacePoint point = in_.tracer.surface_point(ray, hit);
  const Vec3 outward = outward_normal(in_.world, hit.primitive, point.position);
  const bool front = glm::dot(outward, ray.direction) < 0.0;
  const Vec3 normal = glm::dot(point.normal, ray.direction) > 0.0 ? -point.normal : point.normal;
  struct Change {
    double depth = infinity, stored = infinity;  // over a texel
  };
  const auto change = [&](double du, double dv) -> Change {
    const double below = plane_depth(view_, face, place.x - du, place.y - dv, point.position, normal);
    const double above = plane_depth(view_, face, place.x + du, place.y + dv, point.position, normal);
    if (std::isinf(below) || std::isinf(above)) return {};
    return {std::abs(above - below), std::abs(stored_from_depth(view_, face, place.y + dv, above) -
                                              stored_from_depth(view_, face, place.y - dv, below))};
  };
  const Change u = change(0.5, 0.0), v = change(0.0, 0.5);
  return {hit.primitive, glm::dot(ray.at(hit.t) - view_.origin, view_.face(face).forward),
          0.5 * (u.depth + v.depth), std::max(u.stored, v.stored), front};
}

Ray StoredDepths::ray(raytrace::TexelKey key, const Vec2& off) const {
  const Vec2 middle(key.column() + 0.5, key.row() + 0.5);
  if (!reads_paraboloids(record_))
    return caster_ray(in_.world, view_, key.face(), middle.x + off.x, middle.y + off.y);
  const auto& halves = record_.captured->test->paraboloids;
  ParaboloidPlace place = texel_centre(
      halves, paraboloid_place(halves, texel_ray(view_, key.face(), middle.x, middle.y).direction));
  place.u += off.x, place.v += off.y;
  return {view_.origin, paraboloid_direction(halves, place), {0.0, infinity}};
}

std::optional<SurfaceOnRay> StoredDepths::first(raytrace::TexelKey key, const Vec2& off) const {
  const Ray from = ray(key, off);
  const auto hit = in_.tracer.closest_hit(from, raytrace::Sides::casting);
  if (!hit) return std::nullopt;
  return surface(from, *hit, key.face(), Vec2(key.column() + 0.5, key.row() + 0.5) + off);
}

std::vector<SurfaceOnRay> StoredDepths::all(raytrace::TexelKey key, std::size_t most) const {
  std::vector<SurfaceOnRay> out;
  const Vec2 place(key.column() + 0.5, key.row() + 0.5);
  const Ray from = ray(key);
  visit_hits(
      from, [&](const Ray& rest) { return in_.tracer.closest_hit(rest, raytrace::Sides::casting); },
      [&](const raytrace::Hit& hit) {
        out.push_back(surface(from, hit, key.face(), place));
        return out.size() < most;
      });
  return out;
}

bool StoredDepths::is_stored(raytrace::TexelKey key, double depth, double slack) const {
  if (is_empty(key) || std::isinf(depth)) return false;
  if (std::isinf(slack)) return true;
  const LightFace& face = view_.face(key.face());
  const auto number = [&](double d) {
    return stored_from_depth(view_, key.face(), key.row() + 0.5,
                             std::clamp(d, face.near_depth, face.far_depth));
  };
  const auto [low, high] = std::minmax({number(depth - slack), number(depth + slack)});
  const double allowed = steps_allowed * format_step_ + arithmetic;
  double least = stored(key), most = least;
  if (reads_moments(record_)) {
    const Interval own = averaged_depths(record_, key);
    std::tie(least, most) = std::minmax({number(own.min), number(own.max)});
  }
  return most >= low - allowed && least <= high + allowed;
}

bool StoredDepths::holds_within(raytrace::TexelKey key, double reach, int steps, double slope_texels) const {
  for (int j = -steps; j <= steps; ++j)
    for (int i = -steps; i <= steps; ++i) {
      const auto met = first(key, reach / steps * Vec2(i, j));
      // Nothing is stored where nothing lies within the map's depths.
      if (may_be_empty(key) && (!met || met->depth >= view_.face(key.face()).far_depth)) return true;
      if (met && is_stored(key, met->depth, 2.0 * slope_texels * met->across)) return true;
    }
  return false;
}

bool StoredDepths::holds_scene(raytrace::TexelKey key) const {
  const auto centre = first(key);
  if (!is_empty(key) && centre && is_stored(key, centre->depth, 2.0 * scene_reach * centre->across))
    return true;
  return holds_within(key, scene_reach, 1, scene_reach);
}

bool StoredDepths::holds_neighbours(raytrace::TexelKey key) const {
  return holds_within(key, 1.0, 2, 0.25);
}

}  // namespace gnomon::compare
