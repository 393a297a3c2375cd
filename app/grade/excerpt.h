// The lines of a shader that an error is about.
#pragma once

#include <string>

namespace gnomon::app::grade {

/// For "DIR/technique/hard.glsl:3: …" the lines around the third, numbered, that one marked with ">"; empty where the
/// text names no line of a file in `folder`.
std::string excerpt_at(const std::string& error, const std::string& folder);

}  // namespace gnomon::app::grade
