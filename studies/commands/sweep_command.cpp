#include "studies/commands/sweep_command.h"

#include <fmt/core.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/lesson_scene.h"
#include "compare/result/figures.h"
#include "compare/result/option_names.h"
#include "scene/base/option_text.h"
#include "scene/files/encodings.h"
#include "scene/files/read_file.h"

namespace gnomon::app {
namespace {

std::string camera_argument(const SweepCommand& command) {
  return command.camera.empty() ? std::string() : " --camera " + shell_quoted(command.camera);
}

std::string exposure_argument(const SweepCommand& command) {
  if (!command.exposure) return {};
  return *command.exposure ? fmt::format(" --exposure {}", **command.exposure) : " --exposure auto";
}

// A film's receivers and frames, and what its file of keys says.
nlohmann::ordered_json film_configuration(const FilmedMeasure& asked) {
  if (!asked.is_filmed()) return nullptr;
  nlohmann::ordered_json film = nlohmann::ordered_json::object();
  for (const auto& [option, value] : asked.film.given) film[option.substr(2)] = value;
  if (const std::string file = path_file(asked.film); !file.empty())
    if (const auto bytes = read_file(file)) film["sha256"] = sha256_hex(*bytes);
  return film;
}

// A file of keys by its whole path: tasks may start elsewhere.
FilmOptions with_whole_path(FilmOptions film) {
  if (const std::string file = path_file(film); !file.empty())
    for (auto& [option, value] : film.given)
      if (option == "--path") value = std::filesystem::absolute(file).string();
  return film;
}

std::string measure_arguments(const FilmedMeasure& asked) {
  const std::string measure = measure_argument(*asked.measure);
  return asked.is_filmed() ? measure + film_arguments(with_whole_path(asked.film)) : measure;
}

}  // namespace

std::string configuration(const SweepCommand& command, const Plan& plan, const Scene& scene) {
  using Json = nlohmann::ordered_json;
  Json axes = Json::array(), fixed = Json::object();
  for (const studies::Axis& axis : plan.grid.axes())
    axes.push_back({{"name", axis.name}, {"values", axis.values}});
  for (const auto& [name, value] : command.options.fixed()) fixed[name] = value;
  Json shaders = Json::array();
  for (const raster::ReplacedShader& shader : command.replaced_shaders)
    shaders.push_back({{"replaced", shader.name}, {"sha256", shader.sha256}});
  Json exposure = nullptr;
  if (command.exposure) exposure = *command.exposure ? Json(**command.exposure) : Json("auto");
  Json json{{"version", compare::program_version()},
            {"scene", {{"path", command.scene.name}, {"name", scene.name}, {"sha256", scene.sha256}}},
            {"camera", command.camera},
            {"axes", axes},
            {"zip", command.zip},
            {"options", fixed},
            {"exposure", exposure},
            {"shaders", shaders},
            {"perceptual", command.perceptual},
            {"runs", command.runs.value_or(usual_runs)},
            {"seed", command.seed},
            {"effects", compare::effects_json(plan_effects(scene))}};
  if (command.full_records) json["full_records"] = true;
  if (command.asked.measure != &compare::wrong_and_mean())
    json["measure"] = command.asked.measure->measure.name;
  if (command.max_lights != usual_max_lights) json["max_lights"] = command.max_lights;
  if (command.scene.time)
    json["time"] = {{"path", command.scene.time->path}, {"seconds", command.scene.time->seconds}};
  if (Json film = film_configuration(command.asked); !film.is_null()) json["film"] = std::move(film);
  if (const std::string views = view_arguments(command.views, command.asked.film, command.asked.is_filmed());
      !views.empty())
    json["views"] = {{"arguments", views}, {"measure", view_measure(command).measure.name}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

const compare::Figure& view_measure(const SweepCommand& command) {
  return command.max_error ? *command.max_error->measure : *command.asked.measure;
}

void set_runs(const SweepCommand& command, compare::CompareOptions& options) {
  options.raster.runs = options.raytrace.runs = rounds_of(command);
  options.raytrace.enough_ms = command.runs ? never_enough_ms : usual_enough_ms;
}

int rounds_of(const SweepCommand& command) {
  return command.runs.value_or(usual_runs);
}

std::string compare_command(const SweepCommand& command, const Plan& plan, std::size_t cell) {
  const bool filmed = command.asked.is_filmed();
  std::string text =
      (filmed ? "gnomon shimmer " : "gnomon compare ") + command.scene.words() + camera_argument(command) +
      setting_arguments(settled_values(command.scene.name, command.options.read_values(plan.grid, cell)));
  text += filmed ? film_arguments(command.asked.film)
                 : measure_argument(*command.asked.measure) + exposure_argument(command);
  text += filmed ? std::string() : view_arguments(command.views, command.asked.film, false);
  text += max_lights_argument(command.max_lights) + backend_argument(command.backend);
  if (!command.shader_folder.empty()) text += " --shader-dir " + shell_quoted(command.shader_folder);
  if (command.seed != 0) text += fmt::format(" --seed {}", command.seed);
  return text;
}

std::string task_arguments(const SweepCommand& command) {
  namespace fs = std::filesystem;
  SceneArgument scene = command.scene;
  if (fs::path(scene.name).has_extension()) scene.name = fs::absolute(scene.name).string();
  std::string text = fmt::format(" {}", scene.words());
  text += camera_argument(command) + command.options.arguments() + exposure_argument(command);
  const bool filmed = command.asked.is_filmed();
  text += measure_arguments(command.asked) +
          view_arguments(command.views, with_whole_path(command.asked.film), filmed) +
          max_lights_argument(command.max_lights);
  if (command.seed != 0) text += fmt::format(" --seed {}", command.seed);
  if (!command.shader_folder.empty())
    text += " --shader-dir " + shell_quoted(fs::absolute(command.shader_folder).string());
  if (command.runs) text += fmt::format(" --runs {}", *command.runs);
  if (command.threads != 0) text += fmt::format(" --threads {}", command.threads);
  text += backend_argument(command.backend);
  for (const auto& [given, name] :
       {std::pair(command.zip, " --zip"), std::pair(command.perceptual, " --perceptual"),
        std::pair(command.ray_tracer, " --ray-tracer"), std::pair(command.restart, " --restart"),
        std::pair(command.full_records, " --full-records")})
    if (given) text += name;
  return text;
}

}  // namespace gnomon::app
