// CLI11 throws; what is thrown here is caught in command_line.cpp and never leaves this room.
#include "app/options/map_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/options/option_kinds.h"

namespace gnomon::app {
namespace {

using raster::FilterKernel;
using raster::FilterKernelTraits;
using raster::MapOptions;
using raster::MapSetting;
using raster::SwitchForm;
using raster::SwitchSetting;
using raster::Technique;
using raster::TechniqueTraits;

bool read_by_kernel(const MapSetting& setting, FilterKernel kernel) {
  return setting.read_by_kernel == nullptr || setting.read_by_kernel(kernel);
}

/// "box, vogel": pcf's kernels that read the setting.
std::string kernels_reading(const MapSetting& setting) {
  std::vector<std::string_view> names;
  for (const FilterKernelTraits& kernel : raster::all_filter_kernel_traits())
    if (read_by_kernel(setting, kernel.kernel)) names.push_back(kernel.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

/// The techniques that read the setting, or those that do not.
std::string techniques_text(const MapSetting& setting, bool reading) {
  std::vector<std::string> names;
  for (const TechniqueTraits& traits : raster::all_technique_traits()) {
    if (raster::reads(traits, setting) != reading) continue;
    const bool some = raster::has_kernel(traits.technique) && setting.read_by_kernel != nullptr;
    names.push_back(some ? fmt::format("{} ({})", traits.name, kernels_reading(setting))
                         : std::string(traits.name));
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

/// What to type instead: the first technique that reads the setting, with a kernel of pcf that does.
std::string remedy(const MapSetting& setting, bool is_pcf) {
  for (const TechniqueTraits& traits : raster::all_technique_traits()) {
    if (!raster::reads(traits, setting)) continue;
    const std::string kernels = kernels_reading(setting);
    const std::string kernel = "--filter-kernel " + kernels.substr(0, kernels.find(','));
    const bool pcf = raster::has_kernel(traits.technique);
    if (!pcf || read_by_kernel(setting, FilterKernel::box))
      return is_pcf && pcf ? kernel : fmt::format("--technique {}", traits.name);
    return is_pcf ? kernel : "--technique pcf " + kernel;
  }
  return {};
}

std::string given_text(std::span<const Technique> techniques, std::span<const FilterKernel> kernels) {
  std::vector<std::string_view> kernel_names;
  for (const FilterKernelTraits& traits : raster::all_filter_kernel_traits())
    if (std::find(kernels.begin(), kernels.end(), traits.kernel) != kernels.end())
      kernel_names.push_back(traits.name);
  std::vector<std::string> names;
  for (const Technique technique : techniques) {
    std::string name(raster::technique_name(technique));
    if (raster::has_kernel(technique))
      name += fmt::format(" with --filter-kernel {}", fmt::join(kernel_names, ", "));
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(std::move(name));
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

/// "all but izb, hybrid: what it does [unit, range; default]".
std::string help_text(const MapSetting& setting, const MapOptions& map) {
  const std::string readers = setting.read_by == nullptr ? "" : readers_text(setting) + ": ";
  const auto* flag = std::get_if<SwitchSetting>(&setting.kind);
  if (flag != nullptr && flag->form != SwitchForm::word)
    return fmt::format("{}{} [default off]", readers, setting.help);
  const std::string fallback =
      setting.default_help.empty() ? raster::setting_text(setting, map) : std::string(setting.default_help);
  return readers + describe(setting.help, raster::allowed_text(setting), fallback);
}

void add_setting(CLI::App& command, const MapSetting& setting, MapOptions& map) {
  const std::string name = fmt::format("--{}", setting.name), help = help_text(setting, map);
  const auto* flag = std::get_if<SwitchSetting>(&setting.kind);
  if (flag == nullptr || flag->form == SwitchForm::word) {
    add_value(command, name, std::string(setting.type).c_str(), help,
              [&setting, &map](const std::string& text) { return raster::set_setting(setting, map, text); });
    return;
  }
  const auto turn = [flag, &map](std::int64_t given) {
    flag->set(map, (given > 0) == (flag->form == SwitchForm::flag));
  };
  command.add_flag(name, turn, help);
}

}  // namespace

void add_map_options(CLI::App& command, MapOptions& map) {
  for (const MapSetting& setting : raster::map_settings()) add_setting(command, setting, map);
}

void add_map_option(CLI::App& command, std::string_view name, MapOptions& map) {
  add_setting(command, *raster::find_setting(name), map);
}

std::vector<std::string> map_setting_names() {
  std::vector<std::string> names;
  for (const MapSetting& setting : raster::map_settings()) names.emplace_back(setting.name);
  return names;
}

std::vector<std::string> technique_names() {
  std::vector<std::string> names;
  for (const TechniqueTraits& traits : raster::all_technique_traits()) names.emplace_back(traits.name);
  return names;
}

std::string readers_text(const MapSetting& setting) {
  const std::string readers = techniques_text(setting, true);
  const std::string others = "all but " + techniques_text(setting, false);
  return others.size() < readers.size() ? others : readers;
}

Expected<void> check_read(std::string_view option, std::span<const Technique> techniques,
                          std::span<const FilterKernel> kernels) {
  for (const Technique technique : techniques)
    for (const FilterKernel kernel : kernels) {
      MapOptions map;
      map.technique = technique, map.filter.kernel = kernel;
      if (raster::reads_setting(map, option)) return {};
    }
  const MapSetting& setting = *raster::find_setting(option);
  const bool pcf = std::any_of(techniques.begin(), techniques.end(), raster::has_kernel);
  Error error{ErrorKind::usage,
              fmt::format("belongs to {}; --technique is {}; did you mean {}?", readers_text(setting),
                          given_text(techniques, kernels), remedy(setting, pcf))};
  error.field = fmt::format("--{}", option);
  return fail(std::move(error));
}

void finish_map_options(const CLI::App& command, MapOptions& map) {
  const auto times = [&](std::string_view name) {
    const CLI::Option* option = command.get_option_no_throw(fmt::format("--{}", name));
    return option != nullptr ? option->count() : 0;
  };
  const auto given = [&](std::string_view name) { return times(name) > 0; };
  const bool replaced = times("technique") > 1;
  for (const MapSetting& setting : raster::map_settings()) {
    if (!given(setting.name)) continue;
    const auto read =
        check_read(setting.name, std::span(&map.technique, 1), std::span(&map.filter.kernel, 1));
    if (read) continue;
    if (!replaced) throw CLI::ValidationError(read.error().field, read.error().reason);
    [[maybe_unused]] const auto set =
        raster::set_setting(setting, map, raster::setting_text(setting, MapOptions{}));
  }
  if (given("cascades") && !map.cascades.splits.empty() && map.cascades.count != map.cascades.splits.count)
    throw CLI::ValidationError(
        "--cascades", fmt::format("there is one cascade for each of --cascade-splits (got {}, allowed {})",
                                  map.cascades.count, map.cascades.splits.count));
  if (given("slope-bias")) return;
  const bool any = given("bias") || given("normal-offset") || map.bias.receiver_plane || map.bias.adaptive ||
                   map.bias.moves_casters();
  map.bias.slope = any ? 0.0 : raster::default_bias(map).slope;
}

}  // namespace gnomon::app
