#include "compare/result/engine_units.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "compare/bias/derived_bias.h"
#include "compare/result/output_parts.h"

namespace gnomon::compare {
namespace {

BiasSymbols symbols_of(const raster::Bias& bias, double constant_world, const raster::LightRecord& record,
                       const World& world) {
  const LightView& view = record.map.view;
  TexelCoordinate at;
  if (!world.finite_bounds.empty()) at = project_to_texel(view, world.finite_bounds.center());
  const LightFace& face = view.face(at.face);
  BiasSymbols q;
  q.b = constant_world + raster::caster_bias_world(bias, view, world);
  q.s = bias.slope, q.f = bias.caster_slope, q.n = bias.normal_offset_texels;
  q.w = record.texel_world;
  if (at.depth > 0.0) q.z = at.depth;
  q.near = face.near_depth, q.far = face.far_depth;
  q.stored_per_world = stored_per_world(record, at.face, world);
  q.ulp = record.rounding.stored_step, q.format = record.map.format;
  q.parallel = view.projection == LightProjection::orthographic;
  q.cascades = q.parallel && view.face_count > 1;
  return q;
}

using Units = std::vector<EngineUnit>;

constexpr const char* no_slope =
    "has no slope bias; the normal offset is its nearest kin, to be tried with --normal-offset";

bool has_slope(std::string_view engine) {
  return std::ranges::any_of(known_engines(), [&](const TunedEngine& known) {
    return known.name == engine && known.has(BiasPart::slope);
  });
}

}  // namespace

std::vector<EngineUnit> engine_units(const raster::Bias& bias, double constant_world, LightType light,
                                     const raster::LightRecord& record, const World& world) {
  const BiasSymbols q = symbols_of(bias, constant_world, record, world);
  Units out;
  for (const TunedEngine& engine : known_engines()) engine.add_units(q, light, out);
  for (const TunedEngine& engine : known_engines())
    if (bias.slope != 0.0 && !engine.has(BiasPart::slope))
      out.push_back({engine.name, "slope", std::nullopt, no_slope, BiasPart::slope});
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
    if (!has_slope(unit.engine)) out.push_back(std::move(unit));
  for (EngineUnit& unit : engine_units(sloped, constant, light, record, world))
    if (has_slope(unit.engine)) out.push_back(std::move(unit));
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
    return fmt::format("{}, {}, {:.3g} of stored depth",
                       with_noun(fmt::format("{:.3g}", world), "world unit"),
                       texels_text(world / layer.texel_world, 3), world * layer.stored_per_world);
  };
  for (const BiasLayer& layer : bias.derived->layers)
    out.emplace_back(fmt::format("layer {}", out.size() + 1),
                     fmt::format("constant {}; from the map alone {}", lengths(layer, layer.drawn_world),
                                 lengths(layer, layer.derived_world)));
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
