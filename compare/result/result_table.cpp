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
    if (i < row.size()) text += csv_field(row[i]);
  }
  return text + "\r\n";
}

/// Returns whether a new column came up.
bool ResultTable::add_row(Named named) {
  const std::size_t before = columns_.size();
  Row row(before);
  for (auto& [column, value] : named) {
    const auto [place, is_new] = places_.try_emplace(column, columns_.size());
    if (is_new) columns_.push_back(column), row.emplace_back();
    row[place->second] = std::move(value);
  }
  rows_.push_back(std::move(row));
  return columns_.size() > before;
}

void ResultTable::add(const Json& result) {
  for (const Json& light : result.at("lights")) {
    Named row;
    add_light(row, result, light);
    add_flat(row, "times_ms", light.at("times_ms"));
    add_flat(row, "times_ms", result.at("times_ms"));
    add_row(std::move(row));
  }
}

std::string ResultTable::add(std::size_t cell, const Json& line, const Json& times) {
  if (!line.is_object() || !line.contains("lights")) return {};
  std::string added;
  bool grew = false;
  std::size_t index = 0;
  for (const Json& light : line.at("lights")) {
    Named row{{"cell", std::to_string(cell)}};
    add_flat(row, "axes", line.value("axes", Json::object()));
    if (line.contains("no_effect")) row.emplace_back("no_effect", joined(line.at("no_effect")));
    for (const char* key : {"derived", "cell_ms", "load"})
      if (times.is_object() && times.contains(key)) row.emplace_back(key, scalar_text(times.at(key)));
    add_light(row, line, light);
    if (times.is_object() && times.contains("lights")) {
      Json own = times.at("lights").at(index), all = times;
      own.erase("light");
      for (const char* key : {"cell", "derived", "cell_ms", "load", "view", "by", "lights", "checksum"})
        all.erase(key);
      add_flat(row, "times_ms", own);
      add_flat(row, "times_ms", all);
    }
    grew = add_row(std::move(row)) || grew;
    added += row_text(rows_.back());
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
  table.add(Json::parse(result, nullptr, false));
  return table.text();
}

std::string result_csv(const Comparison& comparison) {
  return result_csv(result_json(comparison));
}

}  // namespace gnomon::compare
