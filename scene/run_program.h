// Other programs that this one starts and waits for.
#pragma once

#include <string>
#include <vector>

#include "scene/expected.h"

namespace gnomon {

/// Runs a program of the PATH with these words, of which the first is its name, and waits for its end. Its stdout goes where
/// messages go, because this program's is for data, and signals reach it though this program's threads block some.
/// Returns its exit code, or 128 and the signal that ended it. ErrorKind::graphics: it cannot be started.
Expected<int> run_program(std::vector<std::string> words);

}  // namespace gnomon
