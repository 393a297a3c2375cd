#include "raster/programs/shader_folder.h"

#include <fmt/core.h>

#include <array>
#include <string_view>
#include <vector>

#include "raster/passes/technique_pass.h"
#include "raster/programs/shader_text.h"
#include "raster/technique_traits.h"
#include "scene/light.h"

namespace gnomon::raster {
namespace {

/// Files that stages begin with: those of all techniques, and of the passes that one of them adds.
std::vector<std::string_view> first_files(Technique technique) {
  std::vector<std::string_view> files = {
      "triangle.vert",     "triangle.frag",   "impostor.vert", "impostor_camera.frag",
      "impostor_map.frag", "fullscreen.vert", "shade.frag"};
  const auto stages = traits_of(technique).drawing->stages;
  files.insert(files.end(), stages.begin(), stages.end());
  return files;
}

/// Without a size and with one.
std::array<Light, 2> two_lights() {
  std::array<Light, 2> lights;
  lights[0].type = lights[1].type = LightType::point;
  lights[1].extent = SphereLight{1.0};
  return lights;
}

}  // namespace

std::set<std::string> technique_files(Technique technique) {
  std::set<std::string> files;
  MapOptions map;
  map.technique = technique;
  for (const FilterKernelTraits& kernel : all_filter_kernel_traits())
    for (const double blend : {0.0, 0.5})
      for (const Light& light : two_lights()) {
        map.filter.kernel = kernel.kernel;
        map.cascades.blend = blend;
        files.insert(technique_file(map, light));
      }
  return files;
}

std::set<std::string> files_read_by(Technique technique) {
  std::set<std::string> files;
  for (const std::string& name : technique_files(technique)) {
    // "technique/hard.glsl" is included as technique/$TECHNIQUE.glsl.
    const std::size_t begin = name.find('/') + 1, end = name.rfind('.');
    const std::string define = fmt::format("TECHNIQUE {}", name.substr(begin, end - begin));
    const std::string_view defines[] = {define};
    for (const std::string_view first : first_files(technique))
      for (const Expansion::File& file : expand_file(first, defines, {}).files) files.insert(file.name);
  }
  return files;
}

}  // namespace gnomon::raster
