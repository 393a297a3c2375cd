// The rows of the lectures' parts, which functions.cpp puts together. Private to functions.
#pragma once

#include <vector>

#include "studies/functions/functions.h"

namespace gnomon::functions {

/// Rays against spheres, triangles and boxes.
const std::vector<Function>& surface_functions();

}  // namespace gnomon::functions
