#include "compare/result/result_schema.h"

#include <embedded/result_schema.h>
#include <algorithm>
#include <cmath>
#include <string>

#include "compare/ladder/labels.h"
#include "compare/result/figures.h"
#include "raster/settings.h"

namespace gnomon::compare {
namespace {

using Json = nlohmann::ordered_json;

void add_range(Json& json, double least, double most) {
  if (std::isfinite(least)) json["minimum"] = least;
  if (std::isfinite(most)) json["maximum"] = most;
}

Json figure_schema(const Figure& figure) {
  const std::string type = figure.form() == FigureForm::count ? "integer" : "number";
  const FigurePlace& place = figure.place;
  Json json{{"type", place.nullable ? Json{type, "null"} : Json(type)}, {"description", figure.describes}};
  if (figure.unit == "share")
    add_range(json, std::max(place.least, -1.0), std::isfinite(place.most) ? place.most : 1.0);
  else
    add_range(json, place.least, place.most);
  return json;
}

/// A block of figures that not every light has.
bool is_optional_block(const Json& property) {
  const auto block = property.find("figures");
  if (block == property.end() || !block->is_string()) return false;
  const std::string name = block->get<std::string>();
  const auto is_it = [&](const Figure& figure) { return figure.place.optional && figure.block() == name; };
  return std::any_of(figures().begin(), figures().end(), is_it);
}

/// All properties are required but those that `optional` names and optional blocks of figures. There are no others.
void close(Json& object, const Json& optional) {
  Json required = Json::array();
  for (const auto& [name, property] : object["properties"].items())
    if (std::find(optional.begin(), optional.end(), name) == optional.end() && !is_optional_block(property))
      required.push_back(name);
  object["required"] = std::move(required);
  object["additionalProperties"] = false;
}

void add_figures(Json& object, const std::string& block) {
  Json& properties = object["properties"] = Json::object();
  for (const Figure& figure : figures())
    if (figure.block() == block) properties[std::string(figure.name())] = figure_schema(figure);
}

void add_labels(Json& object) {
  const bool counts = !object.contains("each");
  const Json each = counts ? Json() : object["each"];
  object.erase("each");
  Json& properties = object["properties"] = Json::object();
  for (std::size_t k = 0; k < class_count; ++k) {
    const LabelText& label = label_text(static_cast<Label>(k + 1));
    properties[std::string(label.key)] =
        counts ? Json{{"type", "integer"}, {"minimum", 0}, {"description", label.rule}} : each;
  }
}

/// Another renderer's bias or filter may lie beyond what the option takes, but has no other sign, and a share is one.
Json setting_schema(const raster::MapSetting& setting) {
  Json json;
  std::string_view unit;
  const bool is_own = setting.group == raster::SettingGroup::cascades;
  if (const auto* number = std::get_if<raster::NumberSetting>(&setting.kind)) {
    json["type"] = "number", unit = number->unit;
    if (is_own || number->range.min >= 0.0) json["minimum"] = is_own ? number->range.min : 0.0;
    if (is_own || number->range.max <= 1.0) json["maximum"] = is_own ? number->range.max : 1.0;
  } else if (const auto* integer = std::get_if<raster::IntegerSetting>(&setting.kind)) {
    json["type"] = "integer", json["minimum"] = integer->min, unit = integer->unit;
    if (is_own) json["maximum"] = integer->max;
  } else if (const auto* list = std::get_if<raster::ListSetting>(&setting.kind)) {
    json = {{"type", {"array", "null"}}, {"items", {{"type", "number"}}}}, unit = list->unit;
  } else {
    json["type"] = std::holds_alternative<raster::SwitchSetting>(setting.kind) ? "boolean" : "string";
  }
  json["description"] = std::string(setting.what) + (unit.empty() ? "" : " Unit: " + std::string(unit) + ".");
  return json;
}

/// A filter has those settings alone that its technique reads.
void add_settings(Json& object, raster::SettingGroup group) {
  for (const raster::MapSetting& setting : raster::map_settings()) {
    if (setting.group != group || setting.key.empty() || object["properties"].contains(setting.key)) continue;
    object["properties"][std::string(setting.key)] = setting_schema(setting);
    if (group == raster::SettingGroup::filter) object["optional"].push_back(setting.key);
  }
}

raster::SettingGroup group_of(const std::string& name) {
  using enum raster::SettingGroup;
  return name == "window"   ? window
         : name == "bias"   ? bias
         : name == "filter" ? filter
         : name == "rays"   ? rays
                            : cascades;
}

/// The value of a key that the finished schema does not have; null where the object has none. A property of that name is
/// an object.
Json taken(Json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || found->is_object()) return nullptr;
  Json value = std::move(*found);
  object.erase(found);
  return value;
}

void expand(Json& json) {
  if (json.is_object()) {
    if (const Json block = taken(json, "figures"); block.is_string())
      add_figures(json, block.get<std::string>());
    if (const Json labels = taken(json, "labels"); labels == true) add_labels(json);
    if (const Json group = taken(json, "settings"); group.is_string())
      add_settings(json, group_of(group.get<std::string>()));
    if (const Json names = taken(json, "techniques"); names == true) {
      Json all = Json::array();
      for (const raster::TechniqueTraits& technique : raster::all_technique_traits())
        all.push_back(technique.name);
      all.insert(all.end(), json["enum"].begin(), json["enum"].end());
      json["enum"] = std::move(all);
    }
    if (json.contains("properties")) close(json, taken(json, "optional"));
  }
  if (json.is_structured())
    for (Json& member : json) expand(member);
}

/// A block of figures that result.schema.in.json does not have stands in a light without words.
void add_blocks_without_words(Json& light) {
  for (const Figure& figure : figures()) {
    const std::string block(figure.block());
    if (block.find('.') == std::string::npos && !light.contains(block))
      light[block] = {{"type", "object"}, {"figures", block}};
  }
}

}  // namespace

Json result_schema() {
  Json schema = Json::parse(embedded::result_schema("result.schema.in.json"));
  add_blocks_without_words(schema["$defs"]["light"]["properties"]);
  expand(schema);
  return schema;
}

}  // namespace gnomon::compare
