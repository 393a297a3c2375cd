// The rubrics that come with the program, each with what a class needs to begin.
#pragma once

#include <string>
#include <vector>

#include "scene/expected.h"

namespace gnomon::app::grade {

/// "first-shadow-map", …
std::vector<std::string> kit_names();
bool is_kit(const std::string& name);

/// Writes the kit, all of it or nothing: rubric.json, its scenes, README.md, and student/ with the shader to be filled in.
/// Errors (cannot write): a file of another content is there already.
Expected<void> write_kit(const std::string& name, const std::string& folder);

}  // namespace gnomon::app::grade
