// The time budget on the page: where the process's time went, stage by stage, up to the making of the page.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <utility>

#include "compare/result/number_text.h"
#include "report/charts.h"
#include "report/html.h"
#include "report/sections.h"

namespace gnomon::compare {
namespace {

/// What goes on in a stage, where its name alone does not say it.
std::string_view stage_words(std::string_view stage) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 20> words{{
      {"start", "until the command begins"},
      {"rest", "what belongs to no other stage"},
      {"load", "reading and preparing the scene"},
      {"context", "making the OpenGL context"},
      {"upload", "handing the scene to OpenGL"},
      {"driver translation",
       "what the driver makes of shaders when it first draws with them, once for a machine"},
      {"map runs", "the depth map, timed, all runs"},
      {"shading runs", "the picture with its shadows, timed, all runs"},
      {"shading with records", "the picture once more, with what each pixel looked up"},
      {"read-back", "fetching pictures and maps from OpenGL"},
      {"build", "the ray tracer's hierarchy"},
      {"soft shadow rays", "shadow rays to points all over the light"},
      {"ray-traced picture", "shading, reflection and refraction"},
      {"topology", "which triangles hang together"},
      {"columns and sheets", "what lies in the texels that pixels look up"},
      {"labels", "naming the cause of each wrong pixel"},
      {"metrics", "FLIP, SSIM, edges and penumbrae"},
      {"rows kept", "what a picture in bands needs later, on the disk and for this page"},
      {"curve", "the error of every bias"},
      {"exit", "giving memory back, so far"},
  }};
  const auto found =
      std::find_if(words.begin(), words.end(), [&](const auto& w) { return w.first == stage; });
  return found == words.end() ? std::string_view() : found->second;
}

std::string row(std::size_t index, const StageTime& stage, double longest) {
  const auto time = [&](const char* clock, double ms) {
    return keyed(fmt::format("time_budget.{}.{}", index, clock), ms, milliseconds(ms));
  };
  return fmt::format(
      R"(<tr><th scope="row">{}<small>{}</small></th><td class="wide">{}</td><td class="n">{}</td><td
class="n">{}</td></tr>
)",
      stage.stage, stage_words(stage.stage), share_bar(stage.wall_ms / longest, "sum"),
      time("wall_ms", stage.wall_ms), time("cpu_ms", stage.cpu_ms));
}

}  // namespace

std::string time_budget_block(const TimeBudget& budget) {
  double longest = 1e-9;
  for (const StageTime& stage : budget.stages) longest = std::max(longest, stage.wall_ms);
  std::string rows;
  for (std::size_t i = 0; i < budget.stages.size(); ++i) rows += row(i, budget.stages[i], longest);
  return fmt::format(
      R"(<table class="times"><caption>The time budget: every stage of the run, up to this page</caption><thead><tr><th scope="col">stage</th><th scope="col">share of the longest</th><th scope="col"
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
