#include "studies/commands/tune_families.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

#include "app/options/options.h"
#include "app/options/values.h"
#include "compare/result/option_names.h"
#include "raster/technique_traits.h"
#include "scene/light.h"

namespace gnomon::app {

namespace {

using Values = OptionValues;

bool is_named(const Values& values, const std::string& name) {
  return std::any_of(values.begin(), values.end(), [&](const auto& entry) { return entry.first == name; });
}

/// What is tried of the options that nothing was said about.
std::vector<Values> default_kinds() {
  return {{{"bias", "1texel"}},       {{"slope-bias", "1"}},     {{"normal-offset", "1"}},
          {{"receiver-plane", "on"}}, {{"adaptive-bias", "on"}}, {{"cull", "front"}}};
}

/// What an engine can be told: its own kinds of bias, beside a constant where it has one, with what its filters need.
std::vector<Values> kinds_of(const compare::TunedEngine& engine) {
  using compare::BiasPart;
  const bool constant = engine.has(BiasPart::constant);
  std::vector<Values> kinds;
  const auto add = [&](const char* option, std::initializer_list<const char*> values) {
    for (const char* value : values) {
      kinds.push_back({{option, value}});
      if (!constant) kinds.back().insert(kinds.back().begin(), {"bias", "0"});
    }
  };
  if (constant) add("bias", {"1texel"});
  if (engine.has(BiasPart::slope))
    add(engine.offsets_casters ? "caster-slope-bias" : "slope-bias", {"1", "2", "4"});
  if (engine.has(BiasPart::normal_offset)) add("normal-offset", {"1", "2", "4"});
  if (engine.front_faces_culled) add("cull", {"front"});
  return kinds;
}

/// Maps of moments and of depths between two surfaces are made so that no bias beside a constant is needed.
bool needs_no_kind(raster::Technique technique) {
  const raster::MapContents contents = raster::traits_of(technique).contents;
  return contents != raster::MapContents::nearest_depth;
}

/// Of few rays: as many as engines draw, and four times that.
std::vector<Values> ray_kinds() {
  return {{}, {{"rays", "4"}}};
}

/// What keeps a map still.
std::vector<Values> still_kinds() {
  return {{}, {{"snap", "on"}}, {{"cascade-blend", "0.1"}}};
}
constexpr std::array<const char*, 2> still_options{"snap", "cascade-blend"};

// "slope bias 1", "receiver plane", "front faces culled"
std::string option_words(std::string option, const std::string& value) {
  if (option == "cull" && value != "none") return value + " faces culled";
  std::replace(option.begin(), option.end(), '-', ' ');
  return value == "on" ? option : option + " " + value;
}

/// The options that say what kind of bias it is.
constexpr std::array<const char*, 6> kind_options{"slope-bias",     "caster-slope-bias", "normal-offset",
                                                  "receiver-plane", "adaptive-bias",     "cull"};

std::string family_name(const Values& values, const Values& fixed, raster::Technique technique, bool filmed) {
  std::string name;
  bool kind = std::any_of(kind_options.begin(), kind_options.end(),
                          [&](const char* option) { return is_named(fixed, option); });
  for (const auto& [option, value] : values) {
    if (option == "bias" || option == "filter-plane")
      continue;  // the tuner finds it; no engine's filter has one
    kind = kind || option != "technique";
    name += (name.empty() ? "" : ", ") + (option == "technique" ? value : option_words(option, value));
  }
  if ((filmed || !raster::compares_depths(technique)) && !kind)
    return std::string(raster::technique_name(technique));
  if (kind) return name.empty() ? std::string(raster::technique_name(technique)) : name;
  return name.empty() ? "constant bias alone" : name + ", constant bias alone";
}

/// Everything fixed, with the values of one family that its technique reads.
Expected<OptionFamily> make_family(Values values, const Values& fixed, bool filmed, bool keeps_bias) {
  Values all = fixed;
  all.insert(all.end(), values.begin(), values.end());
  const Values read = values_read(all);
  std::erase_if(values, [&](const auto& entry) { return !is_named(read, entry.first); });
  const auto parsed = parse_setting(read);
  if (!parsed) return fail(parsed.error());
  return OptionFamily{{family_name(values, fixed, parsed->options.raster.map.technique, filmed),
                       parsed->options.raster.map, keeps_bias},
                      std::move(values)};
}

std::string technique_of(const Values& values, const Values& fixed) {
  for (const Values* list : {&values, &fixed})
    for (const auto& [option, value] : *list)
      if (option == "technique") return value;
  return {};
}

// What differs in the constant bias alone is one family: the tuner finds that.
bool has_family(const std::vector<OptionFamily>& families, const OptionFamily& family) {
  return std::any_of(families.begin(), families.end(),
                     [&](const OptionFamily& other) { return other.tuned.name == family.tuned.name; });
}

}  // namespace

std::vector<std::string> tuned_techniques() {
  std::vector<std::string> names = technique_names();
  std::erase(names, "cube");
  return names;
}

bool is_given(const Values& fixed, const studies::Grid& grid, const std::string& name) {
  return is_named(fixed, name) || std::any_of(grid.axes().begin(), grid.axes().end(),
                                              [&](const auto& axis) { return axis.name == name; });
}

/// The combinations of what was given as lists, and of the defaults where nothing was given.
Expected<std::vector<OptionFamily>> make_families(const SweepOptions& options, bool filmed,
                                                  const compare::TunedEngine* engine) {
  const auto grid = options.grid(false);
  if (!grid) return fail(grid.error());
  const Values fixed = options.fixed();
  std::vector<studies::Axis> axes;
  for (const studies::Axis& axis : grid->axes())
    if (axis.name != "map-size") axes.push_back(axis);
  if (!is_given(fixed, *grid, "technique")) axes.insert(axes.begin(), {"technique", tuned_techniques()});
  std::vector<Values> kinds = filmed              ? still_kinds()
                              : engine != nullptr ? kinds_of(*engine)
                                                  : default_kinds();
  const bool keeps_bias = engine != nullptr && !engine->has(compare::BiasPart::constant);
  const std::span<const char* const> said =
      filmed ? std::span<const char* const>(still_options) : std::span<const char* const>(kind_options);
  bool kinds_given = filmed;
  for (const char* name : said)
    if (is_given(fixed, *grid, name)) kinds = {{}}, kinds_given = true;
  const bool rays_given = filmed || is_given(fixed, *grid, "rays") || is_given(fixed, *grid, "denoiser");
  const auto kinds_for = [&](const std::string& technique) {
    if (technique != raster::technique_name(raster::Technique::rays)) return kinds;
    return rays_given ? std::vector<Values>{{}} : ray_kinds();
  };
  const auto product = studies::Grid::make(axes, false);
  if (!product) return fail(product.error());
  std::vector<OptionFamily> families;
  std::optional<Error> unsound;
  for (std::size_t cell = 0; cell < product->cells(); ++cell) {
    Values of_cell;
    for (std::size_t k = 0; k < axes.size(); ++k) of_cell.emplace_back(axes[k].name, product->value(k, cell));
    const std::vector<Values> tried = kinds_for(technique_of(of_cell, fixed));
    for (const Values& kind : tried) {
      Values values = of_cell;
      values.insert(values.end(), kind.begin(), kind.end());
      if (engine != nullptr && !is_given(fixed, *grid, "filter-plane"))
        values.emplace_back("filter-plane", "off");
      auto family = make_family(std::move(values), fixed, filmed, keeps_bias);
      if (!family) return fail(family.error());
      const auto sound = raster::check_map_options(family->tuned.map);
      if (!sound) unsound = sound.error();
      if (!sound) continue;  // a bias that does not go with the technique
      if (!kinds_given && needs_no_kind(family->tuned.map.technique) &&
          !raster::samples_rays(family->tuned.map.technique) && &kind != &tried.front())
        continue;
      if (engine != nullptr && !engine->draws(family->tuned.map)) continue;
      if (has_family(families, *family)) continue;  // but for what the technique does not read
      families.push_back(std::move(*family));
    }
  }
  if (families.empty() && unsound) return fail(*unsound);
  if (families.empty())
    return fail(ErrorKind::usage,
                fmt::format("--engine {}: {} draws nothing of what the other options ask for", engine->key,
                            engine->name));
  return families;
}

/// "csm and lispsm are for directional lights, cube for point lights".
std::string technique_limits() {
  std::string text;
  for (const auto& [type, verb] : {std::pair{LightType::directional, " are"}, {LightType::point, ""}}) {
    std::vector<std::string_view> names;
    for (const raster::TechniqueTraits& traits : raster::all_technique_traits())
      if (traits.lights == raster::LightTypeSet(type)) names.push_back(traits.name);
    text += fmt::format("{}{}{} for {} lights", text.empty() ? "" : ", ", fmt::join(names, " and "), verb,
                        light_type_name(type));
  }
  return text;
}

/// Without the techniques that have no map for a light compared.
Expected<std::vector<OptionFamily>> fitting_families(const std::vector<OptionFamily>& families,
                                                     const Scene& scene,
                                                     const std::vector<std::uint32_t>& lights,
                                                     const compare::TunedEngine* engine) {
  std::vector<OptionFamily> out;
  for (const OptionFamily& family : families) {
    const bool drawn = std::all_of(lights.begin(), lights.end(), [&](std::uint32_t light) {
      return raster::has_map_for(family.tuned.map.technique, scene.lights[light].type);
    });
    // One exact ray decides under a light without size, however many are asked for.
    const bool again =
        raster::samples_rays(family.tuned.map.technique) &&
        std::ranges::none_of(lights, [&](std::uint32_t light) { return has_size(scene.lights[light]); }) &&
        std::ranges::any_of(
            out, [](const OptionFamily& other) { return raster::samples_rays(other.tuned.map.technique); });
    if (drawn && !again) out.push_back(family);
  }
  const bool had_maps = !out.empty();
  if (engine != nullptr)
    std::erase_if(out, [&](const OptionFamily& family) {
      return !std::ranges::all_of(lights, [&](std::uint32_t light) {
        return engine->draws(family.tuned.map, scene.lights[light].type);
      });
    });
  if (had_maps && out.empty())
    return fail(ErrorKind::usage,
                fmt::format("--engine {}: of a {} light no bias of {}'s is known as a number "
                            "(docs/engine-units.md)",
                            engine->key, light_type_name(scene.lights[lights.front()].type), engine->name));
  // Under lights without size it is the hard test, which is tried by its own name.
  const bool sizeless = std::none_of(lights.begin(), lights.end(),
                                     [&](std::uint32_t light) { return has_size(scene.lights[light]); });
  const auto is_pcss = [](const OptionFamily& family) {
    return raster::traits_of(family.tuned.map.technique).filter == raster::EdgeFilter::penumbra;
  };
  if (sizeless && !std::all_of(out.begin(), out.end(), is_pcss)) std::erase_if(out, is_pcss);
  if (out.empty() && !families.empty())
    return fail(ErrorKind::usage,
                fmt::format("--technique: has no map for a light of this scene ({})", technique_limits()));
  return out;
}

}  // namespace gnomon::app
