// Texture statements of MTL files, with their options written out as tinyobjloader reads them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace gnomon {

/// The same library with every option of map_Kd and map_d that has no effect here left out (it is noted), and with
/// three numbers after -s and -o, of which the format lets the last two be missing. Names of files may hold blanks.
std::string plain_mtl(std::string_view text, std::vector<std::string>& notes);

}  // namespace gnomon
