#include "grade/grade.h"

#include <embedded/grade_kits.h>
#include <fmt/core.h>

#include <algorithm>
#include <array>
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

/// A command of the kit's, "gnomon shaders --call bvh_walk --shader-dir student", as it is typed where `called` leads to the program.
std::string command_as_typed(std::string_view command, const std::string& folder, const std::string& called) {
  constexpr std::array<std::string_view, 3> files{"student", "rubric.json", "stage.json"};
  std::string typed;
  bool is_first = true;
  for (std::size_t at = 0; at < command.size();) {
    const std::size_t end = std::min(command.find(' ', at), command.size());
    const std::string_view word = command.substr(at, end - at);
    if (word == "#") return typed + std::string(command.substr(at));
    const bool is_file = std::find(files.begin(), files.end(), word) != files.end();
    typed += is_first ? called : is_file ? fmt::format("{}/{}", folder, word) : std::string(word);
    if (end < command.size()) typed += ' ';
    is_first = false;
    at = end + 1;
  }
  return typed;
}

/// The README with every command as it is typed: those that begin a line, and those in backquotes.
std::string readme_as_typed(std::string_view readme, const std::string& folder, const std::string& called) {
  constexpr std::string_view program = "gnomon ";
  std::string text;
  for (std::size_t at = 0; at < readme.size();) {
    const bool begins = at == 0 || readme[at - 1] == '\n' || readme[at - 1] == '`';
    if (!begins || !readme.substr(at).starts_with(program)) {
      text += readme[at++];
      continue;
    }
    const std::size_t end = std::min(readme.find_first_of("\n`", at), readme.size());
    text += command_as_typed(readme.substr(at, end - at), folder, called);
    at = end;
  }
  const std::size_t title = text.find('\n');
  return text.insert(title + 1,
                     fmt::format("\nThe commands are for the folder in which `{}` is typed.\n", called));
}

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

Expected<void> write_kit(const std::string& name, const std::string& folder, const std::string& called) {
  std::string readme;
  const std::string prefix = std::string(root) + name + "/";
  KitFiles files;
  for (const embedded::Entry& entry : embedded::grade_kits_entries()) {
    if (!entry.name.starts_with(prefix)) continue;
    files.emplace_back(place_in_kit(entry.name.substr(prefix.size())), entry.bytes);
    if (files.back().first == "README.md" && called.find('/') != std::string::npos) {
      readme = readme_as_typed(entry.bytes, folder, called);
      files.back().second = readme;
    }
    if (auto safe = check_nothing_differs(folder + "/" + files.back().first, files.back().second); !safe)
      return safe;
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
