// result.json: every number of a comparison under the keys of DESIGN.md section 6
// (compare/report/result.schema.json). Conventions: a time is {median, runs[]} in ms, median null when it was
// not timed; fractions and means are over compared pixels; a number that is not finite is written as null,
// which the schema allows only where it has a meaning.
#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "compare/engine_units_json.h"
#include "compare/filter_parameters.h"
#include "compare/judge/judged.h"
#include "compare/option_names.h"
#include "compare/output_parts.h"
#include "compare/outputs.h"
#include "scene/light.h"

namespace gnomon::compare {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json vector3(const Vec3& v) {
  return Json::array({number(v.x), number(v.y), number(v.z)});
}

Json times(const Times& t) {
  Json runs = Json::array();
  for (const double run : t.runs) runs.push_back(number(run));
  return {{"median", t.runs.empty() ? Json(nullptr) : number(t.median())}, {"runs", std::move(runs)}};
}

Json one_time(double ms) {
  return times(Times{{ms}});
}

Json extent_json(std::monostate) {
  return nullptr;
}
Json extent_json(const SunDisc& sun) {
  return {{"shape", "sun"}, {"angular_diameter_degrees", number(sun.angular_diameter * 180.0 / pi)}};
}
Json extent_json(const SphereLight& sphere) {
  return {{"shape", "sphere"}, {"radius", number(sphere.radius)}};
}
Json extent_json(const DiscLight& disc) {
  return {{"shape", "disc"}, {"radius", number(disc.radius)}, {"normal", vector3(disc.normal)}};
}
Json extent_json(const RectangleLight& r) {
  return {
      {"shape", "rectangle"}, {"half_width", vector3(r.half_width)}, {"half_height", vector3(r.half_height)}};
}

Json light_json(const Light& light) {
  Json json{{"name", light.name}, {"type", light_type_name(light.type)}};
  if (light.type != LightType::directional) json["position"] = vector3(light.position);
  if (light.type != LightType::point) json["direction"] = vector3(light.direction);
  if (has_size(light))
    json["extent"] = std::visit([](const auto& e) { return extent_json(e); }, light.extent);
  return json;
}

Json filter_json(const raster::MapOptions& map) {
  Json json{{"kind", filter_kind(map)}, {"radius_texels", filter_reach_texels(map)}};
  for (const auto& [name, value] : filter_parameters(map)) json[name] = value;
  if (json.contains("mipmaps")) json["mipmaps"] = json["mipmaps"] != 0.0;
  return json;
}

Json share_json(std::uint64_t part, std::uint64_t whole) {
  return whole > 0 ? number(static_cast<double>(part) / static_cast<double>(whole)) : Json(nullptr);
}

Json hybrid_json(const raster::ExternalCosts& e) {
  return {{"receivers", e.receivers},
          {"surely_lit", e.surely_lit},
          {"surely_shadowed", e.surely_shadowed},
          {"penumbra", e.penumbra},
          {"rays", e.rays},
          {"all_rays", e.all_rays},
          {"ray_share", share_json(e.rays, e.all_rays)},
          {"triangle_tests", e.triangle_tests},
          {"all_triangle_tests", e.all_triangle_tests},
          {"triangle_test_share", share_json(e.triangle_tests, e.all_triangle_tests)},
          {"silhouette", e.silhouette},
          {"bytes", e.bytes},
          {"times_ms",
           {{"build", times(e.build)}, {"receivers", times(e.receivers_ms)}, {"shadow", times(e.shadow)}}}};
}

// null for a technique without cascades.
Json cascades_json(const raster::MapOptions& map, const LightView& view) {
  if (map.technique != raster::Technique::csm) return nullptr;
  Json faces = Json::array();
  for (int i = 0; i < view.face_count; ++i) {
    const LightFace& face = view.face(i);
    faces.push_back({{"texel_world", number(texel_world_size(view, i, 1.0))},
                     {"near", number(face.near_depth)},
                     {"far", number(face.far_depth)}});
  }
  return {{"count", map.cascades.count},
          {"lambda", number(map.cascades.lambda)},
          {"snap", map.cascades.snap && !map.cascades.fit_samples},
          {"fit_samples", map.cascades.fit_samples},
          {"faces", std::move(faces)}};
}

std::string_view bias_unit_name(raster::BiasUnit unit) {
  switch (unit) {
    case raster::BiasUnit::world:
      return "world";
    case raster::BiasUnit::texel:
      return "texel";
    case raster::BiasUnit::automatic:
      break;
  }
  return "auto";
}

// A shader of the user's own that reads no bias draws without: null, and nothing but zeros.
Json bias_json(const Comparison& c, const LightComparison& light) {
  const raster::LightRecord& record = drawn_record(c, light);
  const raster::MapOptions& map = c.raster.options.map;
  const bool drawn = draws_bias(c) || !compares_depths(map.technique);
  const raster::Bias bias = drawn ? map.bias : raster::Bias{};
  const auto if_drawn = [drawn](double value) { return drawn ? number(value) : Json(nullptr); };
  return {{"constant_world", if_drawn(record.bias_constant_world)},
          {"constant_texels", if_drawn(record.bias_constant_world / record.texel_world)},
          {"unit", bias_unit_name(map.bias.unit)},
          {"texel_world", number(record.texel_world)},
          {"scales_with_texel", raster::scales_bias(map)},
          {"slope", number(bias.slope)},
          {"normal_offset_texels", number(bias.normal_offset_texels)},
          {"receiver_plane", bias.receiver_plane},
          {"receiver_plane_slack_world", bias.receiver_plane ? number(record.rounding_world) : Json(nullptr)},
          {"adaptive", bias.adaptive},
          {"adaptive_epsilon_world",
           bias.adaptive ? number(record.rounding.adaptive_epsilon_world) : Json(nullptr)}};
}

// null where the program's own shaders drew.
Json custom_shader_json(const raster::RasterFrame& drawn) {
  if (!drawn.custom_shader) return nullptr;
  return {{"files", drawn.custom_shader->files}, {"reads_bias", drawn.custom_shader->reads_bias}};
}

Json map_json(const Comparison& c, const LightComparison& light) {
  const raster::LightRecord& record = drawn_record(c, light);
  const raster::MapOptions& map = c.raster.options.map;
  const bool known = !lacks_map(c);
  Json json{{"technique", drawn_technique(c)},
            {"size", known ? Json(record.map.view.size) : Json(nullptr)},
            {"faces", record.map.view.face_count},
            {"depth_format", depth_format_name(record.map.format)},
            {"cull", cull_name(map.cull)},
            {"bias", bias_json(c, light)},
            {"custom_shader", custom_shader_json(c.raster)},
            {"cascades", cascades_json(map, record.map.view)},
            {"warp", number(record.map.view.face(0).warp * record.map.view.face(0).half_extent.y)},
            {"filter", filter_json(map)},
            {"texel_world",
             {{"min", number(light.texel_world[0])},
              {"median", number(light.texel_world[1])},
              {"max", number(light.texel_world[2])}}}};
  if (record.external) json["hybrid"] = hybrid_json(*record.external);
  return json;
}

Json pixels_json(const PixelCounts& p) {
  return {{"total", p.total},
          {"background", p.background},
          {"facing_away", p.facing_away},
          {"silhouette", p.silhouette},
          {"uncertain", p.uncertain},
          {"uncertain_by_samples", p.uncertain_by_samples},
          {"compared", p.compared}};
}

Json error_json(const ErrorStats& e) {
  return {{"wrong", e.wrong},
          {"wrong_fraction", number(e.wrong_fraction)},
          {"false_shadow", e.false_shadow},
          {"missed_shadow", e.missed_shadow},
          {"ties", e.ties},
          {"fractional", e.fractional},
          {"mean_absolute", number(e.mean_absolute)},
          {"rms", number(e.rms)},
          {"flip", number(e.flip)},
          {"ssim", number(e.ssim)},
          {"flip_compared", number(e.flip_compared)},
          {"ssim_compared", number(e.ssim_compared)}};
}

Json budget_json(const Comparison& c, const LightComparison& light) {
  Json json = Json::array();
  for (std::size_t k = 0; k < known_steps(c); ++k)
    json.push_back({{"cause", step_name(c, static_cast<Cause>(k))},
                    {"signed", number(light.budget[k].signed_mean)},
                    {"absolute", number(light.budget[k].absolute_mean)},
                    {"darkened", number(light.budget[k].darkened())},
                    {"lightened", number(light.budget[k].lightened())},
                    {"false_shadow", light.budget[k].false_shadow},
                    {"missed_shadow", light.budget[k].missed_shadow}});
  return json;
}

Json ladder_json(const LightComparison& light) {
  constexpr std::array<const char*, rung_count> names{"truth",  "point",  "texel", "flat",
                                                      "stored", "biased", "drawn"};
  const auto means = light.rung_mean;
  Json json = Json::array();
  for (std::size_t k = 0; k < rung_count; ++k)
    json.push_back({{"rung", names[k]}, {"mean", number(means[k])}});
  return json;
}

Json classes_json(const LightComparison& light) {
  Json json = Json::object();
  for (std::size_t k = 0; k < class_count; ++k)
    json[std::string(label_name(static_cast<Label>(k + 1)))] = light.classes[k];
  return json;
}

Json bleeding_json(const LightComparison& light) {
  const double filter = light.budget[static_cast<std::size_t>(Cause::filter)].absolute_mean;
  const BleedingStats& b = light.bleeding;
  return {{"pixels", b.pixels},
          {"mean", number(b.mean)},
          {"max", number(b.max)},
          {"share_of_filter", number(filter > 0.0 ? b.mean / filter : 0.0)}};
}

Json penumbra_json(const PenumbraStats& p) {
  return {{"edges", p.edges},
          {"true_penumbra_world", number(p.true_penumbra_world)},
          {"drawn_penumbra_world", number(p.drawn_penumbra_world)},
          {"umbra_edges", p.umbra_edges},
          {"true_umbra_world", number(p.true_umbra_world)},
          {"drawn_umbra_world", number(p.drawn_umbra_world)},
          {"true_umbra_pixels", p.true_umbra_pixels},
          {"true_penumbra_pixels", p.true_penumbra_pixels},
          {"drawn_umbra_pixels", p.drawn_umbra_pixels},
          {"drawn_penumbra_pixels", p.drawn_penumbra_pixels},
          {"standard_error_mean", number(p.standard_error_mean)},
          {"standard_error_max", number(p.standard_error_max)}};
}

Json bias_curve_json(const LightComparison& light) {
  Json json = Json::array();
  for (const BiasCurvePoint& p : light.bias_curve)
    json.push_back({{"bias", number(p.bias)},
                    {"bias_texels", number(p.bias / light.bias_texel_world)},
                    {"false_shadow", p.false_shadow},
                    {"missed_shadow", p.missed_shadow}});
  return json;
}

Json best_bias_json(const LightComparison& light) {
  const BestBias& b = light.best_bias;
  return {{"constant_world", number(b.constant_world)},
          {"constant_texels", number(b.constant_world / light.bias_texel_world)},
          {"wrong_fraction", number(b.wrong_fraction)},
          {"feasible", b.feasible},
          {"needs_more_than", number(b.needs_more_than)},
          {"needs_less_than", number(b.needs_less_than)},
          {"lit_pixels_above", b.lit_pixels_above},
          {"shadowed_pixels_below", b.shadowed_pixels_below}};
}

Json bias_kinds_json(const LightComparison& light) {
  Json json = Json::array();
  for (const BiasKind& kind : light.bias_kinds)
    json.push_back({{"kind", kind.name},
                    {"options", bias_arguments(kind.bias)},
                    {"wrong_fraction", number(kind.wrong_fraction)},
                    {"range_of", kind.of_slope ? "slope" : "constant_world"},
                    {"from", number(kind.from)},
                    {"to", number(kind.to)}});
  return json;
}

Json distribution_json(const Distribution& d) {
  return {{"count", d.count},
          {"median", number(d.median)},
          {"p90", number(d.p90)},
          {"p99", number(d.p99)},
          {"max", number(d.max)}};
}

Json theory_json(const TheoryStats& t) {
  return {{"acne_free_bias", distribution_json(t.acne_free_bias)},
          {"aliasing", distribution_json(t.aliasing)},
          {"perspective", distribution_json(t.perspective)},
          {"projection", distribution_json(t.projection)},
          {"measured_aliasing", distribution_json(t.measured_aliasing)}};
}

// null where no receiver has a texel.
Json in_texels(double world, const LightComparison& light) {
  const double texel = light.texel_world[1];
  return texel > 0.0 ? number(world / texel) : Json(nullptr);
}

Json light_block(const Comparison& c, const LightComparison& light) {
  const raster::LightRecord& drawn = drawn_record(c, light);
  const raytrace::LightTruth& truth = true_record(c, light);
  Json block{{"light", light_json(light_of(c, light))},
             {"map", map_json(c, light)},
             {"pixels", pixels_json(light.pixels)},
             {"error", error_json(light.error)},
             {"budget", budget_json(c, light)},
             {"ladder", ladder_json(light)},
             {"classes", classes_json(light)},
             {"right_by_accident", {{"shadowed", light.accidents.shadowed}, {"lit", light.accidents.lit}}},
             {"edges",
              {{"count", light.edges.edges},
               {"mean_texels", number(light.edges.mean_texels)},
               {"rms_texels", number(light.edges.rms_texels)},
               {"rms_pixels", number(light.edges.rms_pixels)},
               {"mean_absolute_texels", number(light.edges.mean_absolute_texels)},
               {"mean_world", number(light.edges.mean_world)},
               {"mean_absolute_world", number(light.edges.mean_absolute_world)},
               {"rms_world", number(light.edges.rms_world)}}},
             {"detachment",
              {{"pixels", light.detachment.pixels},
               {"mean_world", number(light.detachment.mean_world)},
               {"max_world", number(light.detachment.max_world)},
               {"rms_world", number(light.detachment.rms_world)},
               {"mean_texels", in_texels(light.detachment.mean_world, light)},
               {"max_texels", in_texels(light.detachment.max_world, light)}}},
             {"bias_curve", bias_curve_json(light)},
             {"best_bias", best_bias_json(light)},
             {"bias_kinds", bias_kinds_json(light)},
             {"engine_units", engine_units_json(engine_units(c, light))},
             {"theory", theory_json(light.theory)},
             {"shadow_rays", truth.rays},
             {"times_ms",
              {{"map_pass", times(drawn.map_pass)},
               {"shade_pass", times(drawn.shade_pass)},
               {"shadow_rays", times(truth.shadow_rays)},
               {"exact_shadows", times(truth.exact_times())},
               {"classify", times(light.classify)}}}};
  if (raster::uses_moments(c.raster.options.map.technique)) block["bleeding"] = bleeding_json(light);
  if (light.penumbra) block["penumbra"] = penumbra_json(*light.penumbra);
  if (truth.is_soft()) {
    block["shadow_samples"] = truth.samples;
    block["soft_shadow_rays"] = truth.soft_rays;
    block["soft_shadow_rays_asked"] = truth.soft_rays_asked;
    block["times_ms"]["soft_shadow_rays"] = times(truth.soft_shadow_rays);
  }
  return block;
}

Json effects_json(const EffectPlan& plan) {
  Json json = Json::array();
  for (const EffectEntry& e : plan.entries)
    json.push_back({{"effect", effect_name(e.effect)},
                    {"called_for", e.called_for},
                    {"simulated", e.simulated},
                    {"reason", e.reason}});
  return json;
}

Json scene_json(const World& world) {
  const Scene& scene = *world.scene;
  return {{"path", scene.path},
          {"sha256", scene.sha256},
          {"triangles", world.triangle_count()},
          {"shapes", world.shapes.size()},
          {"name", scene.name},
          {"notes", scene.notes}};
}

// The user's files that were compiled in place of the program's own.
Json shaders_json(const std::vector<raster::ReplacedShader>& replaced) {
  Json json = Json::array();
  for (const raster::ReplacedShader& shader : replaced)
    json.push_back({{"replaced", shader.name}, {"sha256", shader.sha256}});
  return json;
}

Json costs_json(const Comparison& c) {
  const raytrace::RayCounts& rays = c.raytraced.rays;
  return {{"map_texels", c.raster.map_texels},    {"map_bytes", c.raster.map_bytes},
          {"primary_rays", rays.primary},         {"shadow_rays", rays.shadow},
          {"soft_shadow_rays", rays.soft_shadow}, {"soft_shadow_rays_asked", rays.soft_shadow_asked},
          {"reflection_rays", rays.reflection},   {"refraction_rays", rays.refraction},
          {"glossy_rays", rays.glossy},           {"indirect_rays", rays.indirect}};
}

// What --fail-above was held against; absent where nothing was asked for.
void add_threshold(const Comparison& c, Json& json) {
  if (!c.fail_above) return;
  const auto fails = [&c](const LightComparison& light) {
    const ErrorFigures figures = figures_of(light);
    return exceeds(*c.fail_above, figures) || too_uncertain(*c.fail_above, figures);
  };
  json["fail_above"] = {{"threshold", threshold_text(*c.fail_above)},
                        {"measure", measure_name(c.fail_above->measure)},
                        {"limit", number(c.fail_above->limit)},
                        {"failed", std::any_of(c.lights.begin(), c.lights.end(), fails)}};
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

// Of a picture that another renderer drew.
Json judged_json(const Judged& j) {
  Json settings = Json::object(), mended = Json::array(), advice = Json::array();
  for (const auto& [key, value] : j.settings) settings[key] = value;
  for (const Mended& m : j.mended)
    mended.push_back({{"what", m.what},
                      {"evidence", m.evidence},
                      {"before", number(m.before)},
                      {"after", number(m.after)}});
  for (const Advice& a : j.advice)
    advice.push_back({{"setting", a.setting},
                      {"now", number(a.now)},
                      {"instead", number(a.instead)},
                      {"unit", a.unit},
                      {"wrong_now", number(a.wrong_now)},
                      {"wrong_instead", number(a.wrong_instead)},
                      {"feasible", a.feasible}});
  return {{"capture", j.capture},
          {"renderer", {{"name", j.renderer}, {"version", j.version}, {"settings", std::move(settings)}}},
          {"map", j.has_map},
          {"positions", j.has_positions},
          {"ratio", j.of_ratio},
          {"agreement", agreement_json(j.agreement)},
          {"mended", std::move(mended)},
          {"biased_is_drawn", j.has_map ? number(j.biased_is_drawn) : Json(nullptr)},
          {"unit_world", j.has_map ? number(j.unit_world) : Json(nullptr)},
          {"identified", j.identified ? identified_json(*j.identified) : Json(nullptr)},
          {"advice", std::move(advice)},
          {"notes", j.notes}};
}

Json result_object(const Comparison& c, double report_ms, double total_ms) {
  Json lights = Json::array();
  for (const LightComparison& light : c.lights) lights.push_back(light_block(c, light));
  return {{"schema", "gnomon/result/1"},
          {"command", c.command},
          {"version", program_version()},
          {"seed", c.seed},
          {"threads", c.threads},
          {"size", {{"width", c.raster.options.size.width}, {"height", c.raster.options.size.height}}},
          {"exposure", number(c.exposure)},
          {"scene", scene_json(*c.world)},
          {"machine", {{"cpu", c.machine.cpu}, {"cores", c.machine.cores}, {"os", c.machine.os}}},
          {"gl",
           {{"backend", c.raster.context.backend},
            {"version", c.raster.context.version},
            {"renderer", c.raster.context.renderer}}},
          {"shaders", shaders_json(c.raster.replaced_shaders)},
          {"effects", effects_json(c.plan)},
          {"precision", raytrace::precision_name(c.precision)},
          {"costs", costs_json(c)},
          {"times_ms",
           {{"load", one_time(c.load_ms)},
            {"accel_build", one_time(c.accel_build_ms)},
            {"primary_rays", times(c.raytraced.primary_rays)},
            {"picture", one_time(c.raytraced.picture_ms)},
            {"report", one_time(report_ms)},
            {"total", one_time(total_ms)}}},
          {"lights", std::move(lights)}};
}

// Every time inside becomes "not timed".
void drop_times(Json& json) {
  for (auto& [key, member] : json.items()) {
    if (key != "times_ms") {
      if (member.is_structured()) drop_times(member);
      continue;
    }
    for (auto& time : member) time = times({});
  }
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

// Names come from files and may hold bytes that are not UTF-8: those are replaced, not refused.
std::string dumped(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string result_json(const Comparison& c, double report_ms, double total_ms) {
  Json json = result_object(c, report_ms, total_ms);
  if (c.judged) json["judged"] = judged_json(*c.judged);
  add_threshold(c, json);
  return dumped(json, 2);
}

std::string result_line(const Comparison& c, const AxisValues& axes,
                        const std::vector<std::string>& no_effect) {
  Json json = result_object(c, 0.0, 0.0);
  drop_times(json);
  if (c.judged) json["judged"] = judged_json(*c.judged);
  json["axes"] = axes_object(axes);
  if (!no_effect.empty()) json["no_effect"] = no_effect;
  return dumped(json, -1);
}

std::string axes_text(const AxisValues& axes) {
  return axes_object(axes).dump();
}

std::string times_line(const Comparison& c, std::size_t cell, bool derived, double cell_ms) {
  Json lights = Json::array();
  for (const LightComparison& light : c.lights)
    lights.push_back({{"light", light_of(c, light).name},
                      {"map_pass", times(drawn_record(c, light).map_pass)},
                      {"shade_pass", times(drawn_record(c, light).shade_pass)},
                      {"shadow_rays", times(true_record(c, light).shadow_rays)},
                      {"exact_shadows", times(true_record(c, light).exact_times())},
                      {"classify", times(light.classify)}});
  return dumped({{"cell", cell},
                 {"derived", derived},
                 {"cell_ms", number(cell_ms)},
                 {"primary_rays", times(c.raytraced.primary_rays)},
                 {"picture", one_time(c.raytraced.picture_ms)},
                 {"lights", std::move(lights)}},
                -1);
}

std::string result_json(const Comparison& c) {
  return result_json(c, c.report_ms, c.total_ms);
}

}  // namespace gnomon::compare
