// What a shader says once its own macros are put in: what is hidden behind a name is compared with what is written out.
#pragma once

#include <string>

namespace gnomon::grade {

/// The text without comments and preprocessor lines, with the macros that it defines in their places, one in another up to eight times.
/// Which branch of an #if holds is not asked. A text that would grow beyond a megabyte stays as it is.
std::string with_macros_put_in(const std::string& text);

}  // namespace gnomon::grade
