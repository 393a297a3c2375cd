// The state that a lab begins with, from its options.
#pragma once

#include "lab/lab_options.h"
#include "lab/view/state/state.h"

namespace gnomon::lab {

/// `given`: of the scene as it was loaded. Error (usage): no such light, a pose that nothing can be seen with.
Expected<ViewState> first_state(const LabOptions& options, GivenScene given);

}  // namespace gnomon::lab
