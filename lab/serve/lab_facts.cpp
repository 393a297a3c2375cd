#include "lab/serve/lab_facts.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "compare/ladder/labels.h"
#include "compare/result/number_text.h"
#include "lab/serve/setting_facts.h"
#include "lab/view/state/look.h"
#include "lab/view/state/pixel_story.h"
#include "lab/view/state/status.h"
#include "raster/settings.h"
#include "report/lessons.h"
#include "report/page.h"
#include "scene/load.h"

namespace gnomon::lab {
namespace {

using Json = nlohmann::ordered_json;

Json pose_json(const app::CameraPose& pose) {
  return {
      {"azimuth", pose.azimuth_degrees}, {"elevation", pose.elevation_degrees}, {"distance", pose.distance}};
}

Json light_json(const ViewState& state) {
  const app::LightPose pose = current_light(state);
  const Light& given = state.given.lights[state.setup.light];
  const bool sun = given.type == LightType::directional;
  const double own = sun ? 0.0 : glm::length(given.position - state.given.centre);
  return {{"name", state.light_name()},
          {"sun", sun},
          {"azimuth", pose.azimuth_degrees},
          {"elevation", pose.elevation_degrees},
          {"distance", sun ? Json() : Json(pose.distance.value_or(own))},
          {"own_distance", own},
          {"size", light_size(posed_light(state))}};
}

Json compared_json(const ComparisonOutcome& outcome) {
  const compare::Verdict& verdict = outcome.verdict;
  return {{"verdict", {{"headline", verdict.headline()}, {"detail", verdict.detail}}},
          {"result", Json::parse(outcome.result)}};
}

Json times_json(const ShadowTimeWords& times) {
  Json rows = Json::array();
  for (const ShadowTimeWords::Row& row : times.rows) rows.push_back({row.name, row.time});
  return {{"clock", times.of_device ? "gpu" : "processor"}, {"rows", rows}, {"by", times.by}};
}

}  // namespace

std::string lab_facts(const LabOptions& options, bool worker) {
  Json settings = Json::array(), techniques = Json::array(), pictures = Json::array(), shown = Json::array(),
       scenes = Json::array(), lessons = Json::array(), extensions = Json::array();
  for (const SceneFormat& format : scene_formats()) extensions.push_back(format.extension);
  for (const raster::SettingGroup group : raster::panel_groups)
    for (const raster::MapSetting& row : raster::map_settings())
      if (row.group == group) settings.push_back(setting_facts(row));
  for (const raster::TechniqueTraits& traits : raster::all_technique_traits())
    techniques.push_back({{"name", traits.name}, {"for_suns", traits.lights.has(LightType::directional)}});
  for (std::size_t i = 0; i < picture_count; ++i) {
    const auto picture = static_cast<Picture>(i);
    pictures.push_back({{"name", picture_name(picture)},
                        {"title", picture_title(picture)},
                        {"legend", picture_legend(picture)}});
  }
  for (const Preset& preset : presets()) shown.push_back({{"title", preset.title}, {"what", preset.what}});
  for (const BuiltinScene& scene : builtin_scenes())
    if (!scene.large) scenes.push_back({{"name", scene.name}, {"what", scene.description}});
  for (const report::Lesson& lesson : report::all_lessons())
    lessons.push_back({{"name", lesson.name}, {"what", lesson.title}});
  const ImageSize size = options.compare.raster.size;
  const Json facts = {{"kind", "lab"},
                      {"worker", worker},
                      {"manual", worker ? "manual/options.html" : ""},
                      {"size", {{"width", size.width}, {"height", size.height}}},
                      {"scene", options.scene.name},
                      {"settings", settings},
                      {"techniques", techniques},
                      {"labels", report::label_facts()},
                      {"rungs", report::rung_facts(compare::Ladder::map)},
                      {"ray_rungs", report::rung_facts(compare::Ladder::rays)},
                      {"pictures", pictures},
                      {"presets", shown},
                      {"scenes", scenes},
                      {"lessons", lessons},
                      {"extensions", extensions}};
  return facts.dump();
}

std::string lab_reading(const LabMoment& moment, const std::vector<std::string>& compare_words) {
  const ViewState& state = moment.state;
  const Snapshot& shown = *moment.shown;
  Json out = {{"number", moment.number},   {"client", moment.client}, {"revision", state.revision},
              {"opening", moment.opening}, {"error", moment.error},   {"note", moment.note}};
  if (!shown.scene) return out.dump();
  Json lights = Json::array();
  for (const Light& light : state.given.lights) lights.push_back(light.name);
  std::string command = "gnomon";
  for (const std::string& word : compare_words) command += " " + shell_quoted(word);
  out.update({{"scene", {{"name", shown.scene->name}, {"asked_as", moment.scene}, {"lights", lights}}},
              {"words", setting_words(state, moment.options, shown.scene->argument.name)},
              {"command", command},
              {"size", {{"width", state.setup.size.width}, {"height", state.setup.size.height}}},
              {"camera", pose_json(current_camera(state))},
              {"light", light_json(state)},
              {"values", setting_values(state.setup.map)},
              {"precision", raytrace::precision_name(state.setup.precision)},
              {"max_map_size", shown.max_map_size},
              {"renderer", shown.renderer},
              {"bias_world", shown.live.bias_world},
              {"texel_world", shown.live.texel_world},
              {"drawn", shown.live.revision},
              {"raster_ms", shown.live.raster_ms},
              {"compared", shown.outcome ? shown.outcome->revision : 0},
              {"preview", shown.outcome && shown.outcome->preview}});
  if (!shown.outcome) return out.dump();
  out.update(compared_json(*shown.outcome));
  out["times"] = times_json(shadow_time_words(shown, state));
  return out.dump();
}

std::string lab_pixel(const LabMoment& moment, PixelPlace place) {
  const auto outcome = moment.shown->outcome;
  if (!outcome) return "null";
  const PixelStory story = tell_story(*outcome, place, moment.state.setup.size);
  Json out = {{"pixel", {place.x, place.y}},
              {"label", static_cast<int>(story.label)},
              {"rungs", story.rungs},
              {"deciding", story.deciding},
              {"seen", story.seen},
              {"words", story.words},
              {"of_rays", story.ladder == compare::Ladder::rays},
              {"remarks", story.remarks},
              {"cure", story.cure},
              {"face", story.face}};
  constexpr int texels = 8;
  if (const auto cut = cut_through(*outcome, story, texels)) {
    Json stored = Json::array(), receiver = Json::array();
    for (const double depth : cut->stored) stored.push_back(std::isfinite(depth) ? Json(depth) : Json());
    for (const Vec2& at : cut->receiver) receiver.push_back({at.x, at.y});
    out["cut"] = {{"along", cut->along_v ? "v" : "u"},
                  {"first", cut->first},
                  {"stored", stored},
                  {"receiver", receiver},
                  {"at", cut->at},
                  {"distance", cut->distance},
                  {"bias", cut->bias}};
  }
  return out.dump();
}

}  // namespace gnomon::lab
