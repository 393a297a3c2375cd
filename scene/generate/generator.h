// What a generator looks like to the registry, and how it reads its checked parameters.
// Private to scene/generate: everybody else uses generate.h.
#pragma once

#include <vector>

#include "scene/generate/generate.h"

namespace gnomon {

/// Parameters after checking: every one of the generator's is present, of its type and in range.
class Values {
 public:
  explicit Values(Parameters all) : all_(std::move(all)) {}
  double number(std::string_view name) const { return std::get<double>(at(name)); }
  int count(std::string_view name) const { return static_cast<int>(number(name)); }
  std::uint64_t seed() const { return static_cast<std::uint64_t>(number("seed")); }
  bool flag(std::string_view name) const { return std::get<bool>(at(name)); }
  const std::string& text(std::string_view name) const { return std::get<std::string>(at(name)); }
  const std::vector<double>& list(std::string_view name) const {
    return std::get<std::vector<double>>(at(name));
  }
  Vec2 vec2(std::string_view name) const { return {list(name)[0], list(name)[1]}; }
  Vec3 vec3(std::string_view name) const { return {list(name)[0], list(name)[1], list(name)[2]}; }
  Vec3f color(std::string_view name) const { return Vec3f(vec3(name)); }

 private:
  const ParameterValue& at(std::string_view name) const { return all_.find(name)->second; }
  Parameters all_;
};

/// A failure that only several parameters together show; `parameter` names the one to change.
inline tl::unexpected<Error> fail_parameter(std::string_view parameter, std::string reason) {
  Error error{ErrorKind::bad_input, std::move(reason)};
  error.field = parameter;
  return fail(std::move(error));
}

struct MeshGenerator {
  GeneratorInfo info;
  Expected<GeneratedModel> (*build)(const Values&);
};

struct TextureGenerator {
  GeneratorInfo info;
  Expected<Texture> (*build)(const Values&);
};

// One list per file.
std::span<const MeshGenerator> basic_generators();
std::span<const MeshGenerator> fence_generators();
std::span<const MeshGenerator> garden_generators();
std::span<const MeshGenerator> plant_generators();
std::span<const MeshGenerator> architecture_generators();
std::span<const MeshGenerator> stonework_generators();
std::span<const MeshGenerator> swarm_generators();
std::span<const MeshGenerator> teapot_generators();
std::span<const TextureGenerator> all_texture_generators();

// The parameters that many generators share.
ParameterInfo length_parameter(std::string_view name, double value, double min, double max,
                               std::string_view text);
ParameterInfo count_parameter(std::string_view name, int value, int min, int max, std::string_view text);
ParameterInfo color_parameter(std::string_view name, const Vec3& value, std::string_view text);
ParameterInfo seed_parameter();

}  // namespace gnomon
