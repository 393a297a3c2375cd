// CLI11 throws; what is thrown here is caught in command_line.cpp and never leaves this room.
#include "app/technique_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/filter_options.h"
#include "app/options.h"
#include "compare/option_names.h"

namespace gnomon::app {
namespace {

using raster::FilterKernel;
using raster::Technique;

/// Sets of techniques and of pcf's kernels, a bit for each.
using Set = std::uint32_t;

template <class... Enum>
constexpr Set set_of(Enum... members) {
  return ((Set{1} << static_cast<unsigned>(members)) | ...);
}
template <class Enum>
constexpr bool holds(Set set, Enum member) {
  return (set & set_of(member)) != 0;
}

constexpr Set exact = set_of(Technique::izb, Technique::hybrid);  // no stored depth, so no bias
constexpr Set all = (set_of(Technique::hybrid) << 1U) - 1U;
constexpr Set depth = all & ~exact;
constexpr Set moments = set_of(Technique::vsm, Technique::esm, Technique::evsm, Technique::msm);
constexpr Set every_kernel =
    set_of(FilterKernel::box, FilterKernel::hardware, FilterKernel::vogel, FilterKernel::optimised);

struct Row {
  std::string_view option;
  Set techniques;
  Set kernels = every_kernel;  ///< of pcf
};
constexpr Row rows[] = {
    {"bias", depth},
    {"slope-bias", depth},
    {"normal-offset", depth},
    // pcf and pcss compare with the plane by default: filter-plane.
    {"receiver-plane", depth & ~moments & ~set_of(Technique::pcf, Technique::pcss)},
    {"adaptive-bias", depth & ~moments},
    {"depth-format", depth},
    {"cull", depth & ~set_of(Technique::second_depth)},
    {"filter-kernel", set_of(Technique::pcf)},
    {"filter-radius", set_of(Technique::pcf), every_kernel & ~set_of(FilterKernel::hardware)},
    {"filter-plane", set_of(Technique::pcf, Technique::pcss)},
    {"filter-samples", set_of(Technique::pcf, Technique::pcss), set_of(FilterKernel::vogel)},
    {"blocker-samples", set_of(Technique::pcss)},
    {"search-radius", set_of(Technique::pcss)},
    {"blur-radius", moments},
    {"mipmaps", moments},
    {"bleeding-reduction", moments & ~set_of(Technique::esm)},
    {"esm-exponent", set_of(Technique::esm)},
    {"evsm-exponent", set_of(Technique::evsm)},
    {"evsm-negative-exponent", set_of(Technique::evsm)},
    {"moment-bias", set_of(Technique::msm)},
    {"cascades", set_of(Technique::csm)},
    {"cascade-lambda", set_of(Technique::csm)},
    {"no-snap", set_of(Technique::csm)},
    {"cascade-fit", set_of(Technique::csm)}};

const Row* row_of(std::string_view option) {
  const Row* found =
      std::find_if(std::begin(rows), std::end(rows), [&](const Row& row) { return row.option == option; });
  return found == std::end(rows) ? nullptr : found;
}

std::string kernel_names(Set kernels) {
  std::vector<std::string_view> names;
  for (const auto& [name, kernel] : filter_kernels())
    if (holds(kernels, kernel)) names.push_back(name);
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string technique_text(const Row& row, Set techniques) {
  std::vector<std::string> names;
  for (const auto& [name, technique] : all_techniques()) {
    if (!holds(techniques, technique)) continue;
    const bool some = technique == Technique::pcf && row.kernels != every_kernel;
    names.push_back(some ? fmt::format("{} ({})", name, kernel_names(row.kernels)) : name);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

/// What to type instead: the first technique that reads the option, with a kernel of pcf that does.
std::string remedy(const Row& row, bool is_pcf) {
  for (const auto& [name, technique] : all_techniques()) {
    if (!holds(row.techniques, technique)) continue;
    const std::string kernels = kernel_names(row.kernels);
    const std::string kernel = "--filter-kernel " + kernels.substr(0, kernels.find(','));
    if (technique != Technique::pcf || holds(row.kernels, FilterKernel::box)) {
      return is_pcf && technique == Technique::pcf ? kernel : "--technique " + name;
    }
    return is_pcf ? kernel : "--technique pcf " + kernel;
  }
  return {};
}

std::string given_text(std::span<const Technique> techniques, std::span<const FilterKernel> kernels) {
  std::vector<std::string> names;
  for (const Technique technique : techniques) {
    std::string name(compare::technique_name(technique));
    Set used = 0;
    for (const FilterKernel kernel : kernels) used |= set_of(kernel);
    if (technique == Technique::pcf) name += " with --filter-kernel " + kernel_names(used);
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(std::move(name));
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

std::vector<std::string_view> technique_options() {
  std::vector<std::string_view> names;
  for (const Row& row : rows) names.push_back(row.option);
  return names;
}

bool technique_reads(std::string_view option, Technique technique, FilterKernel kernel) {
  const Row* row = row_of(option);
  if (row == nullptr) return true;
  return holds(row->techniques, technique) && (technique != Technique::pcf || holds(row->kernels, kernel));
}

std::string readers_of(std::string_view option) {
  const Row* row = row_of(option);
  if (row == nullptr) return "all";
  const std::string readers = technique_text(*row, row->techniques);
  const std::string others = "all but " + technique_text(*row, all & ~row->techniques);
  return others.size() < readers.size() ? others : readers;
}

Expected<void> check_read(std::string_view option, std::span<const Technique> techniques,
                          std::span<const FilterKernel> kernels) {
  for (const Technique technique : techniques)
    for (const FilterKernel kernel : kernels)
      if (technique_reads(option, technique, kernel)) return {};
  const bool pcf = std::find(techniques.begin(), techniques.end(), Technique::pcf) != techniques.end();
  Error error{ErrorKind::usage,
              fmt::format("belongs to {}; --technique is {}; did you mean {}?", readers_of(option),
                          given_text(techniques, kernels), remedy(*row_of(option), pcf))};
  error.field = fmt::format("--{}", option);
  return fail(std::move(error));
}

void name_readers(CLI::App& command) {
  for (const Row& row : rows) {
    CLI::Option* option = command.get_option_no_throw(fmt::format("--{}", row.option));
    if (option != nullptr)
      option->description(fmt::format("{}: {}", readers_of(row.option), option->get_description()));
  }
}

void finish_map_options(const CLI::App& command, raster::MapOptions& map) {
  for (const Row& row : rows) {
    const CLI::Option* option = command.get_option_no_throw(fmt::format("--{}", row.option));
    if (option == nullptr || option->count() == 0) continue;
    const auto read = check_read(row.option, std::span(&map.technique, 1), std::span(&map.filter.kernel, 1));
    if (!read) throw CLI::ValidationError(read.error().field, read.error().reason);
  }
  const auto given = [&](const char* option) { return command.count(option) > 0; };
  if (given("--slope-bias")) return;
  const bool any =
      given("--bias") || given("--normal-offset") || given("--receiver-plane") || given("--adaptive-bias");
  map.bias.slope = any ? 0.0 : raster::default_bias(map).slope;
}

}  // namespace gnomon::app
