#include "app/lesson_scene.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <optional>
#include <sstream>
#include <vector>

#include "compare/report/lessons.h"

namespace gnomon::app {

namespace {

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
  const auto all = compare::all_lessons();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const compare::Lesson& l) { return l.name == name; });
  if (found == all.end()) return std::nullopt;
  return read_command(found->command);
}

bool was_given(const CLI::App& command, const std::string& option) {
  const CLI::Option* known = command.get_option_no_throw(option);
  return known != nullptr && known->count() > 0;
}

}  // namespace

std::string scene_of_lesson(const std::string& path_or_name) {
  const auto lesson = find_lesson(path_or_name);
  return lesson ? lesson->scene : path_or_name;
}

std::string lesson_note(const std::string& path_or_name) {
  const auto all = compare::all_lessons();
  for (const compare::Lesson& lesson : all) {
    if (lesson.name == path_or_name)
      return fmt::format("lesson \"{}\": {}, where no option given here says otherwise", lesson.title,
                         lesson.command);
  }
  return {};
}

void add_lesson_settings(CLI::App& command) {
  const CLI::Option* scene = command.get_option_no_throw("SCENE");
  if (scene == nullptr || scene->count() != 1 || was_given(command, "--technique")) return;
  const auto lesson = find_lesson(scene->results().front());
  if (!lesson) return;
  for (const auto& [name, value] : lesson->settings) {
    CLI::Option* option = command.get_option_no_throw(name);
    if (option == nullptr || option->count() > 0) continue;
    option->add_result(value.value_or("true"));
    option->run_callback();
  }
}

}  // namespace gnomon::app
