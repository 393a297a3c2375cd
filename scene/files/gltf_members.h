// Members of a glTF file's objects, read strictly: each reader reports a wrong type, range or index through the node, and
// then returns what says nothing (0, "", -1). Who starts a read asks JsonErrors::first at its end.
#pragma once

#include <fmt/core.h>

#include "scene/files/gltf_model.h"
#include "scene/files/gltf_value.h"
#include "scene/files/json_reader.h"

namespace gnomon::gltf {

inline constexpr double largest_integer = 9007199254740992.0;  ///< 2^53, as far as JSON numbers are exact
inline constexpr NumberRange size_range{0.0, largest_integer, false, false, true};

class Members {
 public:
  explicit Members(const JsonNode& root) : root_(root) {}

  const JsonNode& root() const { return root_; }
  bool failed() const { return root_.errors().first.has_value(); }

  /// The number of items in a list at the root.
  std::size_t count(std::string_view list) const { return gltf_list(root_.value(), list).size(); }
  const JsonValue& item(std::string_view list, std::size_t at) const {
    return gltf_list(root_.value(), list)[at];
  }

  static void check_object(const JsonNode& node) {
    if (!node.is(JsonValue::Type::object)) node.wrong("wrong type", "an object");
  }
  /// visit(node) for every object of a list, up to the first mistake.
  template <class Visit>
  void each(const JsonNode& owner, std::string_view key, const Visit& visit) const {
    const auto list = owner.child(key);
    if (!list) return;
    for (const JsonNode& node : list->as_array()) {
      check_object(node);
      if (failed()) return;
      visit(node);
    }
  }

  double number(const JsonNode& node, std::string_view key, double otherwise,
                const NumberRange& range = any_number) const {
    const auto child = node.child(key);
    const double value = child ? child->as_number(range) : otherwise;
    return failed() ? otherwise : value;
  }
  double required_number(const JsonNode& node, std::string_view key, double otherwise,
                         const NumberRange& range = any_number) const {
    if (!node.child(key)) node.error(fmt::format("{} is missing", key));
    return number(node, key, otherwise, range);
  }
  std::size_t size(const JsonNode& node, std::string_view key) const {
    return static_cast<std::size_t>(number(node, key, 0.0, size_range));
  }
  /// `count` of them; 0: any number.
  static std::vector<double> numbers(const JsonNode& node, std::string_view key, std::size_t count) {
    std::vector<double> out;
    if (const auto list = node.child(key))
      for (const JsonNode& item : list->as_array(count)) out.push_back(item.as_number());
    return out;
  }

  static std::string string(const JsonNode& node, std::string_view key) {
    const auto child = node.child(key);
    return child ? child->as_string() : std::string();
  }
  /// The object of that name; nullptr: there is none.
  static const JsonValue* object(const JsonNode& node, std::string_view key) {
    const auto child = node.child(key);
    if (child) check_object(*child);
    return child ? &child->value() : nullptr;
  }

  int index_of(const JsonNode& node, std::size_t count) const {
    if (count == 0) node.wrong("refers to a list that is empty or missing", "no index");
    if (failed()) return -1;
    const double value = node.as_number({0.0, static_cast<double>(count) - 1.0, false, false, true});
    return failed() ? -1 : static_cast<int>(value);
  }
  /// An index into a list of `count` items.
  int index(const JsonNode& node, std::string_view key, std::size_t count) const {
    const auto child = node.child(key);
    return child ? index_of(*child, count) : -1;
  }
  int required_index(const JsonNode& node, std::string_view key, std::size_t count) const {
    if (!node.child(key)) node.error(fmt::format("{} is missing", key));
    return index(node, key, count);
  }
  std::vector<std::size_t> indices(const JsonNode& node, std::string_view key, std::size_t count) const {
    std::vector<std::size_t> out;
    if (const auto list = node.child(key))
      for (const JsonNode& item : list->as_array())
        if (const int at = index_of(item, count); at >= 0) out.push_back(static_cast<std::size_t>(at));
    return out;
  }

 private:
  JsonNode root_;
};

/// Meshes, skins, cameras, lights, nodes and scenes; model.accessors are there already.
void read_nodes(const Members& members, Model& model);

}  // namespace gnomon::gltf
