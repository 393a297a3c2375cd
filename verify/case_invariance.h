// The cases of case_invariance.cpp and case_stretched.cpp, declared apart from the others.
#pragma once

#include "verify/run.h"

namespace gnomon::verify {

void scale_invariance(Run& run);
void coplanar_lights(Run& run);
void stretched_triangles(Run& run);  // case_stretched.cpp

}  // namespace gnomon::verify
