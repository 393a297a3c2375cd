// gnomon scenes: the built-in scenes and lessons, whose names work wherever a scene file does.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/console.h"
#include "app/help/manual.h"
#include "app/invocation.h"
#include "app/options/options.h"
#include "app/outputs/render_json.h"
#include "app/outputs/run_files.h"
#include "report/lessons.h"
#include "scene/load.h"

namespace gnomon::app {

namespace {

constexpr std::size_t name_column = 16;  // columns
constexpr std::size_t table_width = 80;  // columns

std::string scenes_json() {
  nlohmann::ordered_json scenes = nlohmann::ordered_json::array();
  for (const BuiltinScene& scene : builtin_scenes()) {
    scenes.push_back({{"name", scene.name}, {"description", scene.description}});
  }
  nlohmann::ordered_json lessons = nlohmann::ordered_json::array();
  for (const report::Lesson& lesson : report::all_lessons())
    lessons.push_back({{"name", lesson.name}, {"title", lesson.title}, {"command", lesson.command}});
  return nlohmann::ordered_json{{"scenes", scenes}, {"lessons", lessons}}.dump(2) + "\n";
}

std::string scenes_table() {
  std::string text;
  for (const BuiltinScene& scene : builtin_scenes()) {
    const std::string description = wrap(std::string(scene.description), name_column, table_width);
    text += fmt::format("{:<{}}{}", scene.name, name_column, description.substr(name_column));
  }
  text += "\nLessons, in docs/lessons; the name of one stands for the scene and settings of its command:\n";
  for (const report::Lesson& lesson : report::all_lessons())
    text += fmt::format("{:<{}}{}\n{:{}}{}\n", lesson.name, name_column, lesson.title, "", name_column,
                        lesson.command);
  return text;
}

Expected<ExitCode> run_scenes(const std::string& json) {
  if (const auto writable = check_output_file(json); !writable) return fail(writable.error());
  if (json.empty()) print_data(scenes_table());
  if (const auto out = hand_out_json(json, scenes_json()); !out) return fail(out.error());
  return ExitCode::done;
}

}  // namespace

GNOMON_COMMAND(scenes, 50, "List the built-in scenes and the lessons; any of their names serves as SCENE.") {
  app->footer(
      "gnomon scenes\ngnomon compare courtyard\ngnomon compare acne            a lesson's scene and "
      "settings");
  const auto json = std::make_shared<std::string>();
  add_json(*app, *json, "the list");
  app->callback([json, &invocation] { invocation.action = [json] { return run_scenes(*json); }; });
}

}  // namespace gnomon::app
