#include "app/grade/kits.h"

#include <embedded/grade_kits.h>

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "app/output_path.h"
#include "scene/files/read_file.h"
#include "scene/files/write_file.h"

namespace gnomon::app::grade {

namespace {

constexpr std::string_view root = "grade/kits/";

/// "grade/kits/first-shadow-map/technique/hard.glsl" is student/technique/hard.glsl of a kit.
std::string place_in_kit(std::string_view name) {
  return (name.ends_with(".glsl") ? "student/" : "") + std::string(name);
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
  for (const bool writes : {false, true}) {  // nothing is written before everything is known to be safe
    for (const embedded::Entry& entry : embedded::grade_kits_entries()) {
      if (!entry.name.starts_with(prefix)) continue;
      const std::string path = folder + "/" + place_in_kit(entry.name.substr(prefix.size()));
      std::error_code none;
      const bool is_there = std::filesystem::exists(path, none);
      if (const auto there = read_file(path); is_there && (!there || *there != entry.bytes))
        return fail(Error{ErrorKind::cannot_write,
                          "is there already and differs from the kit's; move it away first", path});
      if (!writes || is_there) continue;
      if (const auto made = make_folder_for(path); !made) return made;
      if (const auto written = write_file(path, entry.bytes); !written) return written;
    }
  }
  return {};
}

}  // namespace gnomon::app::grade
