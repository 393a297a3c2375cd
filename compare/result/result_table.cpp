#include "compare/result/result_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "compare/result/output_parts.h"
#include "compare/result/outputs.h"
#include "compare/result/text_layout.h"

namespace gnomon::compare {
namespace {

using Json = nlohmann::ordered_json;

std::string scalar_text(const Json& value) {
  if (value.is_null()) return {};
  return value.is_string() ? csv_name(value.get<std::string>()) : value.dump();
}

std::string joined(const Json& names) {
  std::string text;
  for (const Json& name : names) {
    if (!text.empty()) text += ' ';
    text += name.get<std::string>();
  }
  return text;
}

/// A result without what only captures have, which no column is made of and which may be long.
Json parsed(std::string_view result) {
  const auto keep = [](int, Json::parse_event_t event, const Json& value) {
    return event != Json::parse_event_t::key || value != "judged";
  };
  return Json::parse(result, keep, false);
}

template <class Row>
void add_flat(Row& row, const std::string& name, const Json& value) {
  if (value.is_object()) {
    for (const auto& [key, member] : value.items())
      add_flat(row, name.empty() ? key : fmt::format("{}_{}", name, key), member);
  } else if (!value.is_array()) {
    row.emplace_back(name, scalar_text(value));
  }
}

// Lists of named entries: the name becomes part of the column.
template <class Row>
void add_named(Row& row, const std::string& name, const Json& list, const char* key) {
  for (const Json& entry : list) {
    Json rest = entry;
    rest.erase(key);
    add_flat(row, name + "_" + entry.at(key).get<std::string>(), rest);
  }
}

// What stands in both tables of one light: its setting and its numbers.
template <class Row>
void add_light(Row& row, const Json& json, const Json& light) {
  if (json.contains("scene"))
    row.emplace_back("scene_name", csv_name(json.at("scene").value("name", std::string())));
  row.emplace_back("light", csv_name(light.at("light").at("name").get<std::string>()));
  row.emplace_back("light_type", light.at("light").at("type").get<std::string>());
  add_flat(row, "size", json.at("size"));
  for (const auto& [key, member] : light.items()) {
    if (key == "budget")
      add_named(row, "budget", member, "cause");
    else if (key == "ladder")
      add_named(row, "ladder", member, "rung");
    else if (key != "light" && key != "times_ms")
      add_flat(row, key, member);
  }
  add_flat(row, "costs", json.at("costs"));
}

}  // namespace

std::string ResultTable::row_text(const Row& row) const {
  std::string text;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (i > 0) text += ',';
    const auto found =
        std::find_if(row.begin(), row.end(), [&](const auto& entry) { return entry.first == columns_[i]; });
    if (found != row.end()) text += csv_field(found->second);
  }
  return text + "\r\n";
}

bool ResultTable::add_columns(const Row& row) {
  bool grew = false;
  for (const auto& [column, value] : row) {
    if (std::find(columns_.begin(), columns_.end(), column) != columns_.end()) continue;
    columns_.push_back(column);
    grew = true;
  }
  return grew;
}

void ResultTable::add(std::string_view result) {
  const Json json = parsed(result);
  for (const Json& light : json.at("lights")) {
    Row row;
    add_light(row, json, light);
    add_flat(row, "times_ms", light.at("times_ms"));
    add_flat(row, "times_ms", json.at("times_ms"));
    add_columns(row);
    rows_.push_back(std::move(row));
  }
}

std::string ResultTable::add(std::size_t cell, std::string_view line, std::string_view times) {
  const Json json = parsed(line), timed = Json::parse(times, nullptr, false);
  if (!json.is_object() || !json.contains("lights")) return {};
  std::string added;
  bool grew = false;
  std::size_t index = 0;
  for (const Json& light : json.at("lights")) {
    Row row{{"cell", std::to_string(cell)}};
    add_flat(row, "axes", json.value("axes", Json::object()));
    if (json.contains("no_effect")) row.emplace_back("no_effect", joined(json.at("no_effect")));
    for (const char* key : {"derived", "cell_ms"})
      if (timed.is_object() && timed.contains(key)) row.emplace_back(key, scalar_text(timed.at(key)));
    add_light(row, json, light);
    if (timed.is_object() && timed.contains("lights")) {
      Json own = timed.at("lights").at(index), all = timed;
      own.erase("light");
      for (const char* key : {"cell", "derived", "cell_ms", "lights", "checksum"}) all.erase(key);
      add_flat(row, "times_ms", own);
      add_flat(row, "times_ms", all);
    }
    grew = add_columns(row) || grew;
    added += row_text(row);
    rows_.push_back(std::move(row));
    ++index;
  }
  return grew ? std::string() : added;
}

std::string ResultTable::text() const {
  std::string text;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (i > 0) text += ',';
    text += csv_field(columns_[i]);
  }
  if (!columns_.empty()) text += "\r\n";
  for (const Row& row : rows_) text += row_text(row);
  return text;
}

std::string result_csv(std::string_view result) {
  ResultTable table;
  table.add(result);
  return table.text();
}

std::string result_csv(const Comparison& comparison) {
  return result_csv(result_json(comparison));
}

}  // namespace gnomon::compare
