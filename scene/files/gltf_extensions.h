// Extensions of glTF: which are read, and which a file may insist on all the same.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace gnomon {

const std::vector<std::string_view>& supported_extensions();
bool is_supported_extension(const std::string& name);

/// It changes looks alone, or nothing that is seen: a file that insists on it is shown without, and that is
/// said.
bool is_spared_extension(const std::string& name);

}  // namespace gnomon
