// The rows of the lectures' parts, which functions.cpp puts together. Private to functions.
#pragma once

#include <vector>

#include "functions/functions.h"

namespace gnomon::functions {

/// The ray through a pixel.
const std::vector<Function>& eye_functions();
/// Rays against spheres, planes, triangles and boxes.
const std::vector<Function>& surface_functions();
/// Reflection, refraction, Fresnel, the ray to a light.
const std::vector<Function>& light_functions();
Function grid_step_function();
Function bvh_walk_function();
Function bvh_split_function();

/// The least t at which the ray of ten numbers meets the sphere, or the ray of twelve is in the box; -1 where it does neither.
Right sphere_right(Numbers numbers);
Right box_right(Numbers numbers);

}  // namespace gnomon::functions
