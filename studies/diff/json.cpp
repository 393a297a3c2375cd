#include <cmath>
#include <nlohmann/json.hpp>

#include "compare/ladder/labels.h"
#include "compare/result/result_parts.h"
#include "studies/diff/diff.h"

namespace gnomon::studies {
namespace {

using compare::number;
using Json = nlohmann::ordered_json;

Json figure_json(const FigureChange& change) {
  return {{"key", change.figure->key},       {"unit", change.figure->unit},
          {"before", number(change.before)}, {"after", number(change.after)},
          {"spread", number(change.spread)}, {"trend", trend_name(change.trend)}};
}

Json time_json(const TimeChange& change) {
  const auto side = [](const std::array<double, 3>& ms) {
    return Json{{"median", ms[0]}, {"low", ms[1]}, {"high", ms[2]}};
  };
  return {{"key", "times_ms.shadows." + change.key},
          {"before", side(change.before)},
          {"after", side(change.after)},
          {"trend", trend_name(change.trend)}};
}

Json label_json(const LabelChange& change, bool has_pixels) {
  const auto counted = [&](std::uint64_t pixels) { return has_pixels ? Json(pixels) : Json(nullptr); };
  return {{"label", compare::label_text(change.label).key},
          {"before", change.before},
          {"after", change.after},
          {"fixed", counted(change.fixed)},
          {"new", counted(change.newly_wrong)},
          {"same", counted(change.still)}};
}

Json light_json(const LightDiff& light) {
  Json json{{"light", light.name}, {"trend", trend_name(light.trend)}};
  json["too_much"] = light.too_much.empty() ? Json(nullptr) : Json(light.too_much);
  json["chances"] = light.chances;
  for (const char* list : {"figures", "times", "labels"}) json[list] = Json::array();
  for (const FigureChange& change : light.figures) json["figures"].push_back(figure_json(change));
  for (const TimeChange& change : light.times) json["times"].push_back(time_json(change));
  for (const LabelChange& change : light.labels)
    json["labels"].push_back(label_json(change, light.pixels.has_value()));
  json["pixels"] = nullptr;
  if (const auto& pixels = light.pixels)
    json["pixels"] = {{"fixed", pixels->fixed},
                      {"new", pixels->newly_wrong},
                      {"same", pixels->still},
                      {"uncounted", pixels->uncounted}};
  return json;
}

}  // namespace

std::string diff_json(const Diff& diff) {
  const auto side = [&](std::size_t i) {
    return Json{{"path", diff.paths[i]}, {"command", diff.commands[i]}, {"version", diff.versions[i]}};
  };
  Json json{{"schema", "gnomon/diff/1"}, {"scene", diff.scene}, {"before", side(0)}, {"after", side(1)}};
  json["trend"] = trend_name(diff.trend);
  json["fail_worse"] = diff.fail_worse ? Json(compare::threshold_text(*diff.fail_worse)) : Json(nullptr);
  json["too_much"] = diff.too_much();
  json["notes"] = diff.notes;
  json["changed"] = Json::array();
  for (const ChangedSetting& setting : diff.changed)
    json["changed"].push_back({{"key", setting.key}, {"before", setting.before}, {"after", setting.after}});
  json["lights"] = Json::array();
  for (const LightDiff& light : diff.lights) json["lights"].push_back(light_json(light));
  return visible_order(json.dump(2, ' ', false, Json::error_handler_t::replace)) + "\n";
}

}  // namespace gnomon::studies
