// Settings beside the one compared that are drawn, so that nothing is advised whose figure is not of its own drawing. Where
// gaps tell what another bias leaves, nothing is drawn for it.
#pragma once

#include <functional>

#include "compare/advice/rule.h"
#include "compare/comparison.h"
#include "compare/measure/plan.h"

namespace gnomon::compare {

inline constexpr std::size_t most_tried = 2;  ///< drawings of one comparison

/// Draws the comparison's picture, untimed, with other options of the map.
using Redraw = std::function<Expected<raster::RasterFrame>(const raster::MapOptions&)>;

/// Looks at the light that is off most, and fills Comparison::tried by what it lacks. That may be a larger or a smaller
/// map, the technique's own settings, a bias whose figure no gaps tell, a parameter of moments, or a soft technique. At
/// most `most_tried` settings are drawn; where one cannot be, no further one is. Needs the images of a picture in one piece:
/// in bands nothing is tried.
/// `plan`: with its topology.
void try_settings(Comparison& comparison, const Plan& plan, const Redraw& redraw);

/// Tells whether a light's shadow edges are as fine as the picture's pixels. Three things must hold:
/// - The edges are off by less than half a pixel in the root mean square.
/// - There is less than half a pixel of error along each pixel of true edge. Features that the map lacks are part of it.
/// - There is less than half a percent of error in the mean.
/// How much ground lies around the shadows does not count in the first two.
bool has_fine_edges(const LightFigures& light);

/// Returns the tried setting of that kind that leaves least of a light by the comparison's measure, if it is to be advised
/// (rule.h). A map of another size has to leave a fifth less, for twice the side takes four times the texels.
enum class TriedKind : std::uint8_t { larger_map, smaller_map, other };
const TriedSetting* best_tried(const Comparison& comparison, const LightComparison& light, TriedKind kind);
/// Returns what a tried setting leaves of a light.
const LightFigures& left_of(const TriedSetting& tried, const LightComparison& light);

}  // namespace gnomon::compare
