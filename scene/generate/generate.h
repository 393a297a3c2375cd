// Generated geometry: named generators that turn a few parameters into meshes, so that a scene file can say
// "a fence, six metres long" instead of listing triangles. Deterministic: same parameters, same bits.
// Conventions: object space, y up, metres; things that stand have their foot at y = 0 and their middle at x =
// z = 0; solid parts are closed and wound outwards; texture coordinates are in metres unless the generator
// says otherwise.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scene/base/expected.h"
#include "scene/scene.h"

namespace gnomon {

using ParameterValue = std::variant<double, bool, std::string, std::vector<double>>;
using Parameters = std::map<std::string, ParameterValue, std::less<>>;

/// One parameter of a generator. The type is that of the default value.
struct ParameterInfo {
  std::string_view name;
  std::string_view unit;  ///< "m", "degrees", "" for counts and ratios
  ParameterValue default_value;
  double min = -infinity, max = infinity;  ///< of a number, or of every element of a list
  std::string_view description;
  bool whole = false;                           ///< a number (or every element) must be whole
  std::size_t min_size = 0, max_size = 0;       ///< of a list; both 0: the default's size
  std::span<const std::string_view> choices{};  ///< of a string; empty: any
};

struct GeneratorInfo {
  std::string_view kind;
  std::string_view description;  ///< one sentence
  std::span<const ParameterInfo> parameters;
  std::span<const std::string_view> parts;  ///< names of the parts it may make, in the order it makes them
};

struct GeneratedPart {
  std::string name;
  Mesh mesh;
};

struct GeneratedModel {
  std::vector<GeneratedPart> parts;  ///< none of them empty
};

/// Every generator of meshes, sorted by kind; and of textures (they have no parts).
std::span<const GeneratorInfo> generators();
std::span<const GeneratorInfo> texture_generators();

/// Checks names, types and ranges. Errors are bad_input with the parameter's name in Error::field, for the
/// caller to put its own path before; Error::field is "kind" for an unknown kind.
Expected<GeneratedModel> generate(std::string_view kind, const Parameters& parameters);

/// The texture's texels cover texture coordinates [0, 1]; it repeats without a seam. Errors as above.
Expected<Texture> generate_texture(std::string_view kind, const Parameters& parameters);

}  // namespace gnomon
