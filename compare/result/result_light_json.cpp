// One light's block of result.json. Conventions: result_json.cpp.
#include <algorithm>
#include <array>

#include "compare/ladder/filter_probe.h"
#include "compare/ladder/labels.h"
#include "compare/result/engine_units.h"
#include "compare/result/estimate.h"
#include "compare/result/judged.h"
#include "compare/result/map_words.h"
#include "compare/result/option_names.h"
#include "compare/result/output_parts.h"
#include "compare/result/result_parts.h"
#include "compare/result/shadow_cost.h"
#include "raster/technique_traits.h"
#include "scene/files/json/light_json.h"
#include "scene/light_map/light_view.h"

namespace gnomon::compare {
namespace {

Json light_json(const Light& light) {
  Json json = light_place_json(light);
  if (!has_size(light)) return json;
  json["extent"] = {{"shape", shape_name(light.extent)}};
  json["extent"].update(shape_measures_json(light.extent, AngleForm::degrees));
  return json;
}

/// null where nothing is given.
Json list_json(const NumberList& values) {
  if (values.empty()) return nullptr;
  Json json = Json::array();
  for (const double value : values) json.push_back(number(value));
  return json;
}

/// The setting by its key, where it has one.
void add_setting(Json& json, const raster::MapSetting& setting, const raster::MapOptions& map) {
  if (setting.key.empty()) return;
  Json& value = json[std::string(setting.key)];
  if (const auto* n = std::get_if<raster::NumberSetting>(&setting.kind))
    value = number(n->get(map));
  else if (const auto* i = std::get_if<raster::IntegerSetting>(&setting.kind))
    value = i->get(map);
  else if (const auto* s = std::get_if<raster::SwitchSetting>(&setting.kind))
    value = s->get(map);
  else if (const auto* l = std::get_if<raster::ListSetting>(&setting.kind))
    value = list_json(l->get(map));
  else
    value = raster::setting_text(setting, map);
}

Json filter_json(const raster::RasterFrame& drawn) {
  const raster::MapOptions& map = drawn.options.map;
  Json json{{"kind", shown_filter_kind(drawn)}, {"radius_texels", filter_reach_texels(map)}};
  for (const raster::MapSetting* setting : filter_settings(drawn)) add_setting(json, *setting, map);
  if (const auto& foreign = drawn.lights.front().foreign)
    for (const auto& one : foreign->numbers) json[one.key] = number(one.value);
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
           {{"build", times_json(e.build)},
            {"receivers", times_json(e.receivers_ms)},
            {"shadow", times_json(e.shadow)}}}};
}

Json rays_json(const raster::MapOptions& map, const raster::ExternalCosts& e) {
  Json json = Json::object();
  for (const raster::MapSetting& setting : raster::map_settings())
    if (setting.group == raster::SettingGroup::rays) add_setting(json, setting, map);
  json.update({{"receivers", e.receivers},
               {"rays", e.rays},
               {"boxes_per_ray", number(e.boxes_per_ray)},
               {"primitives_per_ray", number(e.primitives_per_ray)},
               {"taps", e.taps},
               {"history_bytes", e.bytes},
               {"silhouette", e.silhouette},
               {"times_ms",
                {{"receivers", times_json(e.receivers_ms)},
                 {"rays", times_json(e.shadow)},
                 {"denoiser", times_json(e.denoise)}}}});
  return json;
}

// null for a technique without cascades.
Json cascades_json(const raster::MapOptions& map, const LightView& view) {
  if (!raster::has_cascades(map.technique)) return nullptr;
  Json faces = Json::array();
  for (int i = 0; i < view.face_count; ++i) {
    const LightFace& face = view.face(i);
    faces.push_back({{"texel_world", number(texel_world_size(view, i, 1.0))},
                     {"near", number(face.near_depth)},
                     {"far", number(face.far_depth)}});
  }
  Json json = Json::object();
  for (const raster::MapSetting& setting : raster::map_settings())
    if (setting.group == raster::SettingGroup::cascades)
      add_setting(json, setting, raster::effective_options(map));
  json["faces"] = std::move(faces);
  return json;
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

// Exact techniques, and a shader of the user's own that reads no bias, draw without: null, and nothing but zeros.
Json bias_json(const Comparison& c, const LightComparison& light) {
  const raster::LightRecord& record = drawn_record(c, light);
  const raster::MapOptions& map = c.raster.options.map;
  const bool drawn = draws_bias(c);
  raster::MapOptions given = map;
  if (!drawn) given.bias = raster::Bias{};
  const auto if_drawn = [drawn](double value) { return drawn ? number(value) : Json(nullptr); };
  Json json{{"constant_world", if_drawn(record.bias_constant_world)},
            {"constant_texels", if_drawn(record.bias_constant_world / light.bias_texel_world)},
            {"unit", bias_unit_name(map.bias.unit)},
            {"caster_constant_world", drawn ? number(record.caster_constant_world) : Json(0.0)},
            {"texel_world", number(light.bias_texel_world)},
            {"scales_with_texel", raster::scales_bias(map)}};
  for (const raster::MapSetting& setting : raster::map_settings()) {
    if (setting.group != raster::SettingGroup::bias) continue;
    add_setting(json, setting, given);
    if (setting.name == "receiver-plane")
      json["receiver_plane_slack_world"] =
          given.bias.receiver_plane ? number(record.rounding_world) : Json(nullptr);
  }
  json["adaptive_epsilon_world"] =
      given.bias.adaptive ? number(record.rounding.adaptive_epsilon_world) : Json(nullptr);
  return json;
}

// null where the program's own shaders drew.
Json custom_shader_json(const raster::RasterFrame& drawn) {
  if (!drawn.custom_shader) return nullptr;
  return {{"files", drawn.custom_shader->files}, {"reads_bias", drawn.custom_shader->reads_bias}};
}

// null where cascades, a warp or a cube have their own, or the map is not known.
Json window_json(const Comparison& c, const LightComparison& light) {
  const LightView& view = drawn_record(c, light).map.view;
  const LightFace& face = view.face(0);
  const raster::MapOptions& map = c.raster.options.map;
  if (!c.raster.has_map() || view.face_count > 1 || face.warp != 0.0) return nullptr;
  const bool parallel = view.projection == LightProjection::orthographic;
  Json json{{"width", parallel ? number(2.0 * face.half_extent.x) : Json(nullptr)},
            {"height", parallel ? number(2.0 * face.half_extent.y) : Json(nullptr)},
            {"near", number(face.near_depth)},
            {"far", number(face.far_depth)},
            {"origin", vector3(face_origin(view, face))},
            {"forward", vector3(face.forward)},
            {"up", vector3(face.up)}};
  Json given = Json::object();
  for (const raster::MapSetting& setting : raster::map_settings())
    if (setting.group == raster::SettingGroup::window) add_setting(given, setting, map);
  json["given"] = std::move(given);
  json["casters"] = nullptr;
  if (map.window.empty() || c.world == nullptr || !parallel) return json;
  const WindowCasters casters = window_casters(*c.world, view);
  json["casters"] = {{"count", casters.count()}, {"inside", casters.inside}, {"cut", casters.cut},
                     {"beside", casters.beside}, {"before", casters.before}, {"beyond", casters.beyond}};
  return json;
}

Json map_json(const Comparison& c, const LightComparison& light) {
  const raster::LightRecord& record = drawn_record(c, light);
  const raster::MapOptions& map = c.raster.options.map;
  const bool known = c.raster.has_map();
  Json json{
      {"technique", drawn_technique(c)},
      {"size", known ? Json(record.map.view.size) : Json(nullptr)},
      {"inferred", c.judged && c.judged->identified.has_value()},
      {"faces", raster::samples_rays(map.technique) ? Json(nullptr) : Json(record.map.view.face_count)},
      {"depth_format", record.foreign || !known ? Json(nullptr) : Json(depth_format_name(record.map.format))},
      {"stores", known ? Json(record.foreign ? stored_text(record) : "depths") : Json(nullptr)},
      {"cull", cull_name(map.cull)},
      {"bias", bias_json(c, light)},
      {"custom_shader", custom_shader_json(c.raster)},
      {"snap", map.snap},
      {"window", window_json(c, light)},
      {"cascades", cascades_json(map, record.map.view)},
      {"warp", number(record.map.view.face(0).warp * record.map.view.face(0).half_extent.y)},
      {"filter", filter_json(c.raster)},
      {"texel_world", block_json("map.texel_world", light)}};
  if (record.external && raster::samples_rays(map.technique))
    json["rays"] = rays_json(map, *record.external);
  else if (record.external)
    json["hybrid"] = hybrid_json(*record.external);
  return json;
}

Json estimate_json(const Comparison& c, const LightComparison& light) {
  const auto sides = [&](bool map_is_drawn) {
    const EstimatedSides ms = estimated_sides(c, light, map_is_drawn);
    return Json{{"map_ms", number(ms.map)}, {"rays_ms", number(ms.rays)}};
  };
  return {{"rates", c.rates->name}, {"nothing_moves", sides(false)}, {"light_moves", sides(true)}};
}

Json subpixel_json(const SubpixelFigures& of) {
  return {{"places", of.places},
          {"pixels", of.pixels},
          {"mean_absolute", number(of.mean_absolute)},
          {"wrong_fraction", number(of.wrong_fraction)},
          {"unknown", number(of.unknown)}};
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

Json ladder_json(const Comparison& c, const LightComparison& light) {
  const Ladder ladder = ladder_of(c.raster.options.map.technique);
  const auto means = light.rung_mean;
  Json json = Json::array();
  for (std::size_t k = 0; k < rung_count; ++k)
    json.push_back({{"rung", rung_text(static_cast<Rung>(k), ladder).name}, {"mean", number(means[k])}});
  return json;
}

Json classes_json(const LightComparison& light) {
  Json json = Json::object();
  for (std::size_t k = 0; k < class_count; ++k)
    json[std::string(label_name(static_cast<Label>(k + 1)))] = light.classes[k];
  return json;
}

Json class_errors_json(const LightComparison& light) {
  Json json = Json::object();
  for (std::size_t k = 0; k < class_count; ++k)
    json[std::string(label_name(static_cast<Label>(k + 1)))] = number(light.class_errors[k]);
  return json;
}

Json bias_curve_json(const LightComparison& light) {
  Json json = Json::array();
  for (const BiasCurvePoint& p : light.bias_curve)
    json.push_back({{"bias", number(p.bias)},
                    {"bias_texels", number(p.bias / light.bias_texel_world)},
                    {"false_shadow", p.false_shadow},
                    {"missed_shadow", p.missed_shadow},
                    {"wrong_fraction", number(p.wrong_fraction)}});
  return json;
}

Json best_bias_json(const LightComparison& light) {
  if (!light.bias_curve_withheld.empty()) {
    Json nothing = Json::object();
    for (const char* key :
         {"constant_world", "constant_texels", "wrong_fraction", "feasible", "needs_more_than",
          "needs_less_than", "lit_pixels_above", "shadowed_pixels_below"})
      nothing[key] = nullptr;
    return nothing;
  }
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

Json bias_kinds_json(const LightComparison& light, const raster::MapOptions& drawn) {
  Json json = Json::array();
  for (const BiasKind& kind : light.bias_kinds)
    json.push_back({{"kind", kind.name},
                    {"options", bias_arguments(kind.bias, drawn)},
                    {"wrong_fraction", number(kind.wrong_fraction)},
                    {"range_of", kind.of_slope ? "slope" : "constant_world"},
                    {"from", number(kind.from)},
                    {"to", number(kind.to)}});
  return json;
}

Json other_sizes_json(const LightComparison& light) {
  Json json = Json::array();
  for (const OtherMapSize& other : light.other_sizes)
    json.push_back({{"size", other.size},
                    {"mean_absolute", number(other.mean_absolute)},
                    {"standard_error", number(other.standard_error)}});
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

}  // namespace

Json light_times_json(const Comparison& c, const LightComparison& light) {
  const raster::LightRecord& drawn = drawn_record(c, light);
  const raytrace::LightTruth& truth = true_record(c, light);
  Json json{{"map_pass", times_json(drawn.map_pass)},
            {"first_map", !drawn.map_pass.runs.empty() && drawn.first_map_ms > 0.0
                              ? one_time_json(drawn.first_map_ms)
                              : times_json({})},
            {"shade_pass", times_json(drawn.shade_pass)},
            {"unshadowed_pass", times_json(drawn.unshadowed_pass)},
            {"shadow_lookups", difference_json(shadow_lookups(drawn))},
            {"shadow_rays", times_json(truth.shadow_rays)},
            {"light_structure", times_json(truth.light_structure)},
            {"exact_shadows", times_json(truth.exact_times())},
            {"exact_shadows_standing", times_json(standing_rays(truth))},
            {"id_map", times_json({})},  // nothing is drawn for it any more
            {"classify", times_json(light.classify)}};
  if (truth.is_soft()) json["soft_shadow_rays"] = times_json(truth.soft_shadow_rays);
  json["shading_strips"] = strips_json(drawn.strips);
  LightFigures figures;
  figures.shadow_costs = shadow_costs(shadow_parts(c, light));
  if (figures.shadow_costs) json["shadows"] = block_json("times_ms.shadows", figures);
  return json;
}

namespace {

Json figure_json(const Figure& figure, const LightFigures& light) {
  const double value = figure.of(light);
  const bool is_count = figure.form() == FigureForm::count && std::isfinite(value);
  return is_count ? Json(static_cast<std::uint64_t>(value)) : number(value);
}

}  // namespace

Json block_json(std::string_view block, const LightFigures& light) {
  Json json = Json::object();
  for (const Figure& figure : figures())
    if (figure.block() == block) json[std::string(figure.name())] = figure_json(figure, light);
  return json;
}

/// The blocks of figures that lie in no other object. One that not every light has is there where it was made.
void add_blocks(Json& json, const LightFigures& light) {
  for (const Figure& figure : figures()) {
    const std::string block(figure.block());
    const bool lies_elsewhere = block.find('.') != std::string::npos;
    if (lies_elsewhere || json.contains(block) || (figure.place.optional && std::isnan(figure.of(light))))
      continue;
    json[block] = block_json(block, light);
  }
}

Json named_figures(const LightFigures& light, bool (*takes)(const Figure&)) {
  Json json = Json::object();
  for (const Figure& figure : figures())
    if (takes(figure)) json[std::string(figure.name())] = figure_json(figure, light);
  return json;
}

LightFigures read_pooled_figures(const Json& light) {
  LightFigures out;
  for (const Figure& figure : figures()) {
    const std::string block(figure.block());
    if (figure.pooling.kind == Pooling::Kind::none || (figure.place.optional && !light.contains(block)))
      continue;
    const Json& value = light.at(block).at(std::string(figure.name()));
    const bool known = value.is_number() || figure.form() == FigureForm::count;
    figure.place.set(out, known ? value.get<double>() : std::numeric_limits<double>::quiet_NaN());
  }
  return out;
}

Json light_block(const Comparison& c, const LightComparison& light, bool full) {
  const raytrace::LightTruth& truth = true_record(c, light);
  Json block{{"light", light_json(light_of(c, light))}, {"map", map_json(c, light)}};
  add_blocks(block, light);
  block.update({{"budget", budget_json(c, light)},
                {"ladder", ladder_json(c, light)},
                {"classes", classes_json(light)},
                {"class_errors", class_errors_json(light)}});
  if (full) block["bias_curve"] = bias_curve_json(light);
  block.update({{"bias_curve_withheld",
                 light.bias_curve_withheld.empty() ? Json(nullptr) : Json(light.bias_curve_withheld)},
                {"best_bias", best_bias_json(light)},
                {"bias_kinds", bias_kinds_json(light, c.raster.options.map)},
                {"other_map_sizes", other_sizes_json(light)}});
  if (full) block["engine_units"] = engine_units_json(engine_units(c, light));
  block["derived_bias"] = derived_bias_json(derived_for_engines(c, light));
  if (!full && block["derived_bias"].is_object()) block["derived_bias"].erase("engine_units");
  block.update({{"theory", theory_json(light.theory)},
                {"shadow_rays", truth.rays},
                {"times_ms", light_times_json(c, light)}});
  if (truth.is_soft()) {
    block["shadow_samples"] = truth.samples;
    block["soft_shadow_rays"] = truth.soft_rays;
    block["soft_shadow_rays_asked"] = truth.soft_rays_asked;
  }
  if (light.subpixel) block["subpixel"] = subpixel_json(*light.subpixel);
  if (c.rates) block["estimate"] = estimate_json(c, light);
  return block;
}

}  // namespace gnomon::compare
