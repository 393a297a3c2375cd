// The whole benchmark is a program of its own, for it holds Embree, which the user's own program never does.
#pragma once

#include <string>

#include "app/invocation.h"

namespace gnomon::app {

struct WholeBench {
  int runs = 0;  ///< 0: as it likes
  std::string json;
  std::string size;  ///< WxH
};

/// Becomes gnomon_bench, found beside this program or in the build's tests. Returns only to say why not.
Expected<ExitCode> run_whole_bench(const WholeBench& bench);

}  // namespace gnomon::app
