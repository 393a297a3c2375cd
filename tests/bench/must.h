// For benchmarks, which have nobody to hand an error to.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <type_traits>

#include "scene/base/expected.h"

namespace gnomon::bench {

/// The value, or the error as the program's last word.
template <class T>
T must(Expected<T> value) {
  if (!value) {
    fmt::print(stderr, "{}\n", value.error().message());
    std::exit(1);
  }
  if constexpr (!std::is_void_v<T>) return std::move(*value);
}

}  // namespace gnomon::bench
