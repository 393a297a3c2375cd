// result.json: every number of a comparison under the keys of its schema
// (compare/result/result_schema.h). Conventions: a time is {median, runs[]} in ms, median null when it was
// not timed; fractions and means are over compared pixels; a number that is not finite is written as null,
// which the schema allows only where it has a meaning.
#include <algorithm>
#include <charconv>

#include "compare/ladder/budget.h"
#include "compare/result/figures.h"
#include "compare/result/judged.h"
#include "compare/result/layout.h"
#include "compare/result/option_names.h"
#include "compare/result/output_parts.h"
#include "compare/result/outputs.h"
#include "compare/result/result_parts.h"
#include "compare/result/shadow_cost.h"
#include "compare/result/views.h"
#include "raster/technique_traits.h"

namespace gnomon::compare {

Json effects_json(const EffectPlan& plan) {
  Json json = Json::array();
  for (const EffectEntry& e : plan.entries)
    json.push_back({{"effect", effect_name(e.effect)},
                    {"called_for", e.called_for},
                    {"simulated", e.simulated},
                    {"reason", e.reason}});
  return json;
}

namespace {

Json costs_json(const Comparison& c) {
  const raytrace::RayCounts& rays = c.raytraced.rays;
  return {{"map_texels", c.raster.map_texels},    {"map_bytes", c.raster.map_bytes},
          {"primary_rays", rays.primary},         {"shadow_rays", rays.shadow},
          {"soft_shadow_rays", rays.soft_shadow}, {"soft_shadow_rays_asked", rays.soft_shadow_asked},
          {"reflection_rays", rays.reflection},   {"refraction_rays", rays.for_refraction()},
          {"glossy_rays", rays.glossy},           {"indirect_rays", rays.indirect}};
}

// What --fail-above was held against; absent where nothing was asked for.
void add_measure(const Comparison& c, Json& json) {
  if (c.measure != &wrong_and_mean()) json["measure"] = c.measure->measure.name;
}

void add_threshold(const Comparison& c, Json& json) {
  if (!c.fail_above) return;
  const std::vector<LightFigures> lights = judged_lights(c);
  json["fail_above"] = {{"threshold", threshold_text(*c.fail_above)},
                        {"measure", c.fail_above->measure->measure.name},
                        {"limit", number(c.fail_above->limit)},
                        {"failed", !is_kept(*c.fail_above, lights)}};
}

Json agreement_json(const std::vector<Agreement>& all) {
  Json json = Json::array();
  for (const Agreement& one : all) json.push_back({{"of", one.what}, {"share", number(one.share)}});
  return json;
}

Json identified_json(const Identified& i) {
  return {{"technique", i.technique},
          {"options", i.options},
          {"map_size", i.map_size},
          {"bias_world", number(i.bias_world)},
          {"bias_texels", number(i.bias_texels)},
          {"explained", number(i.explained)},
          {"model_error", number(i.model_error)},
          {"picture_error", number(i.picture_error)},
          {"renders", i.renders}};
}

constexpr double quiet_nan = std::numeric_limits<double>::quiet_NaN();

Json other_light_json(const std::optional<OtherLight>& other) {
  if (!other) return nullptr;
  return {{"full_shadow", number(other->full_shadow)},
          {"pixels", other->pixels},
          {"agree", number(other->agree)},
          {"read_as", other->read_as}};
}

// Of a picture that another renderer drew.
Json judged_json(const Judged& j) {
  Json mended = Json::array(), advice = Json::array();
  Json::object_t settings;  // appended to: operator[] looks through all there are, and no two have one name
  for (const auto& [key, value] : j.settings) settings.push_back({key, value});
  for (const Mended& m : j.mended)
    mended.push_back({{"what", m.what},
                      {"evidence", m.evidence},
                      {"before", number(m.before)},
                      {"after", number(m.after)}});
  const auto setting = [](const AdvisedSetting& a) {
    const double world = a.unit_world > 0.0 ? a.instead * a.unit_world : quiet_nan;
    return Json{{"setting", a.setting},
                {"now", number(a.now)},
                {"instead", number(a.instead)},
                {"unit", a.unit},
                {"instead_world", number(world)},
                {"instead_texels", number(a.texel_world > 0.0 ? world / a.texel_world : quiet_nan)}};
  };
  const auto share = [](const std::optional<double>& value) {
    return value ? number(*value) : Json(nullptr);
  };
  for (const Advice& a : j.advice) {
    Json one = setting(a);
    one["wrong_now"] = number(a.wrong_now), one["wrong_instead"] = number(a.wrong_instead);
    one["feasible"] = a.feasible, one["about"] = a.about;
    one["with"] = a.with ? setting(*a.with) : Json(nullptr);
    one["layers"] = Json::array();
    for (const AdvisedSetting& layer : a.layers) one["layers"].push_back(setting(layer));
    one["texels_of_each_layer"] = share(a.texels_of_each);
    one["in_engine"] = Json::array();
    for (const auto& [name, value] : a.in_engine)
      one["in_engine"].push_back({{"engine", j.engine}, {"setting", name}, {"value", number(value)}});
    one["mean_now"] = share(a.mean_now), one["mean_instead"] = share(a.mean_instead);
    advice.push_back(std::move(one));
  }
  return {{"capture", j.capture},
          {"renderer", {{"name", j.renderer}, {"version", j.version}, {"settings", std::move(settings)}}},
          {"map", j.has_map},
          {"positions", j.has_positions},
          {"ratio", j.of_ratio},
          {"traces", j.traces},
          {"other_light", other_light_json(j.other_light)},
          {"agreement", agreement_json(j.agreement)},
          {"mended", std::move(mended)},
          {"biased_is_drawn", j.has_map ? number(j.biased_is_drawn) : Json(nullptr)},
          {"unit_world", j.has_map ? number(j.unit_world) : Json(nullptr)},
          {"unit_world_range",
           j.has_map ? Json{number(j.units[0].world), number(j.units[1].world)} : Json(nullptr)},
          {"identified", j.identified ? identified_json(*j.identified) : Json(nullptr)},
          {"advice", std::move(advice)},
          {"notes", j.notes}};
}

// How often passes were timed.
Json timing_json(const Comparison& c) {
  const auto side = [](int runs, double enough_ms, int subtracted, bool warm_up) {
    return Json{{"most_runs", runs},
                {"enough_ms", number(enough_ms)},
                {"subtracted_runs", std::min(runs, subtracted)},
                {"warm_up", warm_up}};
  };
  const raster::RasterOptions& drawn = c.raster.options;
  const raytrace::RaytraceOptions& traced = c.raytraced.options;
  return {{"raster",
           side(drawn.runs, drawn.enough_ms, drawn.shadow_cost ? drawn.least_subtracted : 0, drawn.runs > 0)},
          {"rays", side(traced.runs, traced.enough_ms, 0, traced.warm_up)},
          {"as_judged", drawn.timed_as_judged},
          {"software_rasterizer", is_software(c.raster.context)}};
}

Json result_object(const Comparison& c, double report_ms, double total_ms, bool full = true) {
  Json lights = Json::array();
  for (const LightComparison& light : c.lights) lights.push_back(light_block(c, light, full));
  Json json{{"schema", "gnomon/result/1"},
            {"command", c.command},
            {"version", program_version()},
            {"seed", c.seed},
            {"threads", c.threads},
            {"size", {{"width", c.raster.options.size.width}, {"height", c.raster.options.size.height}}},
            {"exposure", number(c.exposure)},
            {"scene", scene_json(*c.world)},
            {"machine", machine_json(c.machine)},
            {"gl", context_json(c.raster.context)},
            {"shaders", shaders_json(c.raster.replaced_shaders)},
            {"effects", effects_json(c.plan)},
            {"timing", timing_json(c)},
            {"precision", raytrace::precision_name(c.precision)},
            {"costs", costs_json(c)},
            {"times_ms",
             {{"load", one_time_json(c.load_ms)},
              {"accel_build", times_json(c.raytraced.structure)},
              {"primary_rays", times_json(c.raytraced.primary_rays)},
              {"picture", one_time_json(c.raytraced.picture_ms)},
              {"upload", one_time_json(c.raster.upload_ms)},
              {"read_back", one_time_json(c.raster.read_back_ms)},
              {"topology", one_time_json(c.topology_ms)},
              {"report", one_time_json(report_ms)},
              {"total", one_time_json(total_ms)}}},
            {"lights", std::move(lights)}};
  if (!full) json.erase("effects");
  if (!c.views.views.empty()) json["views"] = views_json(c.views);
  return json;
}

// Every time inside becomes "not timed".
void drop_times(Json& json) {
  for (auto& [key, member] : json.items()) {
    if (key != "times_ms") {
      if (member.is_structured()) drop_times(member);
      continue;
    }
    member.erase("shadows"), member.erase("shading_strips");
    for (auto& time : member) time = time.contains("low") ? difference_json({}) : times_json({});
  }
}

// A line has no times: in a short one nothing says so.
void drop_what_tells_of_times(Json& json) {
  json.erase("timing"), json.erase("times_ms");
  for (Json& light : json["lights"]) light.erase("times_ms");
}

// A number where the text is one, "on" and "off" as truth values, else the text.
Json axis_value(const std::string& text) {
  if (text == "on" || text == "off") return text == "on";
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc{} && end == text.data() + text.size() && std::isfinite(value);
  if (!whole) return text;
  const bool integer = value == std::floor(value) && std::abs(value) < 1e15;
  return integer ? Json(static_cast<std::int64_t>(value)) : Json(value);
}

Json axes_object(const AxisValues& axes) {
  Json json = Json::object();
  for (const auto& [name, value] : axes) json[name] = axis_value(value);
  return json;
}

}  // namespace

Json scene_json(const World& world) {
  const Scene& scene = *world.scene;
  return {{"path", scene.path},
          {"sha256", scene.sha256},
          {"triangles", world.triangle_count()},
          {"shapes", world.shapes.size()},
          {"name", scene.name},
          {"notes", scene.notes}};
}

Json machine_json(const MachineInfo& machine) {
  return {{"cpu", machine.cpu}, {"cores", machine.cores}, {"os", machine.os}, {"load", load_json(machine)}};
}

Json context_json(const raster::ContextInfo& context) {
  return {{"backend", context.backend}, {"version", context.version}, {"renderer", context.renderer}};
}

Json shaders_json(const std::vector<raster::ReplacedShader>& replaced) {
  Json json = Json::array();
  for (const raster::ReplacedShader& shader : replaced)
    json.push_back({{"replaced", shader.name}, {"sha256", shader.sha256}});
  return json;
}

std::string result_json(const Comparison& c, double report_ms, double total_ms) {
  Json json = result_object(c, report_ms, total_ms);
  for (std::size_t i = 0; i < c.lights.size(); ++i) {
    if (!c.judged && !c.lights[i].cascades.empty())
      json["lights"][i]["by_cascade"] = by_cascade_json(c.lights[i].cascades);
    json["lights"][i]["map"]["windows"] = windows_json(c, c.lights[i]);
  }
  json["camera"] = camera_json(c);
  if (c.shaded)
    json["shaded"] = {{"mean_absolute", number(c.shaded->mean_absolute)}, {"flip", number(c.shaded->flip)}};
  if (c.judged) json["judged"] = judged_json(*c.judged);
  add_measure(c, json);
  add_threshold(c, json);
  return dumped(json, 1);
}

Json line_json(const Comparison& c, const AxisValues& axes, const std::vector<std::string>& no_effect,
               bool full) {
  Json json = result_object(c, 0.0, 0.0, full);
  drop_times(json);
  for (Json& light : json["lights"]) light.erase("seams");  // a cell of another bias has none
  if (!full) drop_what_tells_of_times(json);
  json["machine"]["load"] = nullptr;
  if (c.judged) json["judged"] = judged_json(*c.judged);
  json["axes"] = axes_object(axes);
  if (!no_effect.empty()) json["no_effect"] = no_effect;
  return json;
}

std::string on_one_line(const Json& json) {
  return dumped(json, -1);
}

std::string result_line(const Comparison& c, const AxisValues& axes) {
  return on_one_line(line_json(c, axes));
}

std::string axes_text(const AxisValues& axes) {
  return axes_object(axes).dump();
}

Json cell_times_json(const Comparison& c, std::size_t cell, const CellMade& made) {
  Json lights = Json::array();
  for (const LightComparison& light : c.lights) {
    Json entry = Json::object();
    entry["light"] = light_of(c, light).name;
    entry.update(light_times_json(c, light));
    lights.push_back(std::move(entry));
  }
  return {{"cell", cell},
          {"derived", made.derived},
          {"cell_ms", number(made.ms)},
          {"view", made.view},
          {"by", shadow_side(c.raster.options.map.technique)},
          {"load", load_json(c.machine)},
          {"accel_build", times_json(c.raytraced.structure)},
          {"primary_rays", times_json(c.raytraced.primary_rays)},
          {"picture", one_time_json(c.raytraced.picture_ms)},
          {"lights", std::move(lights)}};
}

std::string result_json(const Comparison& c) {
  return result_json(c, c.report_ms, c.total_ms);
}

}  // namespace gnomon::compare
