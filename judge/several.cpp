#include "judge/several.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "compare/ladder/labels.h"
#include "compare/result/number_text.h"
#include "compare/result/output_parts.h"
#include "judge/advice.h"
#include "report/html.h"
#include "report/shell.h"
#include "scene/base/expected.h"
#include "scene/files/write_file.h"

namespace gnomon::judge {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view no_figures = "nothing compared";

/// The two labels with most of the error.
std::string main_labels(const compare::LightComparison& light) {
  std::vector<std::pair<double, std::string>> shares;
  for (std::size_t k = 0; k < compare::class_count; ++k)
    if (light.class_errors[k] > 0.0)
      shares.emplace_back(light.class_errors[k],
                          compare::label_text(static_cast<compare::Label>(k + 1)).name);
  std::stable_sort(shares.begin(), shares.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string text;
  for (std::size_t k = 0; k < std::min<std::size_t>(2, shares.size()); ++k)
    text +=
        fmt::format("{}{} {}", text.empty() ? "" : ", ", shares[k].second, compare::percent(shares[k].first));
  return text;
}

std::vector<const JudgedRow*> worst_first(const JudgedSet& set) {
  std::vector<const JudgedRow*> rows;
  for (const JudgedRow& row : set.rows) rows.push_back(&row);
  // Rows without figures last.
  const auto rank = [](const JudgedRow& row) {
    return !row.refused.empty() ? 2 : row.figures.pixels.compared == 0 ? 1 : 0;
  };
  const auto wrong = [](const JudgedRow& row) { return row.figures.error.wrong_fraction; };
  std::stable_sort(rows.begin(), rows.end(), [&](const JudgedRow* a, const JudgedRow* b) {
    return rank(*a) != rank(*b) ? rank(*a) < rank(*b) : wrong(*a) > wrong(*b);
  });
  return rows;
}

/// What the page shows of a capture; a refused one has its name and the reason alone.
Json row_json(const JudgedRow& row) {
  Json json{{"name", row.name}};
  if (!row.refused.empty()) {
    json["refused"] = row.refused;
    return json;
  }
  const compare::LightFigures& f = row.figures;
  json.update({{"folder", report::url_segment(row.name)},
               {"scene", row.scene},
               {"renderer", row.renderer},
               {"compared", f.pixels.compared},
               {"wrong", f.error.wrong_fraction},
               {"mean_error", f.error.mean_absolute},
               {"labels", row.labels},
               {"edge_pixels", f.edges.rms_pixels},
               {"detachment_world", f.detachment.pixels > 0 ? Json(f.detachment.mean_world) : Json(nullptr)},
               {"advice", row.advice}});
  return json;
}

std::string judged_line(const JudgedRow& row, std::size_t width) {
  const std::string name = one_line(row.name);
  if (!row.refused.empty()) return fmt::format("{:{}}  not judged: {}\n", name, width, one_line(row.refused));
  const compare::LightFigures& f = row.figures;
  if (f.pixels.compared == 0) return fmt::format("{:{}}  {}\n", name, width, no_figures);
  return fmt::format("{:{}}  {:>8}  {:>8}  {:>7.3f}  {:8}  {}\n", name, width,
                     compare::percent(f.error.wrong_fraction), compare::percent(f.error.mean_absolute),
                     f.edges.rms_pixels, row.ladder, row.labels);
}

std::string judged_page(const JudgedSet& set) {
  Json captures = Json::array();
  for (const JudgedRow* row : worst_first(set)) captures.push_back(row_json(*row));
  report::PageShell shell;
  shell.title = "Captures judged \u2013 Gnomon";
  shell.result = Json{{"captures", std::move(captures)}}.dump(-1, ' ', false, Json::error_handler_t::replace);
  shell.data = R"({"kind": "judged", "labels": []})";
  return report::build_page(shell).html;
}

}  // namespace

JudgedRow judged_row(const std::string& name, const compare::Comparison& c) {
  const compare::LightComparison& light = c.lights.front();
  const compare::Judged& judged = *c.judged;
  JudgedRow row;
  row.name = name, row.scene = c.world->scene->name;
  row.renderer = judged.renderer + (judged.version.empty() ? "" : " " + judged.version);
  row.ladder = judged.has_map ? "map" : judged.identified ? "inferred" : "none";
  row.labels = (judged.identified ? "inferred: " : "") + main_labels(light);
  row.figures = light;
  for (const compare::Advice& advice : judged.advice)
    row.advice += (row.advice.empty() ? "" : "; ") + compare::advice_text(advice);
  return row;
}

void JudgedSet::add(const std::string& name, const compare::Comparison& comparison) {
  const Json line = compare::line_json(comparison, {{"capture", name}});
  lines += compare::on_one_line(line);
  table.add(rows.size(), line,
            compare::cell_times_json(comparison, rows.size(), {.ms = comparison.total_ms}));
  rows.push_back(judged_row(name, comparison));
}

void JudgedSet::add_refused(const std::string& name, const std::string& why) {
  JudgedRow row;
  row.name = name, row.refused = why;
  rows.push_back(std::move(row));
}

std::string judged_table(const JudgedSet& set) {
  std::size_t width = 8;
  for (const JudgedRow& row : set.rows) width = std::max(width, one_line(row.name).size());
  std::string text = fmt::format("{:{}}  {:>8}  {:>8}  {:>7}  {:8}  {}\n", "capture", width, "wrong", "mean",
                                 "edge px", "ladder", "mostly");
  for (const JudgedRow* row : worst_first(set)) text += judged_line(*row, width);
  return text;
}

Expected<void> write_judged_set(const JudgedSet& set, const std::string& folder) {
  if (const auto lines = write_file(folder + "/judge.jsonl", set.lines); !lines) return lines;
  if (const auto table = write_file(folder + "/judge.csv", set.table.text()); !table) return table;
  return write_file(folder + "/report.html", judged_page(set));
}

}  // namespace gnomon::judge
