#include "compare/ladder/paraboloids.h"

#include <algorithm>
#include <cmath>

#include "compare/ladder/biased_test.h"

namespace gnomon::compare {
namespace {

using raster::CapturedParaboloid;
using Halves = std::vector<CapturedParaboloid>;

ParaboloidPlace place_of(const raster::LightRecord& record, const BiasedLookup& lookup) {
  return paraboloid_place(record.captured->test->paraboloids,
                          glm::normalize(lookup.position - record.map.view.origin));
}

}  // namespace

ParaboloidPlace paraboloid_place(const Halves& halves, const Vec3& direction) {
  const std::size_t which = (halves[0].half_from_world * direction).z >= 0.0 ? 0 : 1;
  const CapturedParaboloid& half = halves[which];
  const Vec3 d = half.half_from_world * direction;
  return {which, 0.5 * (d.x / (1.0 + d.z) + 1.0) * half.width, 0.5 * (d.y / (1.0 + d.z) + 1.0) * half.height};
}

ParaboloidPlace texel_centre(const Halves& halves, ParaboloidPlace place) {
  const CapturedParaboloid& half = halves[place.half];
  place.u = std::clamp(std::floor(place.u), 0.0, half.width - 1.0) + 0.5;
  place.v = std::clamp(std::floor(place.v), 0.0, half.height - 1.0) + 0.5;
  return place;
}

Vec3 paraboloid_direction(const Halves& halves, const ParaboloidPlace& place) {
  const CapturedParaboloid& half = halves[place.half];
  const double x = 2.0 * place.u / half.width - 1.0, y = 2.0 * place.v / half.height - 1.0;
  // d.z = (1 - r^2) / (1 + r^2), and d.xy = (1 + d.z) (x, y).
  const double square = x * x + y * y, more = 2.0 / (1.0 + square);
  return glm::transpose(half.half_from_world) * Vec3(more * x, more * y, more - 1.0);
}

std::optional<double> paraboloid_distance(const Halves& halves, const ParaboloidPlace& place) {
  const CapturedParaboloid& half = halves[place.half];
  const ParaboloidPlace at = texel_centre(halves, place);
  const auto index =
      static_cast<std::size_t>(at.v) * static_cast<std::size_t>(half.width) + static_cast<std::size_t>(at.u);
  const double distance = half.distances[index];
  return distance > 0.0 ? std::optional(distance) : std::nullopt;
}

double depth_of_distance(const raster::LightRecord& record, const BiasedLookup& lookup, double distance) {
  const LightView& view = record.map.view;
  const int face = lookup.key.face();
  const Ray ray = texel_ray(view, face, lookup.key.column() + 0.5, lookup.key.row() + 0.5);
  return distance * glm::dot(ray.direction, view.face(face).forward);
}

std::optional<double> caster_of_paraboloids(const raster::LightRecord& record, const BiasedLookup& lookup) {
  const auto distance = paraboloid_distance(record.captured->test->paraboloids, place_of(record, lookup));
  if (!distance) return std::nullopt;
  return depth_of_distance(record, lookup, *distance);
}

std::vector<std::optional<double>> casters_around(const raster::LightRecord& record,
                                                  const BiasedLookup& lookup, double reach) {
  const Halves& halves = record.captured->test->paraboloids;
  const ParaboloidPlace middle = place_of(record, lookup);
  std::vector<std::optional<double>> out;
  for (double v = std::floor(middle.v - reach); v <= middle.v + reach; v += 1.0)
    for (double u = std::floor(middle.u - reach); u <= middle.u + reach; u += 1.0) {
      const auto distance = paraboloid_distance(halves, {middle.half, u, v});
      out.push_back(distance ? std::optional(depth_of_distance(record, lookup, *distance)) : std::nullopt);
    }
  return out;
}

}  // namespace gnomon::compare
