// Large arrays that were freed wait here for the next of their size (raytrace/huge_array.h).
#pragma once

namespace gnomon::raytrace {

/// Frees those that wait.
void return_kept_arrays();

}  // namespace gnomon::raytrace
