#include "studies/judge/page.h"

#include <fmt/core.h>

#include "compare/result/number_text.h"
#include "compare/result/output_parts.h"
#include "compare/result/outputs.h"
#include "report/html.h"
#include "report/sections.h"
#include "studies/judge/advice.h"

namespace gnomon::compare {
namespace {

std::string agreement_text(const Judged& j) {
  std::string text;
  for (const Agreement& one : j.agreement)
    text += fmt::format("{}{} of the {}", text.empty() ? "" : ", ", percent(one.share), one.what);
  return text.empty() ? "nothing to tell it by" : text;
}

std::string renderer_text(const Judged& j) {
  return j.renderer + (j.version.empty() ? "" : " " + j.version);
}

std::string settings_text(const Judged& j) {
  std::string text;
  for (const auto& [key, value] : j.settings)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", key, value);
  return text;
}

std::string identified_text(const Identified& i) {
  return fmt::format(
      "inferred from the picture alone: nearest is {} ({} drawings); it explains {} of the error, and "
      "differs "
      "from the picture by {} in the mean",
      i.options, i.renders, percent(i.explained), percent(i.model_error));
}

std::string ladder_text(const Comparison& c) {
  const Judged& j = *c.judged;
  if (j.has_map)
    return fmt::format(
        "that of its own map, matrix and bias; the test (V5) is what was drawn on {} of the pixels",
        percent(j.biased_is_drawn));
  if (j.identified) return "inferred: that of the nearest setting of Gnomon's own, up to what was drawn";
  return "light size, and one step unexplained: the capture has no map";
}

}  // namespace

std::vector<std::pair<std::string, std::string>> judged_lines(const Comparison& c) {
  const Judged& j = *c.judged;
  std::vector<std::pair<std::string, std::string>> out{{"drawn by", renderer_text(j)}};
  if (!j.settings.empty()) out.emplace_back("settings", settings_text(j));
  out.emplace_back("agreement", agreement_text(j));
  for (const Mended& m : j.mended)
    out.emplace_back("mended", fmt::format("{}: {} of the {} agreed, now {}", m.what, percent(m.before),
                                           m.evidence, percent(m.after)));
  out.emplace_back("ladder", ladder_text(c));
  if (j.identified) out.emplace_back("nearest", identified_text(*j.identified));
  for (const Advice& advice : j.advice) out.emplace_back("advice", advice_text(advice));
  for (const std::string& note : j.notes) out.emplace_back("note", note);
  return out;
}

PageIntroduction judge_introduction(const Comparison& c) {
  PageIntroduction out;
  const std::string who = renderer_text(*c.judged);
  out.title = "Judging " + who + ": " + c.world->scene->name + " \u2013 Gnomon";
  out.links = R"(<li><a href="#judge">Capture</a></li>)";
  std::string rows;
  for (const auto& [name, value] : judged_lines(c))
    rows += fmt::format(R"(<tr><th scope="row">{}</th><td>{}</td></tr>
)",
                        escaped(name), flowing(value));
  out.html =
      fmt::format(R"(<section id="judge" aria-labelledby="judge-title">
<h1 id="judge-title">{}</h1>
{}<p>What follows is the comparison of that picture with the truth{}.</p></section>
)",
                  escaped("What " + who + " drew"),
                  scroll_region("What is said of the capture",
                                "<table class=\"capture\"><tbody>\n" + rows + "</tbody></table>"),
                  c.judged->identified ? "; labels and steps are inferred from the nearest setting" : "");
  return out;
}

}  // namespace gnomon::compare
