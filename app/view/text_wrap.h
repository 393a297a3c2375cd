// Lines of a paragraph. Dear ImGui's own wrapping breaks behind commas and points as well, in the midst of a number.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace gnomon::app {

/// The text with line breaks in place of blanks, so that each line is no wider than `width` by `measure`, which must add
/// up over the parts of a line; a word that is wider has a line of its own. Breaks of the text's own stay.
std::string broken_at_blanks(std::string_view text, double width,
                             const std::function<double(std::string_view)>& measure);

}  // namespace gnomon::app
