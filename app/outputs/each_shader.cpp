#include "app/outputs/each_shader.h"

#include <cstdlib>
#include <filesystem>

#include "raster/use_shaders.h"
#include "scene/files/path_status.h"
#include "scene/files/write_file.h"

namespace gnomon::app {

bool is_asked_for_each_shader() {
  return std::getenv(raster::each_folder_variable) != nullptr;
}

Expected<ExitCode> for_each_shader(
    const std::string& output,
    const std::function<Expected<void>(const std::string& shaders, const std::string& place)>& make) {
  const std::filesystem::path folder = std::getenv(raster::each_folder_variable), pattern = output;
  const auto names = names_in(folder.string());
  if (!names) return fail(names.error());
  for (const std::string& name : *names) {
    const std::string place = (pattern.parent_path() / name / pattern.filename()).string();
    if (auto folder_made = make_folder_for(place); !folder_made) return fail(folder_made.error());
    const auto made = make((folder / name).string(), place);
    if (!made && made.error().kind != ErrorKind::bad_input) return fail(made.error());
  }
  return ExitCode::done;
}

}  // namespace gnomon::app
