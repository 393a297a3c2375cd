// A bias in the units that engines ask for (docs/engine-units.md has the formulas and where they come from).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compare/comparison.h"
#include "raster/frame.h"
#include "scene/scene.h"

namespace gnomon::compare {

struct EngineUnit {
  std::string_view engine;      ///< "three.js"
  std::string_view setting;     ///< "shadow.bias"
  std::optional<double> value;  ///< none: it cannot be derived exactly
  std::string formula;  ///< in the symbols of docs/engine-units.md; without a value, why there is none
};

/// What a record's light and map make of a bias (its slope, its normal offset and `constant_world`).
std::vector<EngineUnit> engine_units(const raster::Bias& bias, double constant_world, LightType light,
                                     const raster::LightRecord& record, const World& world);

/// Gives the units of the bias that a light of a comparison was drawn with; none where its technique compares no depths, or
/// a shader of the user's own reads no bias.
std::vector<EngineUnit> engine_units(const Comparison& comparison, const LightComparison& light);

/// [{engine, setting, value, formula}], alike in result.json and in the tuner's answer.
nlohmann::ordered_json engine_units_json(const std::vector<EngineUnit>& units);

}  // namespace gnomon::compare
