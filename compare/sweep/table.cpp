#include "compare/sweep/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "compare/csv_field.h"

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

}  // namespace

std::string SweepTable::row_text(const Row& row) const {
  std::string text;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (i > 0) text += ',';
    const auto found =
        std::find_if(row.begin(), row.end(), [&](const auto& entry) { return entry.first == columns_[i]; });
    if (found != row.end()) text += csv_field(found->second);
  }
  return text + "\r\n";
}

bool SweepTable::add_columns(const Row& row) {
  bool grew = false;
  for (const auto& [column, value] : row) {
    if (std::find(columns_.begin(), columns_.end(), column) != columns_.end()) continue;
    columns_.push_back(column);
    grew = true;
  }
  return grew;
}

std::string SweepTable::add(std::size_t cell, std::string_view line) {
  const Json json = Json::parse(line, nullptr, false);
  if (!json.is_object() || !json.contains("lights")) return {};
  std::string added;
  bool grew = false;
  for (const Json& light : json.at("lights")) {
    Row row{{"cell", std::to_string(cell)}};
    add_flat(row, "axes", json.value("axes", Json::object()));
    if (json.contains("no_effect")) row.emplace_back("no_effect", joined(json.at("no_effect")));
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
    grew = add_columns(row) || grew;
    rows_.push_back(row);
    added += row_text(row);
  }
  return grew ? std::string() : added;
}

std::string SweepTable::text() const {
  std::string text;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (i > 0) text += ',';
    text += csv_field(columns_[i]);
  }
  if (!columns_.empty()) text += "\r\n";
  for (const Row& row : rows_) text += row_text(row);
  return text;
}

}  // namespace gnomon::compare
