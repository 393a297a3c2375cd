#include "studies/check/verdict.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "compare/result/number_text.h"
#include "compare/result/result_parts.h"
#include "report/html.h"
#include "report/shell.h"
#include "scene/files/read_file.h"
#include "scene/files/staged_files.h"
#include "scene/files/write_file.h"
#include "studies/diff/words.h"

namespace gnomon::studies {
namespace {

using Json = nlohmann::ordered_json;
using Outcome = CheckedRun::Outcome;

std::string_view outcome_name(Outcome outcome) {
  return outcome == Outcome::kept ? "kept" : outcome == Outcome::exceeded ? "exceeded" : "failed";
}

std::string since_text(const CheckedRun& run) {
  return run.diff ? std::string(trend_name(run.diff->trend)) : "no baseline";
}

struct Row {
  std::string name, wrong, mean, since, verdict;
};
Row row_of(const CheckedRun& run) {
  const auto percent = [&](double compare::ErrorStats::*share) {
    return run.worst ? compare::percent(run.worst->error.*share) : "\u2013";
  };
  std::string verdict(outcome_name(run.outcome));
  if (!run.why.empty()) verdict += ": " + run.why;
  return {run.name, percent(&compare::ErrorStats::wrong_fraction),
          percent(&compare::ErrorStats::mean_absolute),
          run.outcome == Outcome::failed ? "\u2013" : since_text(run), std::move(verdict)};
}

std::string check_page(const std::vector<CheckedRun>& runs, const std::string& config) {
  using report::escaped;
  const std::size_t bad = std::size_t(
      std::ranges::count_if(runs, [](const CheckedRun& run) { return run.outcome != Outcome::kept; }));
  const std::string title = bad == 0 ? "Every limit is kept" : fmt::format("{} of {} fail", bad, runs.size());
  std::string html = fmt::format(
      "<section><h1>{}</h1>\n<p>By <code>{}</code>. A name opens the scene's report, its trend what has "
      "changed since the baseline.</p>\n"
      "<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"Verdicts\"><table><thead><tr><th "
      "scope=\"col\">scene</th><th "
      "scope=\"col\">wrong</th><th scope=\"col\">mean error</th><th scope=\"col\">since the baseline</th><th "
      "scope=\"col\">limits</th><th "
      "scope=\"col\">verdict</th></tr></thead><tbody>\n",
      title, escaped(config));
  for (const CheckedRun& run : runs) {
    const Row row = row_of(run);
    const std::string folder = report::url_segment(run.name);
    const auto link = [&](bool there, const char* page, const std::string& text) {
      return there ? fmt::format("<a href=\"{}/{}\">{}</a>", folder, page, escaped(text)) : escaped(text);
    };
    html += fmt::format(
        "<tr><th scope=\"row\">{}</th><td class=\"n\">{}</td><td "
        "class=\"n\">{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
        link(run.worst.has_value(), "report.html", run.name), row.wrong, row.mean,
        link(run.diff.has_value(), "diff/report.html", row.since), escaped(run.limits),
        report::flowing(row.verdict));
  }
  return report::static_page(title + " \u2013 Gnomon", html + "</tbody></table></div></section>\n");
}

}  // namespace

Expected<std::vector<compare::LightFigures>> light_figures(const std::string& result_json) {
  const auto text = read_file(result_json);
  if (!text) return fail(text.error());
  std::vector<compare::LightFigures> lights;
  try {
    const Json result = Json::parse(*text);
    for (const Json& light : result.at("lights")) lights.push_back(compare::read_pooled_figures(light));
  } catch (const Json::exception&) {
    lights.clear();
  }
  if (lights.empty()) return fail(Error{ErrorKind::bad_input, "not a whole result", result_json});
  return lights;
}

std::string check_table(const std::vector<CheckedRun>& runs) {
  std::size_t width = 5;
  for (const CheckedRun& run : runs) width = std::max(width, run.name.size());
  std::string text = fmt::format("{:{}}  {:>8}  {:>8}  {:22}  {}\n", "scene", width, "wrong", "mean",
                                 "since the baseline", "verdict");
  for (const CheckedRun& run : runs) {
    const Row row = row_of(run);
    text += fmt::format("{:{}}  {:>8}  {:>8}  {:22}  {}\n", row.name, width, row.wrong, row.mean, row.since,
                        one_line(row.verdict));
  }
  return text;
}

std::string check_json(const std::vector<CheckedRun>& runs, const std::string& config) {
  Json json{{"schema", "gnomon/check/1"}, {"config", config}, {"runs", Json::array()}};
  for (const CheckedRun& run : runs) {
    Json one{{"name", run.name}, {"scene", run.scene}, {"verdict", outcome_name(run.outcome)}};
    one["why"] = run.why.empty() ? Json(nullptr) : Json(run.why);
    one["limits"] = run.limits;
    one["exit_code"] = run.code;
    one["was_there"] = run.was_there;
    one["wrong_fraction"] = run.worst ? compare::number(run.worst->error.wrong_fraction) : Json(nullptr);
    one["mean_absolute"] = run.worst ? compare::number(run.worst->error.mean_absolute) : Json(nullptr);
    one["trend"] = run.diff ? Json(trend_name(run.diff->trend)) : Json(nullptr);
    json["runs"].push_back(std::move(one));
  }
  return visible_order(json.dump(2, ' ', false, Json::error_handler_t::replace)) + "\n";
}

Expected<void> write_check(const std::vector<CheckedRun>& runs, const std::string& config,
                           const std::string& folder, const std::string& json) {
  auto staged = StagedFolder::open(folder);
  if (!staged) return fail(staged.error());
  const std::string document = check_json(runs, config);
  for (const auto& [name, text] :
       {std::pair{"/check.json", document}, {"/report.html", check_page(runs, config)}})
    if (auto written = write_file(staged->path() + name, text); !written) return written;
  StagedFiles also;
  std::vector<FileText> copies;
  if (!json.empty()) copies.push_back({json, document});
  return also.publish(*staged, "report.html", std::vector{config}, copies);
}

}  // namespace gnomon::studies
