// Fields of comma-separated values (RFC 4180).
#pragma once

#include <string>

namespace gnomon::compare {

/// One line, in which control characters are escaped (scene/base/expected.h); in quotes where it holds a comma or a quote.
std::string csv_field(const std::string& text);
/// A name from a file as text of a field. Spreadsheets take a cell that begins with = + - @ or a tab for a
/// formula: such a name gets an apostrophe in front (OWASP, "CSV Injection"), unless it is a number or a list
/// of them.
std::string csv_name(const std::string& name);

}  // namespace gnomon::compare
