#include "compare/result/outputs.h"

#include <fmt/core.h>

#include <algorithm>

#include "compare/result/number_text.h"
#include "compare/result/text_layout.h"

namespace gnomon::compare {
namespace {

/// Stages with less than this share of the process are counted together in the short form.
constexpr double named_share = 0.03;

/// Milliseconds down to the clock's nanoseconds, in columns: a later reading is as long as an earlier one.
std::string clocks_text(double wall_ms, double cpu_ms) {
  return fmt::format(R"("wall_ms": {:17.6f}, "cpu_ms": {:17.6f})", wall_ms, cpu_ms);
}

std::string budget_text(const TimeBudget& budget) {
  std::string text =
      fmt::format(" \"process\": {{{}}},\n \"time_budget\": [", clocks_text(budget.wall_ms, budget.cpu_ms));
  std::string_view between = "\n";
  for (const StageTime& s : budget.stages) {
    text += fmt::format("{}  {{\"stage\": \"{}\", {}}}", between, s.stage, clocks_text(s.wall_ms, s.cpu_ms));
    between = ",\n";
  }
  return text + "\n ]\n}\n";
}

std::string short_form(const TimeBudget& budget) {
  std::vector<StageTime> stages = budget.stages;
  std::stable_sort(stages.begin(), stages.end(),
                   [](const StageTime& a, const StageTime& b) { return a.wall_ms > b.wall_ms; });
  const double least = named_share * budget.wall_ms;
  std::string text =
      fmt::format("{}, {} of processor time: ", milliseconds(budget.wall_ms), milliseconds(budget.cpu_ms));
  double others = 0.0;
  int count = 0;
  for (const StageTime& s : stages)
    if (s.wall_ms >= least)
      text += fmt::format("{} {}, ", s.stage, milliseconds(s.wall_ms));
    else
      others += s.wall_ms, ++count;
  return text + fmt::format("{} others {}", count, milliseconds(others));
}

}  // namespace

std::string with_time_budget(std::string document, const TimeBudget& budget) {
  document.erase(document.rfind("\n}"));
  return document + ",\n" + budget_text(budget);
}

std::string with_time_budget(std::string document) {
  const StageLog* log = StageLog::current();
  return log != nullptr ? with_time_budget(std::move(document), log->budget()) : document;
}

std::string time_budget_text(const TimeBudget& budget, bool colour) {
  constexpr std::size_t columns = 80, field_column = 12;
  std::string label = right_padded("process", field_column - 2), text;
  for (const std::string& part : wrapped(short_form(budget), columns - field_column)) {
    text +=
        colour ? fmt::format("  \x1b[2m{}\x1b[0m{}\n", label, part) : fmt::format("  {}{}\n", label, part);
    label = std::string(field_column - 2, ' ');
  }
  return text;
}

}  // namespace gnomon::compare
