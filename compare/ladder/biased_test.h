// The hard shadow test in double precision, with the technique's bias: rung V5 (raster::MapTest). The GLSL twin is
// shaders/gap.glsl; a test holds the two together. Gaps are world units along the receiver's own light ray.
#pragma once

#include <optional>

#include "raster/frame.h"
#include "raster/map_test.h"
#include "raytrace/sheets/sheets.h"
#include "raytrace/tracer.h"

namespace gnomon::compare {

/// Least constant bias that leaves no acne on a plane: h_u |dz/du| + h_v |dz/dv| with h half a texel,
/// measured along the light ray (docs/design.md, section 3). `normal` faces the light; infinity when the plane is
/// edge-on over the texel.
double texel_depth_slope(const LightView& view, const TexelCoordinate& at, const Vec3& position,
                         const Vec3& normal);

/// Where the light ray through (u, v) meets the plane through `position`, as depth along forward; +infinity
/// where it does not meet it from the front.
double plane_depth(const LightView& view, int face, double u, double v, const Vec3& position,
                   const Vec3& normal);

using BiasedLookup = raster::MapLookup;

/// Returns how the record's map is tested: as another renderer does it, or as the rasterizer's own hard test.
const raster::MapTest& test_of(const raster::LightRecord& record);

/// None where the lookup is outside the map.
std::optional<BiasedLookup> biased_lookup(const raster::LightRecord& record, const raster::Bias& bias,
                                          const Vec3& to_light, const raytrace::SurfacePoint& receiver,
                                          std::size_t pixel);
/// A distance from the light as a depth along forward on the ray through a texel's centre.
double depth_of_distance(const LightView& view, raytrace::TexelKey key, double distance);
/// The depth along forward that is stored in a texel, if a caster is.
std::optional<double> stored_caster(const raster::LightRecord& record, raytrace::TexelKey key);
/// The depth along forward that the test compares with (raster::MapTest::caster).
std::optional<double> compared_caster(const raster::LightRecord& record, const BiasedLookup& lookup);
/// The stored depth before the casters' own bias.
std::optional<double> unbiased_caster(const raster::LightRecord& record, raytrace::TexelKey key);
/// By how much the casters' own bias moved what a texel stores, depth along forward; 0 where either map stores nothing.
double caster_offset(const raster::LightRecord& record, raytrace::TexelKey key);
/// Whether the casters' own bias moved what a texel holds to the far plane, where its number is that of nothing drawn.
bool is_moved_out(const raster::LightRecord& record, raytrace::TexelKey key);
/// The gap to a caster at a depth along forward on the light ray through the looked-up texel's centre.
double gap_before(const raster::LightRecord& record, const raster::Bias& bias, const Vec3& normal,
                  const BiasedLookup& lookup, double caster_depth);

/// The gap of rung V5 less slope and plane terms: the receiver is shadowed iff it exceeds the constant bias.
/// -infinity where the lookup is outside the map or nothing is stored.
double biased_gap(const raster::LightRecord& record, const raster::Bias& bias, const Vec3& to_light,
                  const raytrace::SurfacePoint& receiver, std::size_t pixel);

}  // namespace gnomon::compare
