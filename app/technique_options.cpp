// CLI11 throws; what is thrown here is caught in command_line.cpp and never leaves this room.
#include "app/technique_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "raster/technique_traits.h"

namespace gnomon::app {
namespace {

using raster::FilterKernel;
using raster::Technique;

using raster::FilterKernelTraits;
using raster::MapOption;
using raster::TechniqueTraits;

struct OptionRow {
  std::string_view name;  ///< without "--"
  MapOption option;
};
constexpr OptionRow rows[] = {{"bias", MapOption::bias},
                              {"slope-bias", MapOption::slope_bias},
                              {"normal-offset", MapOption::normal_offset},
                              {"receiver-plane", MapOption::receiver_plane},
                              {"adaptive-bias", MapOption::adaptive_bias},
                              {"depth-format", MapOption::depth_format},
                              {"cull", MapOption::cull},
                              {"filter-kernel", MapOption::filter_kernel},
                              {"filter-radius", MapOption::filter_radius},
                              {"filter-plane", MapOption::filter_plane},
                              {"filter-samples", MapOption::filter_samples},
                              {"blocker-samples", MapOption::blocker_samples},
                              {"search-radius", MapOption::search_radius},
                              {"blur-radius", MapOption::blur_radius},
                              {"mipmaps", MapOption::mipmaps},
                              {"bleeding-reduction", MapOption::bleeding_reduction},
                              {"esm-exponent", MapOption::esm_exponent},
                              {"evsm-exponent", MapOption::evsm_exponent},
                              {"evsm-negative-exponent", MapOption::evsm_negative_exponent},
                              {"moment-bias", MapOption::moment_bias},
                              {"cascades", MapOption::cascades},
                              {"cascade-lambda", MapOption::cascade_lambda},
                              {"no-snap", MapOption::no_snap},
                              {"cascade-fit", MapOption::cascade_fit},
                              {"cascade-blend", MapOption::cascade_blend},
                              {"snap", MapOption::snap}};

const OptionRow* row_of(std::string_view option) {
  const OptionRow* found = std::find_if(std::begin(rows), std::end(rows),
                                        [&](const OptionRow& row) { return row.name == option; });
  return found == std::end(rows) ? nullptr : found;
}

/// "box, vogel": pcf's kernels that read the option.
std::string kernels_reading(MapOption option) {
  std::vector<std::string_view> names;
  for (const FilterKernelTraits& kernel : raster::all_filter_kernel_traits())
    if (!kernel.unread.has(option)) names.push_back(kernel.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

bool every_kernel_reads(MapOption option) {
  const auto kernels = raster::all_filter_kernel_traits();
  return std::none_of(kernels.begin(), kernels.end(),
                      [&](const FilterKernelTraits& kernel) { return kernel.unread.has(option); });
}

/// The techniques that read the option, or those that do not.
std::string techniques_text(MapOption option, bool reading) {
  std::vector<std::string> names;
  for (const TechniqueTraits& traits : raster::all_technique_traits()) {
    if (traits.reads.has(option) != reading) continue;
    const bool some = traits.technique == Technique::pcf && !every_kernel_reads(option);
    names.push_back(some ? fmt::format("{} ({})", traits.name, kernels_reading(option))
                         : std::string(traits.name));
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

/// What to type instead: the first technique that reads the option, with a kernel of pcf that does.
std::string remedy(MapOption option, bool is_pcf) {
  for (const TechniqueTraits& traits : raster::all_technique_traits()) {
    if (!traits.reads.has(option)) continue;
    const std::string kernels = kernels_reading(option);
    const std::string kernel = "--filter-kernel " + kernels.substr(0, kernels.find(','));
    const bool pcf = traits.technique == Technique::pcf;
    if (!pcf || !raster::traits_of(FilterKernel::box).unread.has(option))
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
    if (technique == Technique::pcf)
      name += fmt::format(" with --filter-kernel {}", fmt::join(kernel_names, ", "));
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(std::move(name));
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

std::vector<std::string_view> technique_options() {
  std::vector<std::string_view> names;
  for (const OptionRow& row : rows) names.push_back(row.name);
  return names;
}

bool technique_reads(std::string_view option, const raster::MapOptions& map) {
  const OptionRow* row = row_of(option);
  return row == nullptr || raster::reads_option(map, row->option);
}

bool technique_reads(std::string_view option, Technique technique) {
  const OptionRow* row = row_of(option);
  return row == nullptr || raster::traits_of(technique).reads.has(row->option);
}

std::string readers_of(std::string_view option) {
  const OptionRow* row = row_of(option);
  if (row == nullptr) return "all";
  const std::string readers = techniques_text(row->option, true);
  const std::string others = "all but " + techniques_text(row->option, false);
  return others.size() < readers.size() ? others : readers;
}

Expected<void> check_read(std::string_view option, std::span<const Technique> techniques,
                          std::span<const FilterKernel> kernels) {
  for (const Technique technique : techniques)
    for (const FilterKernel kernel : kernels) {
      raster::MapOptions map;
      map.technique = technique, map.filter.kernel = kernel;
      if (technique_reads(option, map)) return {};
    }
  const bool pcf = std::find(techniques.begin(), techniques.end(), Technique::pcf) != techniques.end();
  Error error{ErrorKind::usage,
              fmt::format("belongs to {}; --technique is {}; did you mean {}?", readers_of(option),
                          given_text(techniques, kernels), remedy(row_of(option)->option, pcf))};
  error.field = fmt::format("--{}", option);
  return fail(std::move(error));
}

void name_readers(CLI::App& command) {
  for (const OptionRow& row : rows) {
    CLI::Option* option = command.get_option_no_throw(fmt::format("--{}", row.name));
    if (option != nullptr)
      option->description(fmt::format("{}: {}", readers_of(row.name), option->get_description()));
  }
}

void finish_map_options(const CLI::App& command, raster::MapOptions& map) {
  for (const OptionRow& row : rows) {
    const CLI::Option* option = command.get_option_no_throw(fmt::format("--{}", row.name));
    if (option == nullptr || option->count() == 0) continue;
    const auto read = check_read(row.name, std::span(&map.technique, 1), std::span(&map.filter.kernel, 1));
    if (!read) throw CLI::ValidationError(read.error().field, read.error().reason);
  }
  const auto given = [&](const char* option) { return command.count(option) > 0; };
  if (given("--slope-bias")) return;
  const bool any =
      given("--bias") || given("--normal-offset") || map.bias.receiver_plane || map.bias.adaptive;
  map.bias.slope = any ? 0.0 : raster::default_bias(map).slope;
}

}  // namespace gnomon::app
