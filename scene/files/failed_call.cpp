#include "scene/files/failed_call.h"

#include <fmt/core.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace gnomon {

tl::unexpected<Error> failed_call(ErrorKind kind, std::string file, std::string_view step, int error_number) {
  const bool resource = error_number == EMFILE || error_number == ENFILE || error_number == ENOMEM;
  return fail(Error{resource ? ErrorKind::graphics : kind,
                    fmt::format("{}: {}", step, std::strerror(error_number)), std::move(file)});
}

}  // namespace gnomon
