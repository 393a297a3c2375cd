// Members of a glTF file's objects, read strictly: each function reports a wrong type, range or index through the node,
// and then gives what says nothing (0, "", -1). Who starts a read asks JsonErrors::first at its end.
#pragma once

#include <fmt/core.h>

#include "scene/files/gltf/gltf_model.h"
#include "scene/files/gltf/gltf_value.h"
#include "scene/files/json/json_reader.h"

namespace gnomon::gltf {

inline constexpr double largest_integer = 9007199254740992.0;  ///< 2^53, as far as JSON numbers are exact
inline constexpr NumberRange size_range{0.0, largest_integer, false, false, true};

/// Something is wrong in the file, here or before.
inline bool failed(const JsonNode& node) {
  return node.errors().first.has_value();
}

inline void check_object(const JsonNode& node) {
  if (!node.is(JsonValue::Type::object)) node.wrong("wrong type", "an object");
}

inline void require(const JsonNode& node, std::string_view key) {
  if (!node.child(key)) node.error(fmt::format("{} is missing", key));
}

/// visit(node) for every object of a list, up to the first mistake.
template <class Visit>
void each(const JsonNode& owner, std::string_view key, const Visit& visit) {
  const auto list = owner.child(key);
  if (!list) return;
  for (const JsonNode& node : list->as_array()) {
    check_object(node);
    if (failed(node)) return;
    visit(node);
  }
}

inline double number(const JsonNode& node, std::string_view key, double otherwise,
                     const NumberRange& range = any_number) {
  const auto child = node.child(key);
  const double value = child ? child->as_number(range) : otherwise;
  return failed(node) ? otherwise : value;
}
inline double required_number(const JsonNode& node, std::string_view key, double otherwise,
                              const NumberRange& range = any_number) {
  require(node, key);
  return number(node, key, otherwise, range);
}
inline double size(const JsonNode& node, std::string_view key) {
  return number(node, key, 0.0, size_range);
}
/// `count` of them; 0: any number.
inline std::vector<double> numbers(const JsonNode& node, std::string_view key, std::size_t count) {
  std::vector<double> out;
  if (const auto list = node.child(key))
    for (const JsonNode& item : list->as_array(count)) out.push_back(item.as_number());
  return out;
}

inline std::string string(const JsonNode& node, std::string_view key) {
  const auto child = node.child(key);
  return child ? child->as_string() : std::string();
}
/// The object of that name; nullptr: there is none.
inline const JsonValue* object(const JsonNode& node, std::string_view key) {
  const auto child = node.child(key);
  if (child) check_object(*child);
  return child ? &child->value() : nullptr;
}

/// An index into a list of `count` items.
inline int as_index(const JsonNode& node, std::size_t count) {
  if (count == 0) node.wrong("refers to a list that is empty or missing", "no index");
  if (failed(node)) return -1;
  const double value = node.as_number({0.0, static_cast<double>(count) - 1.0, false, false, true});
  return failed(node) ? -1 : static_cast<int>(value);
}
inline int index(const JsonNode& node, std::string_view key, std::size_t count) {
  const auto child = node.child(key);
  return child ? as_index(*child, count) : -1;
}
inline int required_index(const JsonNode& node, std::string_view key, std::size_t count) {
  require(node, key);
  return index(node, key, count);
}
inline std::vector<std::size_t> indices(const JsonNode& node, std::string_view key, std::size_t count) {
  std::vector<std::size_t> out;
  if (const auto list = node.child(key))
    for (const JsonNode& item : list->as_array())
      if (const int at = as_index(item, count); at >= 0) out.push_back(static_cast<std::size_t>(at));
  return out;
}

/// Meshes, skins, cameras, lights, nodes and scenes; model.accessors are there already.
void read_nodes(const JsonNode& root, Model& model);

}  // namespace gnomon::gltf
