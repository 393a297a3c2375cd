// CLI11 throws; what is thrown here is caught in command_line.cpp and never leaves this room.
#include "studies/commands/axes.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/options/options.h"
#include "scene/base/option_text.h"

namespace gnomon::app {

namespace {

using Values = std::vector<std::pair<std::string, std::string>>;

studies::ValueKind value_kind(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  if (is_flag(option) || type == "NAME" || type == "SIDE") return studies::ValueKind::word;
  return type.find(',') == std::string::npos ? studies::ValueKind::number : studies::ValueKind::numbers;
}

/// Truth first, then what changes the depth map, then what only looks it up, the constant bias last.
int speed(const std::string& name, const std::vector<std::string>& map_names) {
  if (name == "bias") return 3;
  if (name == "map-size" || name == "depth-format" || name == "cull") return 1;
  return std::find(map_names.begin(), map_names.end(), name) != map_names.end() ? 2 : 0;
}

std::string sweep_text(const CLI::Option& option) {
  const std::string& text = option.get_description();
  return is_flag(option) ? text + "; off or on" : text;
}

}  // namespace

void SweepOptions::add_to(CLI::App& command) {
  for (const CLI::Option* option : setting_parser().get_options()) {
    Given& given = *given_.emplace_back(std::make_unique<Given>());
    given.name = option->get_lnames().front();
    given.flag = is_flag(*option);
    given.kind = value_kind(*option);
    const auto store = [&given](const std::string& text) {
      const std::string name = "--" + given.name;
      auto values = studies::expand_values(text, given.kind);
      if (!values) throw CLI::ValidationError(name, values.error().reason);
      for (const std::string& value : *values) {
        const auto parsed = check_setting(given.name, value);
        if (!parsed) throw CLI::ValidationError(parsed.error().reason, CLI::ExitCodes::ValidationError);
      }
      given.values = std::move(*values);
      given.text = text;
    };
    command.add_option_function<std::string>("--" + given.name, store, sweep_text(*option))
        ->type_name(given.flag ? "off|on"
                               : option->get_type_name() +
                                     (given.kind == studies::ValueKind::numbers ? "/…" : ",…"));
  }
  const std::vector<std::string> map_names = map_setting_names();
  std::stable_sort(given_.begin(), given_.end(), [&](const auto& a, const auto& b) {
    return speed(a->name, map_names) < speed(b->name, map_names);
  });
}

std::vector<std::string> SweepOptions::values_given(std::string_view name) const {
  const std::vector<std::string>* values = values_of(name);
  return values == nullptr ? std::vector<std::string>{} : *values;
}

const std::vector<std::string>* SweepOptions::values_of(std::string_view name) const {
  const auto found =
      std::find_if(given_.begin(), given_.end(), [&](const auto& given) { return given->name == name; });
  return found == given_.end() || (*found)->values.empty() ? nullptr : &(*found)->values;
}

/// Each option must concern a technique of the sweep.
Expected<void> SweepOptions::check_read() const {
  std::vector<raster::Technique> techniques;
  std::vector<raster::FilterKernel> kernels;
  const auto collect = [&](const char* option, const std::vector<std::string>& fallback, const auto& rows,
                           auto value, auto& out) {
    const std::vector<std::string>* given = values_of(option);
    const std::vector<std::string>& names = given != nullptr ? *given : fallback;
    for (const auto& row : rows)
      if (std::find(names.begin(), names.end(), row.name) != names.end()) out.push_back(row.*value);
  };
  collect("technique", unnamed_, raster::all_technique_traits(), &raster::TechniqueTraits::technique,
          techniques);
  collect("filter-kernel", {"box"}, raster::all_filter_kernel_traits(), &raster::FilterKernelTraits::kernel,
          kernels);
  for (const auto& given : given_) {
    if (given->values.empty()) continue;
    if (const auto read = app::check_read(given->name, techniques, kernels); !read) return read;
  }
  return {};
}

Expected<studies::Grid> SweepOptions::grid(bool zip) const {
  if (const auto read = check_read(); !read) return fail(read.error());
  std::vector<studies::Axis> axes;
  for (const auto& given : given_)
    if (given->values.size() > 1) axes.push_back({given->name, given->values});
  return studies::Grid::make(std::move(axes), zip);
}

Values SweepOptions::fixed() const {
  Values values;
  for (const auto& given : given_)
    if (given->values.size() == 1) values.emplace_back(given->name, given->values.front());
  return values;
}

std::string SweepOptions::arguments() const {
  std::string text;
  for (const auto& given : given_)
    if (!given->values.empty()) text += fmt::format(" --{}={}", given->name, shell_quoted(given->text));
  return text;
}

Values SweepOptions::cell_values(const studies::Grid& grid, std::size_t cell) const {
  Values values = fixed();
  const std::vector<std::size_t> at = grid.position(cell);
  for (std::size_t k = 0; k < at.size(); ++k)
    values.emplace_back(grid.axes()[k].name, grid.axes()[k].values[at[k]]);
  return values;
}

std::vector<std::string> SweepOptions::axes_without_effect(const studies::Grid& grid,
                                                           std::size_t cell) const {
  const Values read = values_read(cell_values(grid, cell));
  std::vector<std::string> without_effect;
  for (const studies::Axis& axis : grid.axes())
    if (std::none_of(read.begin(), read.end(), [&](const auto& entry) { return entry.first == axis.name; }))
      without_effect.push_back(axis.name);
  return without_effect;
}

Expected<SettingOptions> SweepOptions::parse_cell(const studies::Grid& grid, std::size_t cell) const {
  return parse_setting(read_values(grid, cell));
}

Values SweepOptions::read_values(const studies::Grid& grid, std::size_t cell) const {
  return values_read(cell_values(grid, cell));
}

}  // namespace gnomon::app
