#include "studies/tune/page.h"

#include <fmt/core.h>

#include <cmath>

#include "compare/bias/bias_advice.h"
#include "compare/result/figures.h"
#include "compare/result/number_text.h"
#include "raster/technique_traits.h"
#include "report/html.h"
#include "report/sections.h"

namespace gnomon::compare {
namespace {

std::string goal_text(const TuneGoal& goal) {
  return goal.max_error ? limit_words(*goal.max_error)
                        : "at most " + milliseconds(*goal.max_time_ms) + " for map and shading";
}

bool reads_bias(const TuneFamily& family, const Attempt& attempt) {
  return compares_depths(family.map.technique) && attempt.reads_bias;
}

// World units, "0.25 texel", "auto": the constant in the unit that the command asks for it in.
std::string constant_words(const raster::Bias& bias) {
  if (bias.unit == raster::BiasUnit::automatic) return "auto";
  const std::string text = plain_number(bias.constant);
  if (bias.unit == raster::BiasUnit::world) return text;
  return text + (std::abs(bias.constant) > 1.0 ? " texels" : " texel");
}

std::string verdict(const TunePageInput& in) {
  const FamilyResult& winner = in.result.families[in.result.winner];
  const Attempt& a = winner.attempt();
  const std::string answer = fmt::format(
      "{}, {} \u00d7 {} texels{}. Compared as below it gives {}, in {}.", winner.family.name, a.size, a.size,
      reads_bias(winner.family, a) ? ", bias " + constant_words(a.bias) : std::string(),
      figure_words(a.figures, in.goal.measure()), milliseconds(a.time_ms));
  const std::string wanted = "Wanted: " + goal_text(in.goal) + ". ";
  if (!in.result.feasible) return wanted + "No map that was tried gives that. Nearest comes " + answer;
  return wanted + (in.goal.max_error ? "The cheapest map that gives it: " : "The best map within it: ") +
         answer;
}

// Why no constant bias can be right everywhere, and where the two sets of pixels are seen.
std::string proof(const TunePageInput& in) {
  const FamilyResult& winner = in.result.families[in.result.winner];
  const Attempt& a = winner.attempt();
  if (in.result.feasible || !has_proof(a)) return {};
  const std::string_view seen = names_both_bounds(a.best)
                                    ? R"( In the picture of differences below the first are those that turn
<b class="false-text">orange</b> when the bias is dragged to the left of that, the second those that turn
<b class="missed-text">blue</b> to the right of it.)"
                                    : "";
  return fmt::format("<p class=\"lead\">{}{}</p>\n",
                     flowing(contradiction(a.best, a.texel_world, winner.family.map.bias)), seen);
}

// Wrong pixels, mean error, and what the goal is about besides.
std::string figure_cells(const Figure& measure, const LightFigures& f) {
  std::string cells = fmt::format(R"(<td class="n">{}</td><td class="n">{}</td>)",
                                  percent(f.error.wrong_fraction), percent(f.error.mean_absolute));
  if (measure.form() != FigureForm::percent)
    cells += fmt::format(R"(<td class="n">{}</td>)", plain_number(measure.of(f)));
  return cells;
}
std::string figure_heads(const Figure& measure) {
  std::string heads = R"(<th scope="col" class="n">wrong</th><th scope="col" class="n">mean error</th>)";
  if (measure.form() != FigureForm::percent)
    heads += fmt::format(R"(<th scope="col" class="n">{}</th>)", figure_head(measure));
  return heads;
}

std::string family_row(const TunePageInput& in, std::size_t i) {
  const FamilyResult& family = in.result.families[i];
  const Attempt& a = family.attempt();
  const bool winner = i == in.result.winner;
  return fmt::format(
      R"(<tr{}><th scope="row">{}{}<small>{}</small></th><td class="n">{}</td><td
class="n">{}</td>{}<td class="n">{}</td><td class="run"><code>{}</code></td></tr>
)",
      winner ? " class=\"front-row\"" : "", escaped(family.family.name),
      winner && in.result.feasible ? " <abbr title=\"the answer\">\u2605</abbr>" : "", escaped(family.why),
      a.size, reads_bias(family.family, a) ? constant_words(a.bias) : "\u2013",
      figure_cells(in.goal.measure(), a.figures), milliseconds(a.time_ms), escaped(in.commands[i]));
}

std::string family_table(const TunePageInput& in) {
  std::string rows = family_row(in, in.result.winner);
  for (const std::size_t i : in.order) rows += family_row(in, i);
  return scroll_region("What was tried",
                       R"(<table class="families"><thead><tr><th scope="col">technique and bias</th><th
scope="col" class="n">texels</th><th scope="col" class="n">bias</th>)" +
                           figure_heads(in.goal.measure()) +
                           R"(<th scope="col" class="n">time</th><th
scope="col" class="run">command</th></tr></thead><tbody>
)" + rows + "</tbody></table>");
}

}  // namespace

PageIntroduction tune_introduction(const TunePageInput& in) {
  PageIntroduction out;
  out.title = "Tuning " + in.scene + " \u2013 Gnomon";
  out.links = R"(<li><a href="#tune">Answer</a></li>)";
  out.html = fmt::format(R"(<section id="tune" aria-labelledby="tune-title">
<h1 id="tune-title">Tuning {}</h1>
<p class="verdict">{}</p>
<p class="command"><code>{}</code></p>
)",
                         escaped(in.scene), flowing(verdict(in)), escaped(in.commands[in.result.winner]));
  out.html += proof(in);
  if (const std::string chart = tune_cost_chart(in.goal, in.result); !chart.empty())
    out.html +=
        "<h2>What accuracy costs</h2>\n<figure>" + scroll_region("Error against time", chart) +
        "<figcaption>Each point is a map that was drawn, at the best bias found for it; the line joins "
        "those that no other beats in both, the large point is the answer.</figcaption></figure>\n";
  out.html +=
      fmt::format(R"(<h2>What was tried</h2>
<p>{} {}. The star is the answer; beside each of the others stands why it is not.</p>
{})",
                  in.result.renders,
                  in.goal.measure().needs == FigureNeeds::film
                      ? "films: each technique was searched over map sizes, with the bias that it has where "
                        "none is asked for"
                      : "drawings: each kind of bias was searched over map sizes, and one drawing tells the "
                        "error of every constant bias",
                  family_table(in));
  if (const std::string chart = tune_chart(in.result); !chart.empty())
    out.html +=
        "<h3>How the error depends on the bias</h3>\n<figure>" +
        scroll_region("Wrong pixels against the bias of each kind", chart) +
        "<figcaption>At most six kinds: of those that are good enough the cheapest, then the nearest. Each "
        "at the "
        "map size of its row above; a dot marks the best constant bias. Texels of the one map are not as "
        "wide as those of another.</figcaption></figure>\n";
  out.html += "<p>What follows is the comparison at that answer.</p></section>\n";
  return out;
}

}  // namespace gnomon::compare
