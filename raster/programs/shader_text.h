// The text of a shader stage, put together from the files of shaders/ (or of a folder that replaces some):
// #include lines resolved, each file once; $NAME in a file's name stands for the value of that define.
// Private to raster.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "raster/programs/shader_folder.h"

namespace gnomon::raster {

/// The compiler counts the lines of file k from lines_per_file * k: GLSL's own numbers of sources are lost in
/// some of Mesa's messages.
inline constexpr std::size_t lines_per_file = 100000;

/// A stage's text, and the files that it was put together from.
struct Expansion {
  struct File {
    std::string name;
    bool replaced = false;  ///< from the shader folder
  };
  std::string text;
  std::vector<File> files;
  Expected<void> complete{};  ///< the first include of a file that is not there

  bool holds(std::string_view name) const;
  std::vector<std::string> replaced() const;
};

Expansion expand_file(std::string_view file, std::span<const std::string_view> defines,
                      const ShaderFolder& folder);
/// A source that is not a file of shaders/, under the name `name`.
Expansion expand_source(std::string_view source, std::string name, const ShaderFolder& folder);

}  // namespace gnomon::raster
