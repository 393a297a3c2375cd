// The options of a sweep: those of `compare`, by the same names, each taking lists and ranges
// (studies/sweep/axis.h). They are read off compare's own parser and every value is checked by it. So units,
// ranges and messages are the same, and a new option is an axis by itself.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/options/setting_options.h"
#include "studies/sweep/axis.h"

namespace CLI {
class App;
}

namespace gnomon::app {

/// What was given for each option, in the canonical order: what changes the truth first, then what changes
/// the map, the constant bias last. So cells that share work are neighbours.
class SweepOptions {
 public:
  /// The techniques that are meant when none is named: hard, unless said otherwise here.
  void mean_techniques(std::vector<std::string> names) { unnamed_ = std::move(names); }

  /// Registers every option of add_setting_options.
  void add_to(CLI::App& command);

  /// The options that were given several values. Error (usage): an option that no technique of the sweep
  /// reads.
  Expected<studies::Grid> grid(bool zip) const;
  /// The options that were given one value: name and value.
  std::vector<std::pair<std::string, std::string>> fixed() const;

  /// All values that were given for one option; none where it was not given.
  std::vector<std::string> values_given(std::string_view name) const;

  /// What was given, as it was given: " --bias 0:0.1:64", quoted for a shell.
  std::string arguments() const;

  /// The setting with the grid's values of one cell.
  Expected<SettingOptions> parse_cell(const studies::Grid& grid, std::size_t cell) const;
  /// The axes that have no effect on a cell: its technique does not read them.
  std::vector<std::string> axes_without_effect(const studies::Grid& grid, std::size_t cell) const;
  /// What compare would be given for that cell, without what has no effect.
  std::vector<std::pair<std::string, std::string>> read_values(const studies::Grid& grid,
                                                               std::size_t cell) const;

 private:
  struct Given {
    std::string name;  ///< without "--"
    bool flag = false;
    studies::ValueKind kind = studies::ValueKind::number;
    std::string text;  ///< as it was given
    std::vector<std::string> values;
  };
  Expected<void> check_read() const;
  const std::vector<std::string>* values_of(std::string_view name) const;
  std::vector<std::pair<std::string, std::string>> cell_values(const studies::Grid& grid,
                                                               std::size_t cell) const;
  std::vector<std::string> unnamed_{"hard"};
  std::vector<std::unique_ptr<Given>> given_;
};

}  // namespace gnomon::app
