// Names come from files and may hold anything; what is said of them stays plain text that is shown as it is written.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace gnomon {

/// The text with every control character (of ASCII and of Unicode, line breaks too) and every byte that is
/// not UTF-8 written as an escape: \n, \t, \r or \x1b. So are, as \u202e, the characters that change the order in
/// which a line is shown.
std::string one_line(std::string_view text);

/// The same of text that has lines: their ends, tabs and the sequences of the program's `own` stay. What is no ASCII becomes
/// \u009b, so that JSON text stays the same document.
std::string plain_lines(std::string_view text, std::span<const std::string_view> own = {});

/// JSON text whose strings show, as \u202e, the characters that change the order in which a line is shown and the control
/// characters of Unicode; all else stays.
std::string visible_order(std::string_view json);

}  // namespace gnomon
