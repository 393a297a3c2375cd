// CLI11 throws; what is thrown here is caught here.
#include "app/view/map_option.h"

#include <CLI/App.hpp>
#include <algorithm>

#include "app/options.h"
#include "app/setting.h"

namespace gnomon::app {

Expected<void> set_map_option(raster::MapOptions& map, const std::string& name, const std::string& value) {
  CLI::App options;
  options.set_help_flag();
  raster::MapOptions changed = map;
  add_map_options(options, changed);
  try {
    options.parse(std::vector<std::string>{"--" + name + "=" + value});
  } catch (const CLI::ParseError& error) {
    const std::string text = error.what(), prefix = "--" + name + ": ";
    return fail(ErrorKind::usage, text.starts_with(prefix) ? text.substr(prefix.size()) : text);
  }
  map = changed;
  return {};
}

bool is_map_option(const std::string& name) {
  const std::vector<std::string> names = map_setting_names();
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace gnomon::app
