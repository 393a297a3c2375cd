#include "compare/result/engine_units.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "compare/bias/derived_bias.h"
#include "compare/result/output_parts.h"

namespace gnomon::compare {
namespace {

/// The symbols of docs/engine-units.md.
struct Symbols {
  double b;                 ///< constant of receivers and casters together, world units along the light's ray
  double s;                 ///< slope bias
  double f;                 ///< slope bias of casters
  double n;                 ///< normal offset, texels
  double w;                 ///< a texel's world width
  double near, far;         ///< of the map
  double stored_per_world;  ///< stored depth per world unit of depth, at depth z of a map in perspective
  double ulp;               ///< the depth format's step
  bool parallel, cascades;

  double range() const { return far - near; }
};

Symbols symbols_of(const raster::Bias& bias, double constant_world, const raster::LightRecord& record,
                   const World& world) {
  const LightView& view = record.map.view;
  TexelCoordinate at;
  if (!world.finite_bounds.empty()) at = project_to_texel(view, world.finite_bounds.center());
  const LightFace& face = view.face(at.face);
  return {constant_world + raster::caster_bias_world(bias, view, world),
          bias.slope,
          bias.caster_slope,
          bias.normal_offset_texels,
          record.texel_world,
          face.near_depth,
          face.far_depth,
          stored_per_world(record, at.face, world),
          record.rounding.stored_step,
          view.projection == LightProjection::orthographic,
          view.projection == LightProjection::orthographic && view.face_count > 1};
}

using Units = std::vector<EngineUnit>;

bool has_slope_bias(std::string_view engine) {
  return engine == "Unreal" || engine == "PlayCanvas" || engine == "polygon offset";
}

constexpr const char* no_slope =
    "has no slope bias; the normal offset is its nearest kin, to be tried with --normal-offset";

void add_three(const Symbols& q, LightType light, Units& out) {
  if (light == LightType::spot)
    out.push_back({"three.js", "shadow.bias", -q.b * q.stored_per_world,
                   "-b near far / (z^2 (far - near)), at depth z"});
  else
    out.push_back({"three.js", "shadow.bias", -q.b / q.range(), "-b / (far - near)"});
  out.push_back({"three.js", "shadow.normalBias", q.n * q.w, "n w"});
}

void add_unity(const Symbols& q, LightType light, Units& out) {
  if (light == LightType::directional) {
    out.push_back({"Unity (URP)", "Depth Bias", q.b / q.w, "b / w; with soft shadows over 2.5"});
    out.push_back({"Unity (URP)", "Normal Bias", q.n, "n; with soft shadows over 2.5"});
  } else {
    out.push_back({"Unity (URP)", "Depth Bias", std::nullopt,
                   "b N / (tan(angle / 2) Range), over 2.5 with soft shadows: Range is Unity's own"});
  }
}

void add_unreal(const Symbols& q, LightType light, Units& out) {
  if (light != LightType::directional) {
    out.push_back({"Unreal", "Shadow Bias", std::nullopt,
                   "of point and spot lights it is no length: it depends on the light's radius"});
    return;
  }
  out.push_back(
      {"Unreal", "Shadow Bias", q.b / (5.0 * q.w), "b / (5 w): cascaded maps with r.Shadow.CSMDepthBias 10"});
  if (q.b > 0.0)
    out.push_back({"Unreal", "Shadow Slope Bias", q.s * std::sqrt(0.5) * q.w / (3.0 * q.b),
                   "s w / (3 sqrt(2) b), with r.Shadow.CSMSlopeScaleDepthBias 3; it multiplies Shadow Bias"});
  else
    out.push_back({"Unreal", "Shadow Slope Bias", std::nullopt, "multiplies Shadow Bias, which is 0 here"});
}

void add_godot(const Symbols& q, LightType light, Units& out) {
  if (light == LightType::directional)
    out.push_back({"Godot", "shadow_bias", 100.0 * q.b,
                   "100 b: Forward+, first split, shadow_blur 1; Godot scales the other splits"});
  else
    out.push_back({"Godot", "shadow_bias", std::nullopt,
                   "of omni and spot lights it scales with their range, which is Godot's own"});
  out.push_back({"Godot", "shadow_normal_bias", q.n, "n, of Godot's own texels"});
}

void add_godot3(const Symbols& q, Units& out) {
  if (q.cascades)
    out.push_back({"Godot 3", "shadow_bias", std::nullopt,
                   "of PSSM it scales with the splits: present value x what is advised / what was drawn"});
  else
    out.push_back({"Godot 3", "shadow_bias", q.b, "b"});
}

void add_bevy(const Symbols& q, LightType light, Units& out) {
  out.push_back({"Bevy", "shadow_depth_bias", q.b, "b"});
  const bool directional = light == LightType::directional;
  out.push_back({"Bevy", "shadow_normal_bias", directional ? std::optional(q.n) : std::nullopt,
                 directional ? "n" : "n times the texel that Bevy assumes at distance 1"});
}

void add_babylon(const Symbols& q, LightType light, Units& out) {
  if (light == LightType::spot)
    out.push_back(
        {"Babylon.js", "bias", std::nullopt, "a share of the projected depth, whose scale is its own"});
  else
    out.push_back({"Babylon.js", "bias", q.b / q.range(),
                   light == LightType::directional
                       ? "b / (far - near); with PCF or contact hardening twice that"
                       : "b / (far - near)"});
  out.push_back({"Babylon.js", "normalBias", q.n * q.w, "n w"});
}

void add_playcanvas(const Symbols& q, Units& out) {
  out.push_back(
      {"PlayCanvas", "shadowBias", (q.s + q.f) / 10.0,
       "(s + f) / 10: a polygon offset of factor and units 10 each; it has no constant of its own"});
}

void add_filament(const Symbols& q, Units& out) {
  out.push_back({"Filament", "constantBias", q.b, "b"});
  out.push_back(
      {"Filament", "normalBias", std::nullopt, "multiplies an error that Filament works out itself"});
}

void add_polygon_offset(const Symbols& q, raster::DepthFormat format, Units& out) {
  out.push_back({"polygon offset", "factor", q.s + q.f, "s + f"});
  const bool floats = format == raster::DepthFormat::d32f || format == raster::DepthFormat::d32f_reversed;
  if (format == raster::DepthFormat::d32f_reversed) {
    out.push_back({"polygon offset", "units", std::nullopt,
                   "a step of a float shrinks towards 0, where a reversed map has its far end"});
    return;
  }
  const std::string step = format == raster::DepthFormat::d16 ? "2^-16" : "2^-24";
  const std::string depth = q.parallel ? "b / (far - near)" : "b near far / (z^2 (far - near))";
  out.push_back(
      {"polygon offset", "units", q.b * q.stored_per_world / q.ulp,
       depth + " / " + step + (floats ? ", for stored depths from 1/2 on; nearer ones need more" : "")});
}

}  // namespace

std::vector<EngineUnit> engine_units(const raster::Bias& bias, double constant_world, LightType light,
                                     const raster::LightRecord& record, const World& world) {
  const Symbols q = symbols_of(bias, constant_world, record, world);
  Units out;
  add_three(q, light, out);
  add_unity(q, light, out);
  add_unreal(q, light, out);
  add_godot(q, light, out);
  add_godot3(q, out);
  add_bevy(q, light, out);
  add_babylon(q, light, out);
  add_playcanvas(q, out);
  add_filament(q, out);
  add_polygon_offset(q, record.map.format, out);
  if (bias.slope != 0.0)
    for (const char* engine :
         {"three.js", "Unity (URP)", "Godot", "Godot 3", "Bevy", "Babylon.js", "Filament"})
      out.push_back({engine, "slope", std::nullopt, no_slope});
  for (EngineUnit& unit : out)
    if (unit.value && *unit.value == 0.0) unit.value = 0.0;  // no -0
  return out;
}

std::vector<EngineUnit> engine_units(const Comparison& c, const LightComparison& light) {
  if (!draws_bias(c)) return {};
  const raster::LightRecord& record = drawn_record(c, light);
  return engine_units(c.raster.options.map.bias, record.bias_constant_world, light_of(c, light).type, record,
                      *c.world);
}

std::vector<EngineUnit> derived_units(const DerivedBias& derived, LightType light,
                                      const raster::LightRecord& record, const World& world) {
  raster::Bias sloped, moved;
  sloped.slope = derived.slope, moved.normal_offset_texels = derived.normal_offset_texels;
  const double constant = derived.constant_texels * record.texel_world;
  Units out;
  for (EngineUnit& unit : engine_units(moved, constant, light, record, world))
    if (!has_slope_bias(unit.engine)) out.push_back(std::move(unit));
  for (EngineUnit& unit : engine_units(sloped, constant, light, record, world))
    if (has_slope_bias(unit.engine)) out.push_back(std::move(unit));
  return out;
}

DerivedForEngines derived_for_engines(const Comparison& c, const LightComparison& light) {
  if (!draws_bias(c)) return {};
  const raster::LightRecord& record = drawn_record(c, light);
  DerivedForEngines out{derive_bias(c.raster.options.map, record, *c.world)};
  if (out.derived) out.units = derived_units(*out.derived, light_of(c, light).type, record, *c.world);
  return out;
}

std::vector<std::pair<std::string, std::string>> layer_lines(const DerivedForEngines& bias) {
  std::vector<std::pair<std::string, std::string>> out;
  if (!bias.derived) return out;
  const auto lengths = [](const BiasLayer& layer, double world) {
    return fmt::format("{:.3g} world units, {:.3g} texels, {:.3g} of stored depth", world,
                       world / layer.texel_world, world * layer.stored_per_world);
  };
  for (const BiasLayer& layer : bias.derived->layers)
    out.emplace_back(fmt::format("layer {}", out.size() + 1),
                     fmt::format("constant {}; from the map alone {}", lengths(layer, layer.drawn_world),
                                 lengths(layer, layer.derived_world)));
  return out;
}

std::string settings_text(const std::vector<EngineUnit>& units, std::string_view engine) {
  std::string out;
  for (const EngineUnit& unit : units)
    if (unit.engine == engine && unit.value)
      out += fmt::format("{}{} {:.3g}", out.empty() ? "" : ", ", unit.setting, *unit.value);
  return out;
}

nlohmann::ordered_json derived_bias_json(const DerivedForEngines& bias) {
  const auto& [derived, units] = bias;
  if (!derived) return nullptr;
  const auto lengths = [](const BiasLayer& layer, double world) {
    return nlohmann::ordered_json{
        {"world", world}, {"texels", world / layer.texel_world}, {"stored", world * layer.stored_per_world}};
  };
  auto layers = nlohmann::ordered_json::array();
  for (const BiasLayer& layer : derived->layers)
    layers.push_back({{"texel_world", layer.texel_world},
                      {"drawn", lengths(layer, layer.drawn_world)},
                      {"derived", lengths(layer, layer.derived_world)}});
  return {{"reach_texels", derived->reach_texels},
          {"constant_texels", derived->constant_texels},
          {"slope", derived->slope},
          {"normal_offset_texels", derived->normal_offset_texels},
          {"layers", std::move(layers)},
          {"engine_units", engine_units_json(units)}};
}

nlohmann::ordered_json engine_units_json(const std::vector<EngineUnit>& units) {
  auto list = nlohmann::ordered_json::array();
  for (const EngineUnit& unit : units)
    list.push_back({{"engine", unit.engine},
                    {"setting", unit.setting},
                    {"value", unit.value && std::isfinite(*unit.value) ? nlohmann::ordered_json(*unit.value)
                                                                       : nlohmann::ordered_json()},
                    {"formula", unit.formula}});
  return list;
}

}  // namespace gnomon::compare
