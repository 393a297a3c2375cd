#include "app/lesson_scene.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <sstream>
#include <vector>

#include "app/options/map_options.h"
#include "app/options/setting_options.h"
#include "app/options/shimmer_options.h"
#include "raster/settings.h"
#include "report/lessons.h"
#include "scene/files/json/json_reader.h"
#include "scene/files/path_status.h"
#include "scene/load.h"

namespace gnomon::app {

namespace {

bool is_of_bias(const raster::MapSetting& setting) {
  return setting.group == raster::SettingGroup::bias;
}

bool is_of_bias(const std::string& option) {
  const raster::MapSetting* setting = raster::find_setting(option);
  return setting != nullptr && is_of_bias(*setting);
}

bool names_option(const OptionValues& values, std::string_view name) {
  return std::any_of(values.begin(), values.end(), [&](const auto& entry) { return entry.first == name; });
}

struct LessonSetting {
  std::string option;                ///< "--map-size"
  std::optional<std::string> value;  ///< none: a flag
};

struct LessonCommand {
  std::string scene;
  std::vector<LessonSetting> settings;
};

/// "gnomon compare SCENE [--option [value]]…": a test holds the lessons to this form.
LessonCommand read_command(std::string_view text) {
  std::istringstream words{std::string(text)};
  LessonCommand command;
  std::string word;
  words >> word >> word >> command.scene;
  while (words >> word) {
    if (word.starts_with("--")) {
      command.settings.push_back({word, {}});
    } else if (!command.settings.empty()) {
      command.settings.back().value = word;
    }
  }
  return command;
}

std::optional<LessonCommand> find_lesson(std::string_view name) {
  const auto all = report::all_lessons();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const report::Lesson& l) { return l.name == name; });
  if (found == all.end()) return std::nullopt;
  return read_command(found->command);
}

bool was_given(const CLI::App& command, const std::string& option) {
  const CLI::Option* known = command.get_option_no_throw(option);
  return known != nullptr && known->count() > 0;
}

/// tune finds the map's options: a lesson's or a scene's would only narrow its search.
bool finds_map_options(const CLI::App& command) {
  return command.get_name() == "tune";
}

bool is_map_setting(const std::string& option) {
  return raster::find_setting(option.substr(2)) != nullptr;
}

/// Whether the command makes a film: sweep and tune do only where errors are flips.
bool makes_film(const CLI::App& command) {
  if (command.get_option_no_throw("--measure") == nullptr) return true;
  const auto starts = [&](const char* name, std::string_view value) {
    return was_given(command, name) && command.get_option(name)->results().back().starts_with(value);
  };
  return starts("--measure", "shimmer") || starts("--max-error", "shimmer:");
}

std::string usual_technique() {
  return std::string(raster::technique_name(raster::MapOptions{}.technique));
}

/// The technique that the lesson shows.
std::string technique_of(const LessonCommand& lesson) {
  for (const auto& [option, value] : lesson.settings)
    if (option == "--technique" && value) return *value;
  return usual_technique();
}

/// The technique that a scene's settings are for.
std::string technique_of_scene(const std::string& path_or_name) {
  for (const SceneSetting& setting : scene_settings(path_or_name))
    if (setting.option == "technique") return setting.value;
  return usual_technique();
}

/// What a lesson or a scene file asks of the shadow map, by the names of options; a switch is "on".
OptionValues map_settings_of(const std::string& path_or_name, const std::optional<LessonCommand>& lesson) {
  OptionValues asked;
  if (lesson) {
    for (const auto& [option, value] : lesson->settings)
      if (is_map_setting(option)) asked.emplace_back(option.substr(2), value.value_or("on"));
  } else {
    for (const SceneSetting& setting : scene_settings(path_or_name))
      asked.emplace_back(setting.option, setting.value);
  }
  return asked;
}

/// Looks for settings only where they matter for the technique that is asked for: a scene's need a look at its file.
template <class Technique>
SettingsUse use_of_settings(const CLI::App& command, const Technique& technique) {
  if (command.get_option_no_throw("--bias") == nullptr) return SettingsUse::none;
  if (finds_map_options(command)) return SettingsUse::sought;
  if (!was_given(command, "--technique")) return SettingsUse::taken;
  const std::vector<std::string>& given = command.get_option("--technique")->results();
  return given.back() == technique() ? SettingsUse::taken : SettingsUse::left_out;
}

}  // namespace

std::string scene_of_lesson(const std::string& path_or_name) {
  const auto lesson = find_lesson(path_or_name);
  return lesson ? lesson->scene : path_or_name;
}

std::string lesson_note(const std::string& path_or_name) {
  const auto all = report::all_lessons();
  for (const report::Lesson& lesson : all) {
    if (lesson.name == path_or_name) return fmt::format("lesson \"{}\": {}", lesson.title, lesson.command);
  }
  return {};
}

std::string scene_settings_text(const std::string& path_or_name) {
  std::string text;
  for (const SceneSetting& setting : scene_settings(path_or_name))
    text += fmt::format("{}--{} {}", text.empty() ? "" : " ", setting.option, setting.value);
  return text;
}

SettingsUse use_of_settings(const CLI::App& command) {
  const CLI::Option* scene = command.get_option_no_throw("SCENE");
  if (scene == nullptr || scene->count() != 1) return SettingsUse::none;
  const std::string& name = scene->results().front();
  const auto lesson = find_lesson(name);
  return use_of_settings(command, [&] { return lesson ? technique_of(*lesson) : technique_of_scene(name); });
}

std::string settings_note(const SceneArgument& scene) {
  std::string note = lesson_note(scene.name);
  const bool of_lesson = !note.empty();
  // The settings of built-in scenes are theirs by design; those of a file may surprise.
  if (!of_lesson && scene.settings != SettingsUse::none && file_kind_or_none(scene.name) == FileKind::file)
    note = scene_settings_text(scene.name);
  if (note.empty()) return {};
  if (!of_lesson) note = "the scene asks for " + note;
  if (scene.settings == SettingsUse::left_out)
    return note + "; another technique was given, so these settings are not used";
  if (scene.settings == SettingsUse::sought)
    return note + "; the map's options among these are sought, not taken";
  return note + ", where no option given here says otherwise";
}

OptionValues settled_values(const std::string& path_or_name, OptionValues values) {
  const auto drawn = parse_setting(values);
  if (!drawn) return values;
  const raster::MapOptions& map = drawn->options.raster.map;
  const auto lesson = find_lesson(path_or_name);
  const std::string technique(raster::technique_name(map.technique));
  if ((lesson ? technique_of(*lesson) : technique_of_scene(path_or_name)) != technique) {
    if (!names_option(values, "technique")) values.emplace_back("technique", technique);
    return values;  // what is for another technique is left out
  }
  const bool biased =
      std::any_of(values.begin(), values.end(), [](const auto& entry) { return is_of_bias(entry.first); });
  for (const auto& [name, value] : map_settings_of(path_or_name, lesson)) {
    const raster::MapSetting* setting = raster::find_setting(name);
    if (setting == nullptr || names_option(values, name) || !raster::reads_setting(map, name)) continue;
    if (!lesson && biased && is_of_bias(*setting)) continue;  // as in add_scene_settings()
    if (std::string text = raster::setting_text(*setting, map); text != value)
      values.emplace_back(name, std::move(text));
  }
  return values;
}

Expected<std::map<std::string, Error>> add_scene_settings(CLI::App& command) {
  std::map<std::string, Error> places;
  const CLI::Option* scene = command.get_option_no_throw("SCENE");
  if (scene == nullptr || scene->count() != 1) return places;
  const std::string& path = scene->results().front();
  const SettingsUse use = use_of_settings(command, [&] { return technique_of_scene(scene_of_lesson(path)); });
  if (use == SettingsUse::left_out || use == SettingsUse::sought) return places;
  const auto asked = scene_settings(scene_of_lesson(path));
  const auto settings = raster::map_settings();
  const bool biased = std::any_of(settings.begin(), settings.end(), [&](const raster::MapSetting& setting) {
    return is_of_bias(setting) && was_given(command, fmt::format("--{}", setting.name));
  });
  for (const auto& [name, value, line, column] : asked) {
    const std::string option_name = "--" + name;
    Error error{ErrorKind::bad_input, "is no option of the shadow map", path, line, column,
                "settings." + name};
    const raster::MapSetting* setting = raster::find_setting(name);
    if (setting == nullptr) {
      const std::vector<std::string> known = map_setting_names();
      error.reason += suggestion(name, {known.begin(), known.end()});
      return fail(std::move(error));
    }
    CLI::Option* option = command.get_option_no_throw(option_name);
    if (option == nullptr || option->count() > 0 || (biased && is_of_bias(*setting))) continue;
    try {
      option->add_result(value);
      option->run_callback();
    } catch (const CLI::ParseError& wrong) {
      error.reason = wrong.what();
      return fail(std::move(error));
    }
    error.reason.clear();
    places.emplace(option_name, std::move(error));
  }
  return places;
}

void add_lesson_settings(CLI::App& command) {
  const CLI::Option* scene = command.get_option_no_throw("SCENE");
  if (scene == nullptr || scene->count() != 1 || use_of_settings(command) == SettingsUse::left_out) return;
  const auto lesson = find_lesson(scene->results().front());
  if (!lesson) return;
  for (const auto& [name, value] : lesson->settings) {
    CLI::Option* option = command.get_option_no_throw(name);
    if (option == nullptr || option->count() > 0) continue;
    if (finds_map_options(command) && is_map_setting(name)) continue;
    if (is_film_option(name) && !makes_film(command)) continue;
    option->add_result(value.value_or("true"));
    option->run_callback();
  }
}

}  // namespace gnomon::app
