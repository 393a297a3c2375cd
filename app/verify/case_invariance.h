// The cases of case_invariance.cpp, declared apart from the others.
#pragma once

#include "app/verify/run.h"

namespace gnomon::verify {

void scale_invariance(Run& run);
void coplanar_lights(Run& run);

}  // namespace gnomon::verify
