// Words as a POSIX shell would need them typed.
#pragma once

#include <string>
#include <string_view>

namespace gnomon::app {

/// The word itself where it is plain, else in single quotes.
std::string shell_quoted(std::string_view word);

}  // namespace gnomon::app
