#include "grade/grade.h"

#include <embedded/grade_kits.h>
#include <fmt/core.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "raster/programs/shader_folder.h"
#include "scene/files/path_status.h"
#include "scene/files/read_file.h"
#include "scene/files/staged_folder.h"
#include "scene/files/write_file.h"

namespace gnomon::grade {

namespace {

constexpr std::string_view root = "kits/";

/// "kits/first-shadow-map/technique/hard.glsl" is student/technique/hard.glsl of a kit.
std::string place_in_kit(std::string_view name) {
  return (name.ends_with(".glsl") ? "student/" : "") + std::string(name);
}

using KitFiles = std::vector<std::pair<std::string, std::string_view>>;  // places and bytes

/// The functions that the kit's rubric names, as the program has them to be filled in.
KitFiles functions_begun(const KitFiles& kit) {
  KitFiles files;
  for (const raster::ShaderFile& shader : raster::own_shaders())
    for (const auto& [place, bytes] : kit)
      if (place == "rubric.json" && shader.name.starts_with("function/") &&
          bytes.find(fmt::format("\"{}\"", shader.name)) != std::string_view::npos)
        files.emplace_back(fmt::format("student/{}", shader.name), shader.text);
  return files;
}

/// What is there may be somebody's work.
Expected<void> check_nothing_differs(const std::string& path, std::string_view bytes) {
  const auto there = is_there(path, ErrorKind::cannot_write);
  if (!there) return fail(there.error());
  if (!*there) return {};
  if (const auto text = read_file(path); text && *text == bytes) return {};
  return fail(Error{ErrorKind::cannot_write,
                    "is there already and differs from the kit's; move it away first", path});
}

}  // namespace

std::vector<std::string> kit_names() {
  std::vector<std::string> names;
  for (const embedded::Entry& entry : embedded::grade_kits_entries()) {
    const std::string_view rest = entry.name.substr(root.size());
    const std::string name(rest.substr(0, rest.find('/')));
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

bool is_kit(const std::string& name) {
  const std::vector<std::string> names = kit_names();
  return std::find(names.begin(), names.end(), name) != names.end();
}

Expected<void> write_kit(const std::string& name, const std::string& folder) {
  const std::string prefix = std::string(root) + name + "/";
  KitFiles files;
  for (const embedded::Entry& entry : embedded::grade_kits_entries()) {
    if (!entry.name.starts_with(prefix)) continue;
    files.emplace_back(place_in_kit(entry.name.substr(prefix.size())), entry.bytes);
    if (auto safe = check_nothing_differs(folder + "/" + files.back().first, entry.bytes); !safe) return safe;
  }
  for (const auto& [place, bytes] : functions_begun(files)) {
    const std::string path = fmt::format("{}/{}", folder, place);
    if (auto safe = check_nothing_differs(path, bytes); !safe) return safe;
    files.emplace_back(place, bytes);
  }
  auto staged = StagedFolder::open(folder);
  if (!staged) return fail(staged.error());
  for (const auto& [place, bytes] : files) {
    const std::string path = staged->path() + "/" + place;
    if (const auto made = make_folder_for(path); !made) return made;
    if (const auto written = write_file(path, bytes); !written) return written;
  }
  if (const auto sealed = staged->seal({}); !sealed) return sealed;
  return staged->publish("README.md");
}

}  // namespace gnomon::grade
