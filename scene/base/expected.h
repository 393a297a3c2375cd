// Expected failure is a value. An Error is one line for a person and an exit code for a program.
#pragma once

#include <span>
#include <string>
#include <string_view>
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

// Names come from files and may hold anything; what is said of them stays plain text that is shown as it is written.

/// The text with every control character (of ASCII and of Unicode, line breaks too) and every byte that is
/// not UTF-8 written as an escape: \n, \t, \r or \x1b. So are, as \u202e, the characters that change the order in
/// which a line is shown.
std::string one_line(std::string_view text);

/// Escapes text that has lines: their ends, tabs and the sequences of the program's `own` stay. What is no ASCII becomes
/// \u009b, so that JSON text stays the same document.
std::string plain_lines(std::string_view text, std::span<const std::string_view> own = {});

/// JSON text whose strings show, as \u202e, the characters that change the order in which a line is shown and the control
/// characters of Unicode; all else stays.
std::string visible_order(std::string_view json);

}  // namespace gnomon
