#include <fmt/core.h>

#include "scene/base/expected.h"

namespace gnomon {

std::string Error::message() const {
  std::string out;
  if (!file.empty()) {
    out += file;
    if (line > 0) out += fmt::format(":{}", line);
    if (line > 0 && column > 0) out += fmt::format(":{}", column);
    out += ": ";
  }
  if (!field.empty()) out += field + ": ";
  return one_line(out + reason);
}

}  // namespace gnomon
