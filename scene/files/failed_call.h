// How a failed call of the system is told.
#pragma once

#include <string>
#include <string_view>

#include "scene/expected.h"

namespace gnomon {

/// "FILE: STEP: what errno (`error_number`) means", of that kind; or of ErrorKind::graphics, which is for resources, too, where
/// descriptors or memory are what is missing.
tl::unexpected<Error> failed_call(ErrorKind kind, std::string file, std::string_view step, int error_number);

}  // namespace gnomon
