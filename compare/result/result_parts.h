// Pieces of result.json that its top and the blocks of its lights share.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

#include "compare/comparison.h"
#include "compare/ladder/budget.h"
#include "compare/result/figures.h"
#include "scene/base/expected.h"
#include "scene/base/time_difference.h"

namespace gnomon::compare {

using Json = nlohmann::ordered_json;

/// null where it is not finite.
inline Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

/// {median, runs[]}; the median of no runs is null.
inline Json times_json(const Times& t) {
  Json runs = Json::array();
  for (const double run : t.runs) runs.push_back(number(run));
  return {{"median", t.runs.empty() ? Json(nullptr) : number(t.median())}, {"runs", std::move(runs)}};
}

/// {median, low, high, runs[]}; the first three of no runs are null.
inline Json difference_json(const TimeDifference& d) {
  const auto known = [&d](double ms) { return d.timed() ? number(ms) : Json(nullptr); };
  Json json = times_json(d.pairs);
  json["median"] = known(d.median), json["low"] = known(d.low), json["high"] = known(d.high);
  return json;
}

inline Json one_time_json(double ms) {
  return times_json(Times{{ms}});
}

inline Json vector3(const Vec3& v) {
  return Json::array({number(v.x), number(v.y), number(v.z)});
}

/// The runs of each strip, pass by pass.
inline Json strips_json(const std::vector<TimedStrip>& strips) {
  Json json = Json::array();
  for (const TimedStrip& strip : strips)
    json.push_back({{"shade_pass", strip.whole.runs}, {"unshadowed_pass", strip.part.runs}});
  return json;
}

inline Json load_json(const MachineInfo& machine) {
  return machine.load ? number(*machine.load) : Json(nullptr);
}

Json scene_json(const World& world);
Json machine_json(const MachineInfo& machine);
Json context_json(const raster::ContextInfo& context);
/// The user's files that were compiled in place of the program's own.
Json shaders_json(const std::vector<raster::ReplacedShader>& replaced);

/// Names come from files and may hold anything. Bytes that are not UTF-8 are replaced, what would steer a terminal that shows the
/// file is escaped.
inline std::string dumped(const Json& json, int indent) {
  return plain_lines(json.dump(indent, ' ', false, Json::error_handler_t::replace)) + "\n";
}

/// The figures of a block ("error", "map.texel_world") by their names.
Json block_json(std::string_view block, const LightFigures& light);
/// The figures that the function takes, whatever their block, by their names: {"wrong_fraction": 0.04, ...}.
Json named_figures(const LightFigures& light, bool (*takes)(const Figure&));
/// Every figure that is pooled over lights, from an entry of "lights". Throws Json::exception where one is missing.
LightFigures read_pooled_figures(const Json& light);

/// One entry of "lights".
Json light_block(const Comparison& comparison, const LightComparison& light, bool full = true);
/// The budget of each cascade by itself, finest first; null of other techniques.
Json by_cascade_json(const std::vector<CascadeFigures>& cascades);
/// Its "times_ms".
Json light_times_json(const Comparison& comparison, const LightComparison& light);

}  // namespace gnomon::compare
