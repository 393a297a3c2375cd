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

}  // namespace gnomon::compare
