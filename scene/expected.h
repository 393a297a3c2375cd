// Expected failure is a value. An Error is one line for a person and an exit code for a program.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace gnomon {

/// The values are the process's exit codes.
enum class ErrorKind : int { usage = 2, bad_input = 3, cannot_write = 4, graphics = 5, internal = 6 };

/// `file:line:column: field: reason`; parts that are empty or zero are left out.
struct Error {
  ErrorKind kind = ErrorKind::internal;
  std::string reason;  ///< plain words, with "(got X, allowed Y)" where that helps
  std::string file{};
  int line = 0;         ///< from 1; 0 where the format has no lines
  int column = 0;       ///< from 1
  std::string field{};  ///< the path inside the file, for example "materials[2].ior"

  std::string message() const;
};

template <class T>
using Expected = tl::expected<T, Error>;

inline tl::unexpected<Error> fail(Error error) {
  return tl::unexpected<Error>(std::move(error));
}
inline tl::unexpected<Error> fail(ErrorKind kind, std::string reason) {
  return tl::unexpected<Error>(Error{kind, std::move(reason)});
}

}  // namespace gnomon
