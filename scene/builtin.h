// The built-in scenes' files, embedded in the program, so that their names work anywhere. The loader reads
// them as it reads any other scene file.
#pragma once

#include <optional>
#include <string_view>

namespace gnomon {

struct BuiltinFile {
  std::string_view name;  ///< the scene's name
  std::string_view text;  ///< the JSON
};

/// nullopt when there is no built-in scene of that name.
std::optional<BuiltinFile> find_builtin_scene(std::string_view name);

}  // namespace gnomon
