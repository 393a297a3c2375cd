// Engine units as JSON: [{engine, setting, value, formula}], alike in result.json and in the tuner's answer.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "compare/result/engine_units.h"

namespace gnomon::compare {

inline nlohmann::ordered_json engine_units_json(const std::vector<EngineUnit>& units) {
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
