// Names come from files and may hold anything; what a message says of them stays one line of plain text.
#pragma once

#include <string>
#include <string_view>

namespace gnomon {

/// The text with every control character (of ASCII and of Unicode, line breaks too) and every byte that is
/// not UTF-8 written as an escape: \n, \t, \r or \x1b.
std::string one_line(std::string_view text);

}  // namespace gnomon
