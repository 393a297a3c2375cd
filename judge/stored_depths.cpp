#include "judge/stored_depths.h"

#include <algorithm>
#include <tuple>

#include "compare/ladder/biased_test.h"

namespace gnomon::judge {
namespace {

constexpr double arithmetic =
    0x1p-22;  ///< of stored numbers: a matrix and a depth between 1/2 and 1, in floats
/// Steps of the format: rounding takes half of one, truncation all of it.
constexpr double steps_allowed = 1.0;
constexpr double scene_reach = 1.0 / 8.0;  ///< texels: a rasterizer's sample places are kept in 1/256 of one

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
    : in_(in), record_(record), view_(record.map.view) {}

double StoredDepths::step(raytrace::TexelKey key, double depth) const {
  const CapturedTest& test = captured_test(record_);
  const LightFace& face = view_.face(key.face());
  const double own = stored_from_depth(view_, key.face(), key.row() + 0.5, depth);
  const StoredFormat& format = in_.facts.format;
  if (test.stores == Stores::depths) return step_near(format, own);
  const double along = test.stores == Stores::distances ? glm::dot(ray(key).direction, face.forward) : 1.0;
  const double number = std::abs(depth / along - test.range.x) / test.unit_world;
  const double next = depth + step_near(format, number) * test.unit_world * along;
  return std::abs(stored_from_depth(view_, key.face(), key.row() + 0.5, next) - own);
}

double StoredDepths::stored(raytrace::TexelKey key) const {
  return record_.map.true_depth()[record_.map.texel_index(key.face(), key.column(), key.row())];
}

double StoredDepths::depth(raytrace::TexelKey key) const {
  return depth_from_stored(view_, key.face(), key.row() + 0.5, stored(key));
}

bool StoredDepths::may_be_empty(raytrace::TexelKey key) const {
  if (!stores_averages()) return is_empty(key);
  return captured_test(record_).averaged_depths(record_, key).max >= view_.face(key.face()).far_depth;
}

bool StoredDepths::stores_averages() const {
  return captured_test(record_).reads() == CapturedTest::Reads::averages;
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
    const double below =
        compare::plane_depth(view_, face, place.x - du, place.y - dv, point.position, normal);
    const double above =
        compare::plane_depth(view_, face, place.x + du, place.y + dv, point.position, normal);
    if (std::isinf(below) || std::isinf(above)) return {};
    return {std::abs(above - below), std::abs(stored_from_depth(view_, face, place.y + dv, above) -
                                              stored_from_depth(view_, face, place.y - dv, below))};
  };
  const Change u = change(0.5, 0.0), v = change(0.0, 0.5);
  return {hit.primitive,
          glm::dot(ray.at(hit.t) - view_.origin, view_.face(face).forward),
          0.5 * (u.depth + v.depth),
          std::max(u.stored, v.stored),
          front,
          -glm::dot(normal, ray.direction)};
}

Ray StoredDepths::ray(raytrace::TexelKey key, const Vec2& off) const {
  if (const auto own = captured_test(record_).stored_ray(view_, key, off)) return *own;
  return compare::caster_ray(in_.world, view_, key.face(), key.column() + 0.5 + off.x,
                             key.row() + 0.5 + off.y);
}

std::optional<SurfaceOnRay> StoredDepths::first(raytrace::TexelKey key, const Vec2& off) const {
  const Ray from = ray(key, off);
  const auto hit = in_.tracer.closest_hit(from, raytrace::Sides::casting);
  if (!hit) return std::nullopt;
  return surface(from, *hit, key.face(), Vec2(key.column() + 0.5, key.row() + 0.5) + off);
}

std::vector<SurfaceOnRay> StoredDepths::all(raytrace::TexelKey key, std::size_t most) const {
  return all(in_.tracer, key, most);
}

std::vector<SurfaceOnRay> StoredDepths::all(const raytrace::Tracer& tracer, raytrace::TexelKey key,
                                            std::size_t most) const {
  std::vector<SurfaceOnRay> out;
  const Vec2 place(key.column() + 0.5, key.row() + 0.5);
  const Ray from = ray(key);
  compare::visit_hits(
      from, [&](const Ray& rest) { return tracer.closest_hit(rest, raytrace::Sides::casting); },
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
  const double allowed =
      steps_allowed * step(key, std::clamp(depth, face.near_depth, face.far_depth)) + arithmetic;
  double least = stored(key), most = least;
  if (stores_averages()) {
    const Interval own = captured_test(record_).averaged_depths(record_, key);
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

}  // namespace gnomon::judge
