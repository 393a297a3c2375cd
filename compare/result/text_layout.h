// Plain-text layout for terminals: widths count code points, not bytes.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace gnomon::compare {

/// Code points of UTF-8 text (continuation bytes do not count).
std::size_t text_width(std::string_view text);
/// Lines of at most `width` code points, broken at spaces that do not follow a digit ("95 ms" stays
/// together); a longer word is cut.
std::vector<std::string> wrapped(std::string_view text, std::size_t width);
/// Filled with spaces to `width` on the right side.
std::string right_padded(std::string_view text, std::size_t width);
/// With a space between those that are not empty.
std::string joined_sentences(std::initializer_list<std::string_view> sentences);
/// A name of a result file as people read it: "receiver_motion" -> "receiver motion".
std::string spoken(std::string_view name);

// Fields of comma-separated values (RFC 4180).

/// One line, in which control characters are escaped (scene/base/expected.h); in quotes where it holds a comma or a quote.
std::string csv_field(const std::string& text);
/// A name from a file as text of a field. Spreadsheets take a cell that begins with = + - @ or a tab for a
/// formula. Such a name gets an apostrophe in front (OWASP, "CSV Injection"), unless it is a number or a list
/// of them.
std::string csv_name(const std::string& name);

}  // namespace gnomon::compare
