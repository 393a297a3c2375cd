// The table of generators, and the check of their parameters: names, types, ranges, sizes.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>

#include "scene/generate/generator.h"

namespace gnomon {
namespace {

constexpr std::array<std::string_view, 4> type_names{"a number", "true or false", "a string",
                                                     "a list of numbers"};

template <class Generator>
struct Table {
  std::vector<Generator> generators;
  std::vector<GeneratorInfo> infos;

  explicit Table(std::initializer_list<std::span<const Generator>> lists) {
    for (const auto& list : lists) generators.insert(generators.end(), list.begin(), list.end());
    std::sort(generators.begin(), generators.end(),
              [](const Generator& a, const Generator& b) { return a.info.kind < b.info.kind; });
    for (const Generator& g : generators) infos.push_back(g.info);
  }
  const Generator* find(std::string_view kind) const {
    const auto it = std::find_if(generators.begin(), generators.end(),
                                 [&](const Generator& g) { return g.info.kind == kind; });
    return it == generators.end() ? nullptr : &*it;
  }
};

const Table<MeshGenerator>& mesh_table() {
  static const Table<MeshGenerator> table{
      basic_generators(),        fence_generators(),     garden_generators(), plant_generators(),
      architecture_generators(), stonework_generators(), swarm_generators(),  teapot_generators()};
  return table;
}

const Table<TextureGenerator>& texture_table() {
  static const Table<TextureGenerator> table{all_texture_generators()};
  return table;
}

std::string allowed_range(const ParameterInfo& info) {
  const std::string unit = info.unit.empty() ? "" : fmt::format(" {}", info.unit);
  return fmt::format("{}{:g} to {:g}{}", info.whole ? "whole numbers from " : "", info.min, info.max, unit);
}

Expected<void> check_number(const ParameterInfo& info, double v) {
  const bool in_range = info.min <= v && v <= info.max;  // false for NaN
  if (in_range && (!info.whole || v == std::floor(v))) return {};
  return fail_parameter(info.name,
                        fmt::format("out of range (got {:g}, allowed {})", v, allowed_range(info)));
}

Expected<void> check_list(const ParameterInfo& info, const std::vector<double>& list) {
  const std::size_t default_size = std::get<std::vector<double>>(info.default_value).size();
  const bool fixed = info.min_size == 0 && info.max_size == 0;
  const std::size_t least = fixed ? default_size : info.min_size, most = fixed ? default_size : info.max_size;
  if (list.size() < least || list.size() > most) {
    const std::string allowed =
        least == most ? fmt::format("{}", least) : fmt::format("{} to {}", least, most);
    return fail_parameter(info.name,
                          fmt::format("wrong number of elements (got {}, allowed {})", list.size(), allowed));
  }
  for (const double v : list) {
    if (auto ok = check_number(info, v); !ok) return ok;
  }
  return {};
}

Expected<void> check_value(const ParameterInfo& info, const ParameterValue& value) {
  if (value.index() != info.default_value.index()) {
    return fail_parameter(info.name, fmt::format("wrong type (got {}, allowed {})", type_names[value.index()],
                                                 type_names[info.default_value.index()]));
  }
  if (const auto* v = std::get_if<double>(&value)) return check_number(info, *v);
  if (const auto* list = std::get_if<std::vector<double>>(&value)) return check_list(info, *list);
  const auto* text = std::get_if<std::string>(&value);
  if (text && !info.choices.empty() &&
      std::find(info.choices.begin(), info.choices.end(), *text) == info.choices.end()) {
    return fail_parameter(info.name, fmt::format("unknown choice (got \"{}\", allowed {})", *text,
                                                 fmt::join(info.choices, ", ")));
  }
  return {};
}

/// "box, floor, sphere"
template <class Infos, class Name>
std::string names_of(const Infos& infos, Name name) {
  std::string text;
  for (const auto& info : infos) text += fmt::format("{}{}", text.empty() ? "" : ", ", info.*name);
  return text.empty() ? "none" : text;
}

Expected<Values> complete(const GeneratorInfo& generator, const Parameters& given) {
  Parameters all;
  for (const ParameterInfo& info : generator.parameters) all.emplace(info.name, info.default_value);
  for (const auto& [name, value] : given) {
    const auto info =
        std::find_if(generator.parameters.begin(), generator.parameters.end(),
                     [wanted = std::string_view(name)](const ParameterInfo& p) { return p.name == wanted; });
    if (info == generator.parameters.end()) {
      return fail_parameter(name, fmt::format("'{}' has no such parameter (allowed {})", generator.kind,
                                              names_of(generator.parameters, &ParameterInfo::name)));
    }
    if (auto ok = check_value(*info, value); !ok) return fail(ok.error());
    all[name] = value;
  }
  return Values(std::move(all));
}

template <class Result, class Generator>
Expected<Result> run(const Table<Generator>& table, std::string_view kind, const Parameters& parameters) {
  const Generator* generator = table.find(kind);
  if (!generator)
    return fail_parameter("kind", fmt::format("no generator of this kind (got \"{}\", allowed {})", kind,
                                              names_of(table.infos, &GeneratorInfo::kind)));
  Expected<Values> values = complete(generator->info, parameters);
  if (!values) return fail(values.error());
  return generator->build(*values);
}

}  // namespace

std::span<const GeneratorInfo> generators() {
  return mesh_table().infos;
}
std::span<const GeneratorInfo> texture_generators() {
  return texture_table().infos;
}

Expected<GeneratedModel> generate(std::string_view kind, const Parameters& parameters) {
  return run<GeneratedModel>(mesh_table(), kind, parameters);
}

Expected<Texture> generate_texture(std::string_view kind, const Parameters& parameters) {
  return run<Texture>(texture_table(), kind, parameters);
}

ParameterInfo length_parameter(std::string_view name, double value, double min, double max,
                               std::string_view text) {
  return {name, "m", value, min, max, text};
}

ParameterInfo count_parameter(std::string_view name, int value, int min, int max, std::string_view text) {
  return {name, "",  static_cast<double>(value), static_cast<double>(min), static_cast<double>(max),
          text, true};
}

ParameterInfo color_parameter(std::string_view name, const Vec3& value, std::string_view text) {
  return {name, "linear RGB", std::vector<double>{value.x, value.y, value.z}, 0.0, 1.0, text};
}

ParameterInfo seed_parameter() {
  return {"seed", "", 1.0, 0.0, 4294967295.0, "picks another variation", true};
}

}  // namespace gnomon
