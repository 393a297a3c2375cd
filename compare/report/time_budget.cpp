// The time budget on the page: where the process's time went, stage by stage, up to the making of the page.
#include <fmt/format.h>

#include <algorithm>

#include "compare/number_text.h"
#include "compare/report/charts.h"
#include "compare/report/html.h"
#include "compare/report/sections.h"

namespace gnomon::compare {
namespace {

std::string row(std::size_t index, const StageTime& stage, double longest) {
  const auto time = [&](const char* clock, double ms) {
    return keyed(fmt::format("time_budget.{}.{}", index, clock), ms, milliseconds(ms));
  };
  return fmt::format(
      R"(<tr><th scope="row">{}</th><td class="wide">{}</td><td class="n">{}</td><td class="n">{}</td></tr>
)",
      stage.stage, share_bar(stage.wall_ms / longest, "sum"), time("wall_ms", stage.wall_ms),
      time("cpu_ms", stage.cpu_ms));
}

}  // namespace

std::string time_budget_block(const TimeBudget& budget) {
  double longest = 1e-9;
  for (const StageTime& stage : budget.stages) longest = std::max(longest, stage.wall_ms);
  std::string rows;
  for (std::size_t i = 0; i < budget.stages.size(); ++i) rows += row(i, budget.stages[i], longest);
  return fmt::format(
      R"(<table class="times"><caption>The time budget: every stage of the run, up to this page</caption><thead
class="quiet"><tr><th scope="col">stage</th><th scope="col">share of the longest</th><th scope="col"
class="n">wall clock</th><th scope="col" class="n">processor</th></tr></thead><tbody>
{}<tr class="sum"><th scope="row">sum: the process</th><td class="wide"></td><td class="n">{}</td><td
class="n">{}</td></tr></tbody></table>
<p class="hint">Processor time is that of all threads. What comes after this point, putting the page together,
writing it and giving the memory back, is in <code>result.json</code> beside this page, which is written
last.</p>
)",
      rows, keyed("process.wall_ms", budget.wall_ms, milliseconds(budget.wall_ms)),
      keyed("process.cpu_ms", budget.cpu_ms, milliseconds(budget.cpu_ms)));
}

}  // namespace gnomon::compare
