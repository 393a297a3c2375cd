// The names of GLSL 4.50 that no macro may take: keywords and types (3.6), built-in functions (8).
#pragma once

#include <string_view>

namespace gnomon::grade {

/// Whether it is a keyword, a type or a built-in function, or begins with "gl_" or holds "__", which are GLSL's, too.
bool is_glsl_name(std::string_view name);

}  // namespace gnomon::grade
