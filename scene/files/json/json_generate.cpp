#include "scene/files/json/json_generate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scene/files/read_file.h"

namespace gnomon {
namespace {

std::optional<ParameterValue> parameter_value(const JsonNode& node) {
  switch (node.value().type) {
    case JsonValue::Type::number:
      return node.value().number;
    case JsonValue::Type::boolean:
      return node.value().boolean;
    case JsonValue::Type::string:
      return node.value().text;
    case JsonValue::Type::array: {
      std::vector<double> numbers;
      for (const JsonNode& item : node.as_array()) numbers.push_back(item.as_number());
      return numbers;
    }
    default:
      node.wrong("wrong type", "a number, true or false, a string or an array of numbers");
      return std::nullopt;
  }
}

}  // namespace

std::optional<GeneratorCall> read_generator_call(const JsonNode& node) {
  if (!node.is(JsonValue::Type::object)) {
    node.wrong("wrong type", "an object with \"kind\"");
    return std::nullopt;
  }
  GeneratorCall call;
  bool has_kind = false;
  for (const JsonMember& member : node.value().members) {
    const JsonNode value(node.errors(), member.value,
                         fmt::format("{}.{}", node.path(), printable(member.key)));
    if (member.key == "kind") {
      call.kind = value.as_string();
      has_kind = true;
    } else if (const auto parameter = parameter_value(value)) {
      call.parameters.emplace(member.key, *parameter);
    }
  }
  if (!has_kind) node.error("kind is missing");
  if (node.errors().first) return std::nullopt;
  return call;
}

void add_generator_error(const JsonNode& node, const Error& error) {
  const std::string key = error.field.substr(0, error.field.find_first_of("[."));
  const JsonMember* member = node.value().find(key);
  const std::string path = error.field.empty() ? node.path() : fmt::format("{}.{}", node.path(), error.field);
  node.errors().add(member ? member->value.begin : node.value().begin, path, error.reason);
}

std::string list_names(const std::vector<std::string_view>& names) {
  constexpr std::size_t most = 12;
  if (names.size() <= most) return fmt::format("{}", fmt::join(names, ", "));
  return fmt::format("{} and {} more", fmt::join(names.begin(), names.begin() + most, ", "),
                     names.size() - most);
}

}  // namespace gnomon
