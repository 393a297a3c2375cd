#include "compare/time_budget.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "compare/number_text.h"
#include "compare/text_layout.h"

namespace gnomon::compare {
namespace {

using Json = nlohmann::ordered_json;

/// Stages with less than this share of the process are counted together in the short form.
constexpr double named_share = 0.03;

Json budget_json(const TimeBudget& budget) {
  Json stages = Json::array();
  for (const StageTime& s : budget.stages)
    stages.push_back({{"stage", s.stage}, {"wall_ms", s.wall_ms}, {"cpu_ms", s.cpu_ms}});
  return {{"process", {{"wall_ms", budget.wall_ms}, {"cpu_ms", budget.cpu_ms}}},
          {"time_budget", std::move(stages)}};
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
  const std::string added = budget_json(budget).dump(2);
  document.erase(document.rfind("\n}"));
  return document + "," + added.substr(added.find('\n'), std::string::npos) + "\n";
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
