// Whole input files, and the paths that they name.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "scene/base/expected.h"
#include "scene/load.h"

namespace gnomon {

/// The bytes of a plain file. Errors are ErrorKind::bad_input.
Expected<std::string> read_file(const std::string& path);

/// Lower case, with the dot: ".gltf"; "" when there is none.
std::string lower_extension(const std::string& path);

/// The path of a file that the scene file in `folder` names; options.files takes it. With
/// options.confine_paths, a path that leaves options.root, or where that is empty the folder (by "..", by
/// being absolute, or through a symbolic link), is an error.
Expected<std::string> resolve_path(const std::string& folder, const std::string& named,
                                   const LoadOptions& options);

/// The folder that a file's own references are relative to.
std::string folder_of(const std::string& path);

/// Text as editors of Windows write it begins with a mark (U+FEFF).
std::string_view without_byte_order_mark(std::string_view text);

/// Line and column, both from 1, of a byte offset; a column is a code point of UTF-8.
struct LineColumn {
  int line = 1, column = 1;
};
LineColumn line_column(std::string_view text, std::size_t offset);

/// A decimal number in text, "+1.5e2"; a tiny one becomes 0. None when it is not one, not finite or too
/// large.
std::optional<double> parse_decimal(std::string_view word);

/// Up to 40 bytes of hostile text as one_line() writes it, for messages.
std::string printable(std::string_view text);
/// Makes up to `longest` bytes of text printable.
std::string printable(std::string_view text, std::size_t longest);

/// The value of a hexadecimal digit, 0 to 15; -1 for what is none.
constexpr int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

}  // namespace gnomon
