// Typed reading of a JSON tree. The first thing that is wrong is kept in JsonErrors and everything after it
// reads as a default, so that the code that reads a scene is straight; who starts a read asks `errors.first`
// at its end.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/files/json/json_document.h"
#include "scene/files/validate.h"
#include "scene/math.h"

namespace gnomon {

/// Collects the first error of a document.
/// A word that people write for a key, in lower case without underscores, and what says it in this format.
struct KeyMeaning {
  std::string_view word, said_by;
};

struct JsonErrors {
  const JsonDocument& document;
  std::optional<Error> first{};
  std::span<const KeyMeaning> meanings{};  ///< of unknown keys that resemble no known one

  void add(std::size_t offset, const std::string& field, std::string reason);
};

/// What a number may be, for checks and for messages.
struct NumberRange {
  double min = -infinity, max = infinity;
  bool min_open = false, max_open = false;  ///< the end itself is not allowed
  bool whole = false;

  bool contains(double value) const;
  std::string text() const;  ///< "a number > 0", "a whole number in [0, 64]"
};
inline constexpr NumberRange any_number{};
inline constexpr NumberRange positive_number{0.0, infinity, true};
inline constexpr NumberRange non_negative_number{0.0, infinity};
inline constexpr NumberRange unit_interval{0.0, 1.0};
inline constexpr NumberRange coordinate_range{-max_coordinate, max_coordinate};
inline constexpr NumberRange radiance_range{0.0, max_radiance};

/// "; did you mean "x"?" or "".
std::string suggestion(std::string_view word, const std::vector<std::string_view>& candidates);

class JsonObject;

/// A value and its path, for example materials[2].ior. Every as_ function reports a wrong type or range.
class JsonNode {
 public:
  JsonNode(JsonErrors& errors, const JsonValue& value, std::string path)
      : errors_(&errors), value_(&value), path_(std::move(path)) {}
  const JsonValue& value() const { return *value_; }
  const std::string& path() const { return path_; }
  JsonErrors& errors() const { return *errors_; }
  bool is(JsonValue::Type type) const { return value_->type == type; }
  void error(std::string reason) const { errors_->add(value_->begin, path_, std::move(reason)); }
  /// "what (got X, allowed Y)"
  void wrong(std::string_view what, std::string_view allowed) const;

  /// The member of an object; none if it is not there.
  std::optional<JsonNode> child(std::string_view key) const;
  double as_number(const NumberRange& range = any_number) const;
  bool as_boolean() const;
  std::string as_string() const;
  /// The index of the string among the choices.
  std::size_t as_choice(const std::vector<std::string_view>& choices) const;
  Vec2 as_vec2() const;
  Vec3 as_vec3() const;
  /// One number for both or all components, or a vector.
  Vec2 as_scale2() const;
  Vec3 as_scale3() const;
  /// A unit vector; a zero one is an error.
  Vec3 as_direction() const;
  /// A number, [r, g, b] or "#rrggbb"; each component within the range.
  Vec3f as_color(const NumberRange& range = radiance_range) const;
  /// Items of an array; with a size other than 0, exactly that many.
  std::vector<JsonNode> as_array(std::size_t size = 0) const;

 private:
  bool components(double* out, std::size_t count) const;

  JsonErrors* errors_;
  const JsonValue* value_;
  std::string path_;
};

/// An object and the keys that it may have; others are reported at once, before any key is missed.
class JsonObject {
 public:
  JsonObject(const JsonNode& node, std::vector<std::string_view> known_keys);
  const JsonNode& node() const { return node_; }
  std::optional<JsonNode> find(std::string_view key) const;
  /// Reports a missing key.
  std::optional<JsonNode> require(std::string_view key) const;
  /// Reports the key if it is there: "does not apply to a point light".
  void forbid(std::string_view key, std::string_view why) const;
  /// The only one of the keys that is there; none or several is an error (and gives "").
  std::string_view exactly_one(const std::vector<std::string_view>& keys) const;
  bool has(std::string_view key) const { return node_.value().find(key) != nullptr; }
  double number(std::string_view key, double otherwise, const NumberRange& range = any_number) const;
  bool boolean(std::string_view key, bool otherwise) const;
  std::string string(std::string_view key, std::string otherwise = {}) const;
  Vec3f color(std::string_view key, const Vec3f& otherwise, const NumberRange& range = radiance_range) const;

 private:
  JsonNode node_;
  std::vector<std::string_view> keys_;
};

}  // namespace gnomon
