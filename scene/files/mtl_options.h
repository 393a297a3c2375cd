// Statements of MTL files whose options tinyobjloader does not read as the format means them, written out for it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/expected.h"

namespace gnomon {

/// The statement that stands for "Tr 1" in what plain_mtl() returns: tinyobjloader does not know it, and tells it apart.
inline constexpr std::string_view full_transparency = "gnomon_full_transparency";

/// The same library with every option of map_Kd and map_d that has no effect here left out (it is noted), and with
/// three numbers after -s and -o, of which the format lets the last two be missing, as it does after Kd and the like: one
/// is a grey. Names of files may hold blanks; names of materials have none at their ends. `d -halo 0.5` (the more
/// transparent, the more squarely it is seen) is `d 0.5`, which is noted. Error: a number that is none.
Expected<std::string> plain_mtl(std::string_view text, const std::string& file,
                                std::vector<std::string>& notes);

}  // namespace gnomon
