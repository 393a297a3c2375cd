// GLSL of the scene's implicit functions, generated from the same expressions that the ray tracer evaluates:
// each with bounds and slope along a ray (shaders/bounds.glsl), and with its gradient. Private to raster.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scene/world.h"

namespace gnomon::raster {

/// The distinct functions of a world's implicit surfaces, and which one each shape has.
struct FunctionTable {
  std::vector<const Expression*> functions;
  std::vector<std::uint32_t> of_shape;  ///< index in functions, 0 for other shapes
};
FunctionTable function_table(const World& world);

/// What is asked of a function: `Slope function_slope(uint, Slope, Slope, Slope)` (shaders/bounds.glsl),
/// `vec4 function_gradient(uint, vec4, vec4, vec4)`, or that in double precision, `dvec4
/// function_gradient64(uint, dvec4, dvec4, dvec4)` (shaders/izb/functions.glsl).
enum class FunctionForm : std::uint8_t { slope, gradient, gradient64 };

/// The forms asked for, on one line, for the functions from `first` on, `count` of them.
std::string functions_glsl(const FunctionTable& table, std::size_t first, std::size_t count,
                           std::span<const FunctionForm> forms);

}  // namespace gnomon::raster
