// CLI11 throws; what is thrown here is caught in command_line.cpp and never leaves this room.
#include "app/options/setting_options.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/session.h"
#include "scene/base/option_text.h"

namespace gnomon::app {

namespace {

using Values = std::vector<std::pair<std::string, std::string>>;

/// compare's own parser for one setting.
struct Parser {
  CLI::App app;
  SettingOptions setting;
  Parser() {
    app.set_help_flag();
    add_setting_options(app, setting);
  }
};

/// Kept: to make all options takes longer than to read a line.
Parser& kept_parser() {
  static thread_local Parser parser;
  return parser;
}

}  // namespace

const CLI::App& setting_parser() {
  return kept_parser().app;
}

bool is_flag(const CLI::Option& option) {
  return option.get_items_expected_max() == 0;
}

namespace {

/// Given as " --snap" or not at all, where " --mipmaps off" takes the word.
bool is_switch(const std::string& name) {
  return is_flag(*kept_parser().app.get_option("--" + name));
}

Expected<bool> parse_switch(const std::string& name, const std::string& value) {
  if (value == "on" || value == "off") return value == "on";
  return fail(ErrorKind::usage, fmt::format("--{}: unknown value (got {}, allowed on, off)", name, value));
}

/// `whole`: a setting, not one value to be checked.
Expected<SettingOptions> parse(const Values& values, bool whole) {
  Parser& parser = kept_parser();
  parser.setting = SettingOptions{};
  std::vector<std::string> arguments;  // CLI11 wants them last first
  for (const auto& [name, value] : values) {
    if (!is_switch(name)) {
      arguments.push_back(fmt::format("--{}={}", name, value));
      continue;
    }
    const Expected<bool> on = parse_switch(name, value);
    if (!on) return fail(on.error());
    if (*on) arguments.push_back("--" + name);
  }
  std::reverse(arguments.begin(), arguments.end());
  try {
    parser.app.parse(arguments);
    if (whole) finish_map_options(parser.app, parser.setting.options.raster.map);
  } catch (const CLI::ParseError& error) {
    return fail(ErrorKind::usage, error.what());
  }
  return parser.setting;
}

}  // namespace

Values values_read(const Values& values) {
  raster::MapOptions map;
  for (const auto& [name, value] : values) {
    if (name != "technique" && name != "filter-kernel") continue;
    [[maybe_unused]] const Expected<void> known = raster::set_setting(name, map, value);
  }
  Values read = values;
  std::erase_if(read, [&](const auto& entry) { return !raster::reads_setting(map, entry.first); });
  return read;
}

Expected<void> check_setting(const std::string& name, const std::string& value) {
  const auto parsed = parse({{name, value}}, false);
  if (!parsed) return fail(parsed.error());
  return {};
}

Expected<SettingOptions> parse_setting(const Values& values) {
  return parse(values, true);
}

std::string setting_arguments(const Values& values) {
  std::string text;
  for (const auto& [name, value] : values) {
    if (is_switch(name))
      text += " --" + name + (value == "on" ? "" : "=false");
    else if (value.starts_with('-'))
      text += fmt::format(" --{}={}", name, shell_quoted(value));
    else
      text += fmt::format(" --{} {}", name, shell_quoted(value));
  }
  return text;
}

void add_setting_options(CLI::App& command, SettingOptions& setting) {
  compare::CompareOptions& options = setting.options;
  add_size(command, options.raster.size);
  add_map_options(command, options.raster.map);
  add_light(command, setting.light, "compare this light only");
  add_pose_options(command, setting.poses);
  add_tracer_options(command, options.accel, options.precision);
  add_min_contribution(command, options.raytrace.min_contribution);
  add_samples(command, options.raytrace.shadow_samples);
}

Expected<compare::Setting> resolve_setting(const SettingOptions& from, const Scene& given,
                                           const World& world) {
  compare::Setting setting;
  setting.raster = from.options.raster;
  setting.raytrace = from.options.raytrace;
  setting.raytrace.size = setting.raster.size;
  setting.accel = from.options.accel;
  setting.precision = from.options.precision;
  const auto compared = choose_lights(given, from.light);
  if (!compared) return fail(compared.error());
  setting.compared = *compared;
  // Poses need the scene's camera and lights alone.
  Scene posed;
  posed.camera = given.camera;
  posed.lights = given.lights;
  const auto applied = apply_poses(from.poses, from.light, posed, world);
  if (!applied) return fail(applied.error());
  setting.camera = posed.camera;
  setting.lights = std::move(posed.lights);
  return setting;
}

}  // namespace gnomon::app
