// The rows of the lectures' parts, which functions.cpp puts together. Private to functions.
#pragma once

#include <vector>

#include "studies/functions/functions.h"

namespace gnomon::functions {

/// The ray through a pixel.
const std::vector<Function>& eye_functions();
/// Rays against spheres, planes, triangles and boxes.
const std::vector<Function>& surface_functions();
/// Reflection, refraction, Fresnel.
const std::vector<Function>& light_functions();

}  // namespace gnomon::functions
