#include "scene/base/terminal.h"

#include <unistd.h>

namespace gnomon {

bool is_terminal(int descriptor) {
  return isatty(descriptor) == 1;
}

}  // namespace gnomon
