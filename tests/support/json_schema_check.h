// Checks JSON against the part of JSON Schema (draft 2020-12) that the project's schemas use. A keyword that
// it does not know is itself an error, so that nothing in a schema is silently not checked.
#pragma once

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

namespace gnomon {

class SchemaCheck {
 public:
  explicit SchemaCheck(nlohmann::json schema) : root_(std::move(schema)) {}

  /// One line per violation, "path: what"; empty when the value fits.
  std::vector<std::string> violations(const nlohmann::json& value) {
    found_.clear();
    check(root_, value, "$");
    return found_;
  }

 private:
  using Json = nlohmann::json;

  void report(const std::string& path, const std::string& what) { found_.push_back(path + ": " + what); }

  static bool has_type(const Json& value, const std::string& type) {
    if (type == "object") return value.is_object();
    if (type == "array") return value.is_array();
    if (type == "string") return value.is_string();
    if (type == "boolean") return value.is_boolean();
    if (type == "null") return value.is_null();
    if (type == "integer")
      return value.is_number_integer() ||
             (value.is_number() && std::floor(value.get<double>()) == value.get<double>());
    return type == "number" && value.is_number();
  }

  void check_type(const Json& type, const Json& value, const std::string& path) {
    bool fits = false;
    for (const Json& t : type.is_array() ? type : Json::array({type}))
      fits = fits || has_type(value, t.get<std::string>());
    if (!fits) report(path, "is " + std::string(value.type_name()) + ", wanted " + type.dump());
  }

  void check_object(const Json& schema, const Json& value, const std::string& path) {
    for (const Json& key : schema.value("required", Json::array()))
      if (!value.contains(key.get<std::string>())) report(path, "lacks " + key.dump());
    const Json properties = schema.value("properties", Json::object());
    for (const auto& [key, member] : value.items()) {
      if (properties.contains(key))
        check(properties[key], member, std::string(path).append(".").append(key));
      else if (const Json others = schema.value("additionalProperties", Json(true)); others.is_object())
        check(others, member, std::string(path).append(".").append(key));
      else if (!others.get<bool>())
        report(path, "has the unknown key " + key);
    }
  }

  void check_array(const Json& schema, const Json& value, const std::string& path) {
    if (value.size() < schema.value("minItems", std::size_t{0})) report(path, "has too few items");
    if (value.size() > schema.value("maxItems", std::size_t(-1))) report(path, "has too many items");
    for (std::size_t i = 0; schema.contains("items") && i < value.size(); ++i)
      check(schema["items"], value[i], path + "[" + std::to_string(i) + "]");
  }

  bool fits(const Json& schema, const Json& value) const {
    SchemaCheck alone(root_);
    alone.check(schema, value, "$");
    return alone.found_.empty();
  }

  void check_combined(const std::string& keyword, const Json& rule, const Json& value,
                      const std::string& path) {
    if (keyword == "not") {
      if (fits(rule, value)) report(path, "fits what it must not: " + rule.dump());
      return;
    }
    const auto count =
        std::count_if(rule.begin(), rule.end(), [&](const Json& one) { return fits(one, value); });
    const bool right = keyword == "allOf"   ? count == static_cast<std::ptrdiff_t>(rule.size())
                       : keyword == "anyOf" ? count > 0
                                            : count == 1;
    if (!right) report(path, "fits " + std::to_string(count) + " of " + keyword + " " + rule.dump());
  }

  void check(const Json& schema, const Json& value, const std::string& path) {
    for (const auto& [keyword, rule] : schema.items()) {
      if (keyword == "type")
        check_type(rule, value, path);
      else if (keyword == "const") {
        if (value != rule) report(path, "is not " + rule.dump());
      } else if (keyword == "enum") {
        if (std::find(rule.begin(), rule.end(), value) == rule.end())
          report(path, value.dump() + " is none of " + rule.dump());
      } else if (keyword == "minimum") {
        if (value.is_number() && value < rule) report(path, value.dump() + " is below " + rule.dump());
      } else if (keyword == "maximum") {
        if (value.is_number() && value > rule) report(path, value.dump() + " is above " + rule.dump());
      } else if (keyword == "exclusiveMinimum") {
        if (value.is_number() && value <= rule) report(path, value.dump() + " is not above " + rule.dump());
      } else if (keyword == "minLength") {
        if (value.is_string() && value.get<std::string>().size() < rule.get<std::size_t>())
          report(path, "is too short");
      } else if (keyword == "pattern") {
        if (value.is_string() &&
            !std::regex_search(value.get<std::string>(), std::regex(rule.get<std::string>())))
          report(path, "does not match " + rule.dump());
      } else if (keyword == "$ref")
        check(root_.at(Json::json_pointer(rule.get<std::string>().substr(1))), value, path);
      else if (keyword == "allOf" || keyword == "anyOf" || keyword == "oneOf" || keyword == "not")
        check_combined(keyword, rule, value, path);
      else if (!known(keyword))
        report(path, "the schema's keyword " + keyword + " is not checked here");
    }
    if (value.is_object()) check_object(schema, value, path);
    if (value.is_array()) check_array(schema, value, path);
  }

  // Keywords without a rule of their own, or that check_object and check_array look at.
  static bool known(const std::string& keyword) {
    for (const char* k : {"$schema", "$id", "$defs", "title", "description", "properties", "required",
                          "additionalProperties", "items", "minItems", "maxItems"})
      if (keyword == k) return true;
    return false;
  }

  Json root_;
  std::vector<std::string> found_;
};

}  // namespace gnomon
