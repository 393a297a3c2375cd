// A bias in the units that engines ask for (docs/engine-units.md has the formulas and where they come from).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compare/bias/derived_bias.h"
#include "compare/comparison.h"
#include "compare/result/engines.h"
#include "raster/frame.h"
#include "scene/scene.h"

namespace gnomon::compare {

/// What a record's light and map make of a bias (its slope, its normal offset and `constant_world`).
std::vector<EngineUnit> engine_units(const raster::Bias& bias, double constant_world, LightType light,
                                     const raster::LightRecord& record, const World& world);

/// Gives the units of the bias that a light of a comparison was drawn with; none where its technique compares no depths, or
/// a shader of the user's own reads no bias.
std::vector<EngineUnit> engine_units(const Comparison& comparison, const LightComparison& light);

/// Gives the derived bias in the units of engines: with its slope where an engine has one, else with its normal offset.
std::vector<EngineUnit> derived_units(const DerivedBias& derived, LightType light,
                                      const raster::LightRecord& record, const World& world);

/// What an engine can set for one light of a comparison without measuring; `derived` is none where draws_bias() is false, too.
struct DerivedForEngines {
  std::optional<DerivedBias> derived{};
  std::vector<EngineUnit> units{};
};
DerivedForEngines derived_for_engines(const Comparison& comparison, const LightComparison& light);
/// {reach_texels, constant_texels, slope, normal_offset_texels, layers, engine_units}, or null: alike in result.json and in
/// the tuner's answer.
nlohmann::ordered_json derived_bias_json(const DerivedForEngines& bias);
/// Names and values for a terminal: on each layer the constant drawn with and the derived one, each as length, in texels and
/// as stored depth.
std::vector<std::pair<std::string, std::string>> layer_lines(const DerivedForEngines& bias);

/// [{engine, setting, value, formula}], alike in result.json and in the tuner's answer.
nlohmann::ordered_json engine_units_json(const std::vector<EngineUnit>& units);

}  // namespace gnomon::compare
