// The options that say what is compared: those that `compare` takes once and `sweep` and `tune` vary; and settings as names and values,
// which the same parser reads.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/options/options.h"
#include "app/options/pose_options.h"
#include "compare/setting.h"

namespace CLI {
class Option;
}

namespace gnomon::app {

struct SettingOptions {
  compare::CompareOptions options;
  std::string light;  ///< name of the one light to compare; empty: all
  PoseOptions poses;
};

/// --size, the map's options, --light, the poses, the ray tracer's options.
void add_setting_options(CLI::App& command, SettingOptions& setting);

/// What a comparison needs to know. `given` is the scene as it was loaded.
Expected<compare::Setting> resolve_setting(const SettingOptions& setting, const Scene& given,
                                           const World& world);

/// The parser of those options alone.
const CLI::App& setting_parser();
/// Whether an option of it is given without a value, " --snap".
bool is_flag(const CLI::Option& option);

/// Parses settings by compare's parser; the values are those of options by name. Errors are ErrorKind::usage.
Expected<SettingOptions> parse_setting(const std::vector<std::pair<std::string, std::string>>& values);
/// The values that the technique among them reads.
std::vector<std::pair<std::string, std::string>> values_read(
    const std::vector<std::pair<std::string, std::string>>& values);
/// Writes the values as arguments, quoted for a shell, with a blank before each.
std::string setting_arguments(const std::vector<std::pair<std::string, std::string>>& values);
/// Checks one value of one option. Error (usage): it is none.
Expected<void> check_setting(const std::string& name, const std::string& value);

}  // namespace gnomon::app
