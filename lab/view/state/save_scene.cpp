#include "lab/view/work/scene_source.h"

#include <fmt/core.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/lesson_scene.h"
#include "app/outputs/run_files.h"
#include "app/pose.h"
#include "app/process/interrupt.h"
#include "compare/result/result_parts.h"
#include "lab/view/state/status.h"
#include "scene/files/formats.h"
#include "scene/files/json/light_json.h"
#include "scene/files/read_file.h"
#include "scene/files/write_file.h"
#include "scene/load.h"

namespace gnomon::lab {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json camera_json(const Camera& camera) {
  Json json{{"eye", compare::vector3(camera.eye)},
            {"target", compare::vector3(camera.target)},
            {"up", compare::vector3(camera.up)}};
  if (camera.orthographic())
    json["orthographic_height"] = camera.orthographic_height;
  else
    json["vertical_fov_degrees"] = app::degrees(camera.vertical_fov);
  if (camera.samples_per_pixel != 1) json["samples_per_pixel"] = camera.samples_per_pixel;
  return json;
}

Json light_json(const Light& light) {
  Json json = light_place_json(light);
  json["intensity"] = compare::vector3(Vec3(light.intensity));
  if (light.type == LightType::spot) {
    json["inner_angle_degrees"] = app::degrees(light.inner_angle);
    json["outer_angle_degrees"] = app::degrees(light.outer_angle);
  }
  add_shape(json, light.extent, AngleForm::degrees);
  if (light.shadow_samples != Light{}.shadow_samples) json["shadow_samples"] = light.shadow_samples;
  return json;
}

bool is_own_format(const std::string& name) {
  return find_builtin_scene(name) || lower_extension(name) == ".json";
}

/// The file as it is, or a new one that includes the model.
Expected<Json> base_json(const std::string& name, const std::string& path) {
  if (!is_own_format(name)) {
    const fs::path folder = fs::absolute(path).parent_path();
    const std::string model = fs::absolute(name).lexically_relative(folder).string();
    if (model.empty() || model.starts_with(".."))
      return fail(ErrorKind::usage,
                  fmt::format("{}: a scene file includes only what lies in its folder or below", name));
    return Json{{"schema", "gnomon/scene/1"}, {"name", fs::path(name).stem().string()}, {"include", {model}}};
  }
  std::string text;
  if (const auto builtin = find_builtin_scene(name)) {
    text = builtin->text;
  } else {
    auto read = read_file(name);
    if (!read) return fail(read.error());
    text = std::move(*read);
  }
  Json json = Json::parse(text, nullptr, false, true);
  if (!json.is_object()) return fail(ErrorKind::bad_input, name + ": not a JSON object");
  return json;
}

/// Read again, the text of the file says what was meant.
Expected<void> check(const std::string& text, const std::string& path, const Scene& meant) {
  const auto scene = load_json_scene(text, path, folder_of(path), {.confine_paths = true});
  if (!scene) return fail(scene.error());
  bool same = scene->lights.size() == meant.lights.size();
  for (std::size_t i = 0; same && i < meant.lights.size(); ++i) {
    const Light &a = scene->lights[i], &b = meant.lights[i];
    const bool aims = b.type != LightType::point;  // a point light's direction means nothing
    same = a.name == b.name && a.type == b.type && (!aims || glm::length(a.direction - b.direction) < 1e-9) &&
           glm::length(a.position - b.position) <= 1e-9 * (1.0 + glm::length(b.position)) &&
           std::abs(light_size(a) - light_size(b)) <= 1e-9 * light_size(b);
  }
  if (same) return {};
  return fail(ErrorKind::internal, path + ": read again, the lights of the scene are others");
}

}  // namespace

std::string folder_for_scene(const app::SceneArgument& opened) {
  const std::string name = app::scene_of_lesson(opened.name);
  if (find_builtin_scene(name)) return "";
  const std::string folder = fs::path(name).parent_path().string();
  return folder.empty() ? "" : folder + "/";
}

Expected<void> write_scene(const std::string& path, const app::SceneArgument& opened,
                           const ViewState& state) {
  const std::string name = app::scene_of_lesson(opened.name);
  if (opened.time)
    return fail(ErrorKind::usage,
                "a scene file cannot hold a moment of an animation; gnomon export --time writes one as glTF");
  auto json = base_json(name, path);
  if (!json) return fail(json.error());
  Scene meant;
  place(state.given, state.setup, meant);
  json->erase("cameras");
  (*json)["camera"] = camera_json(meant.camera);
  (*json)["lights"] = Json::array();
  if (json->contains("include")) (*json)["include_lights"] = false;  // they stand here as they are now
  for (const Light& light : meant.lights) (*json)["lights"].push_back(light_json(light));
  (*json)["settings"] = Json::object();
  for (const auto& [option, value] : raster::map_values(state.setup.map)) (*json)["settings"][option] = value;
  const app::OutputGuard whole_output;
  if (auto made = make_folder_for(path); !made) return made;
  const std::string text = compare::dumped(*json, 2);
  if (auto same = check(text, path, meant); !same) return same;
  return write_file(path, text);
}

}  // namespace gnomon::lab
