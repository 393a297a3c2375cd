// "generate": { "kind": ..., parameters } of a JSON scene, handed to the generators
// (scene/generate/generate.h), which check names, types and ranges; here their complaints get the position of
// the parameter they are about.
#pragma once

#include "scene/files/json/json_reader.h"
#include "scene/generate/generate.h"

namespace gnomon {

struct GeneratorCall {
  std::string kind;
  Parameters parameters;
};

/// None, and an error, when the object is not one.
std::optional<GeneratorCall> read_generator_call(const JsonNode& node);
void add_generator_error(const JsonNode& node, const Error& error);

/// None, and an error at the parameter, when the generator refuses.
template <class Result>
std::optional<Result> generate_from_json(const JsonNode& node,
                                         Expected<Result> (*generator)(std::string_view, const Parameters&)) {
  const auto call = read_generator_call(node);
  if (!call) return std::nullopt;
  auto result = generator(call->kind, call->parameters);
  if (result) return std::move(*result);
  add_generator_error(node, result.error());
  return std::nullopt;
}

/// A list of names for a message, cut when it is long.
std::string list_names(const std::vector<std::string_view>& names);

}  // namespace gnomon
