// Shadow maps of moments in double precision. A texel holds averages of functions of depth. The receiver's light is made of a
// bound of how much of what was averaged lies before it. The formulas are the papers'; the shaders' twin is shaders/technique.
#pragma once

#include <array>
#include <optional>

#include "raster/frame.h"
#include "raytrace/sheets/sheets.h"

namespace gnomon::compare {

struct BiasedLookup;

/// Returns the most that may lie at or beyond x of numbers with this mean and this mean square (Donnelly and Lauritzen 2006,
/// equation 5). Their variance counts as `least_variance` at least, and as four roundings of floats.
double chebyshev(double mean, double square, double x, double least_variance = 0.0);

/// Returns the least that lies before x of numbers whose first four powers have these means. The three points of support are
/// solved for directly (Peters and Klein 2015, section 3.2), the weights by Cramer's rule. Not a number where all are one number.
double least_share_before(const std::array<double, 4>& means, double x);

/// Returns the light in [0, 1] that the technique makes of a texel's averages for a receiver at x, stored numbers.
double light_of_moments(const raster::CapturedMoments& moments, const std::array<double, 4>& averages,
                        double x);

/// Returns the mean of x that a texel's averages tell.
double mean_of_moments(const raster::CapturedMoments& moments, const std::array<double, 4>& averages);

/// Whether another renderer drew the record's picture from moments.
inline bool reads_moments(const raster::LightRecord& record) {
  return record.captured && record.captured->test &&
         record.captured->test->read == raster::CapturedTest::Read::moments;
}

/// Returns the averages read between the four texels around a place.
std::array<double, 4> moments_between(const raster::LightRecord& record, const TexelCoordinate& at);

/// Returns the depth along forward up to which receivers have half of the light at least, of moments read between the four
/// texels around the lookup; none where all have it.
std::optional<double> caster_of_moments(const raster::LightRecord& record, const BiasedLookup& lookup);

/// Returns the depths along forward that a texel's own may be, as far as its averages tell.
Interval averaged_depths(const raster::LightRecord& record, raytrace::TexelKey key);

}  // namespace gnomon::compare
