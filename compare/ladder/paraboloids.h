// Dual paraboloid maps of another renderer: which texel a place looks up, and what is stored there.
#pragma once

#include <optional>
#include <vector>

#include "raster/frame.h"

namespace gnomon::compare {

struct BiasedLookup;

/// A place on one of the halves, texels from its lowest x and y.
struct ParaboloidPlace {
  std::size_t half = 0;
  double u = 0.0, v = 0.0;
};

/// Whether another renderer drew the record's picture from paraboloids.
inline bool reads_paraboloids(const raster::LightRecord& record) {
  return record.captured && record.captured->test &&
         record.captured->test->read == raster::CapturedTest::Read::paraboloids;
}

/// Returns where a direction from the light is looked up: in the first half, unless it points away from that one's axis.
ParaboloidPlace paraboloid_place(const std::vector<raster::CapturedParaboloid>& halves,
                                 const Vec3& direction);
/// Returns the middle of the place's texel, or of its half's nearest one.
ParaboloidPlace texel_centre(const std::vector<raster::CapturedParaboloid>& halves, ParaboloidPlace place);
/// Returns the unit direction of a place, which lies on its half's disc or beside it.
Vec3 paraboloid_direction(const std::vector<raster::CapturedParaboloid>& halves,
                          const ParaboloidPlace& place);
/// Returns the distance from the light, world units, in the texel of a place or the half's nearest one; none where nothing is
/// stored.
std::optional<double> paraboloid_distance(const std::vector<raster::CapturedParaboloid>& halves,
                                          const ParaboloidPlace& place);

/// Returns a distance from the light as a depth along forward on the ray through the middle of the texel that is looked up.
double depth_of_distance(const raster::LightRecord& record, const BiasedLookup& lookup, double distance);
/// Returns the depth along forward that is stored in the paraboloid's texel of the lookup, if a caster is.
std::optional<double> caster_of_paraboloids(const raster::LightRecord& record, const BiasedLookup& lookup);
/// Returns the same of all texels of that half within `reach` texels along both axes.
std::vector<std::optional<double>> casters_around(const raster::LightRecord& record,
                                                  const BiasedLookup& lookup, double reach);

}  // namespace gnomon::compare
