#include "raster/programs/shader_folder.h"

#include <algorithm>

#include "raster/programs/shader_text.h"

namespace gnomon::raster {
namespace {

std::string without_comments(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t start = std::min({text.find("//"), text.find("/*"), text.size()});
    out += text.substr(0, start);
    text.remove_prefix(start);
    const bool block = text.starts_with("/*");
    const std::size_t end = block ? text.find("*/") : text.find('\n');
    text.remove_prefix(end == text.npos ? text.size() : block ? end + 2 : end);
  }
  return out;
}

/// One that gets its visibility from elsewhere needs neither the map nor the test of depths.
std::vector<std::string> deciding_files(const MapOptions& map, const std::string& technique) {
  std::vector<std::string> files{technique};
  if (map.technique == Technique::hybrid) return files;
  if (map.technique == Technique::izb) {
    files.insert(files.end(), {"izb/triangle.vert", "izb/insert.frag", "izb/block.frag"});
    return files;
  }
  files.insert(files.end(), {"light.glsl", "gap.glsl"});
  if (uses_moments(map.technique)) files.insert(files.end(), {"moments.frag", "blur.frag"});
  return files;
}

}  // namespace

std::optional<CustomShader> custom_shader(const ShaderFolder& folder, const MapOptions& map,
                                          const Light& light) {
  if (folder.replaced().empty()) return std::nullopt;
  const std::string technique = technique_file(map, light);
  CustomShader out;
  if (folder.find("shade.frag") != nullptr) out.files.emplace_back("shade.frag");
  for (const std::string& part : deciding_files(map, technique)) {
    const Expansion expanded = expand_file(part, {}, folder);
    for (const std::string& file : expanded.replaced())
      if (std::find(out.files.begin(), out.files.end(), file) == out.files.end()) out.files.push_back(file);
    if (part != technique) continue;
    const std::string text = without_comments(expanded.text);
    out.reads_bias = text.find("light.bias") != text.npos || text.find(".gap") != text.npos;
  }
  if (out.files.empty()) return std::nullopt;
  return out;
}

}  // namespace gnomon::raster
