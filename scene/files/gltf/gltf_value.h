// Values of a glTF file's JSON tree, with defaults for what is not there or is of another type. Where a mistake matters,
// gltf_parse.cpp has found it before.
#pragma once

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "scene/files/json/json_document.h"

namespace gnomon {

/// A member of an object; nullptr where it is not there.
inline const JsonValue* member(const JsonValue* object, std::string_view key) {
  const JsonMember* found = object == nullptr ? nullptr : object->find(key);
  return found == nullptr ? nullptr : &found->value;
}

/// The items of a list; empty where there is none.
inline const std::vector<JsonValue>& gltf_list(const JsonValue& object, std::string_view key) {
  static const std::vector<JsonValue> none;
  const JsonValue* list = member(&object, key);
  return list == nullptr ? none : list->items;
}

/// The member is there and says something: it is neither null nor an empty object or list.
inline bool has(const JsonValue* object, std::string_view key) {
  const JsonValue* value = member(object, key);
  if (value == nullptr || value->type == JsonValue::Type::null) return false;
  if (value->type == JsonValue::Type::object) return !value->members.empty();
  return value->type != JsonValue::Type::array || !value->items.empty();
}

inline double number_of(const JsonValue* object, std::string_view key, double otherwise) {
  const JsonValue* value = member(object, key);
  return value != nullptr && value->type == JsonValue::Type::number ? value->number : otherwise;
}

/// An index into a list of `count`; -1 where it is none.
inline int index_of(const JsonValue* object, std::string_view key, std::size_t count) {
  const double value = number_of(object, key, -1.0);
  return value >= 0.0 && value < static_cast<double>(count) && std::trunc(value) == value
             ? static_cast<int>(value)
             : -1;
}

/// Reads as many numbers as `otherwise` has.
inline std::vector<double> numbers_of(const JsonValue* object, std::string_view key,
                                      std::vector<double> otherwise) {
  const JsonValue* list = member(object, key);
  if (list == nullptr || list->items.size() != otherwise.size()) return otherwise;
  for (std::size_t i = 0; i < otherwise.size(); ++i)
    if (list->items[i].type == JsonValue::Type::number) otherwise[i] = list->items[i].number;
  return otherwise;
}

inline std::string text_of(const JsonValue* object, std::string_view key) {
  const JsonValue* value = member(object, key);
  return value != nullptr && value->type == JsonValue::Type::string ? value->text : std::string();
}

inline bool flag_of(const JsonValue* object, std::string_view key, bool otherwise) {
  const JsonValue* value = member(object, key);
  return value != nullptr && value->type == JsonValue::Type::boolean ? value->boolean : otherwise;
}

/// What an object's extras say of casting or receiving shadows, as a truth value or, as some programs write these, 0 or 1.
inline bool shadow_flag(const JsonValue& object, std::string_view key) {
  const JsonValue* extras = member(&object, "extras");
  return flag_of(extras, key, true) && number_of(extras, key, 1.0) != 0.0;
}

/// One of the extensions that an object's member of that name holds; nullptr where it is not there or no object.
inline const JsonValue* extension(const JsonValue* extensions, std::string_view name) {
  const JsonValue* found = member(extensions, name);
  return found != nullptr && found->type == JsonValue::Type::object ? found : nullptr;
}

}  // namespace gnomon
