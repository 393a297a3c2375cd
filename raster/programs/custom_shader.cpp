#include "raster/programs/shader_folder.h"

#include <algorithm>

#include "raster/passes/technique_pass.h"
#include "raster/programs/shader_text.h"
#include "raster/technique_traits.h"

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

std::vector<std::string> deciding_files(const MapOptions& map, const std::string& technique) {
  const TechniqueDrawing& drawing = *traits_of(map.technique).drawing;
  std::vector<std::string> files{technique};
  if (drawing.reads_gap) files.insert(files.end(), {"light.glsl", "gap.glsl"});
  if (drawing.stages_decide) files.insert(files.end(), drawing.stages.begin(), drawing.stages.end());
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
