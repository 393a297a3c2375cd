#include "compare/sweep/page.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include <embedded/sweep.h>

#include "compare/number_text.h"
#include "compare/option_names.h"
#include "compare/report/html.h"
#include "compare/report/page.h"
#include "compare/sweep/charts.h"
#include "scene/files/write_file.h"

namespace gnomon::compare {
namespace {

using Json = nlohmann::ordered_json;

std::string style() {
  return std::string(page_style()) + std::string(embedded::sweep("sweep.css"));
}

std::string head(const std::string& title) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n<title>{}</title>\n<link rel=\"icon\" "
      "href=\"data:,\">\n<style>{}</style>\n</head>\n",
      page_security_policy(style(), embedded::sweep("sweep.js")), escaped(title), style());
}

// "The 24 cells leave between 0.1 % and 12 % wrong; …"
std::string sentence(const std::vector<CellSummary>& cells, const std::vector<std::size_t>& front) {
  double least = 1.0, most = 0.0;
  for (const CellSummary& cell : cells)
    least = std::min(least, cell.wrong_fraction), most = std::max(most, cell.wrong_fraction);
  std::string text = cells.size() == 1 ? fmt::format("The one cell leaves {} wrong.", percent(least))
                                       : fmt::format("{} cells leave between {} and {} of the pixels wrong.",
                                                     grouped(cells.size()), percent(least), percent(most));
  if (!front.empty())
    text += fmt::format(" For accuracy against time, {} of them {} worth having.", front.size(),
                        front.size() == 1 ? "is" : "are");
  return text;
}

std::string cost_charts(const std::vector<CellSummary>& cells, const std::vector<std::size_t>& front) {
  std::string out = "<section id=\"cost\"><h2>What accuracy costs</h2>\n";
  if (const std::string chart = pareto_chart(cells, front); !chart.empty()) {
    out += "<h3>Wrong pixels against time</h3>\n<figure><div class=\"scroll\">" + chart +
           "</div><figcaption>Each cell is a point and leads to its row in the table; the line joins those "
           "that no "
           "other beats in both. The diamond is the ray tracer, whose verdicts are the truth here.";
    if (std::any_of(cells.begin(), cells.end(), [](const CellSummary& c) { return c.derived; }))
      out += " Cells that differ in the constant bias alone come from one drawing and share its time.";
    out += "</figcaption></figure>\n";
  }
  if (const std::string chart = size_chart(cells); !chart.empty())
    out +=
        "<h3>Wrong pixels against map size</h3>\n<figure><div class=\"scroll\">" + chart +
        "</div><figcaption>The best cell of each size. An error that is all sampling falls along the dotted "
        "line.</figcaption></figure>\n";
  return out + "</section>\n";
}

std::string shown(double value) {
  return std::isfinite(value) ? plain_number(value) : std::string("\u2013");
}

// <td> with the number that sorting goes by.
std::string number_cell(double value, const std::string& text) {
  return fmt::format("<td class=\"n\" data-sort=\"{}\">{}</td>",
                     std::isfinite(value) ? fmt::to_string(value) : "", escaped(text));
}

std::string table_row(const CellSummary& cell, bool on_front, bool perceptual) {
  std::string out =
      fmt::format("<tr id=\"cell-{}\"{}><th scope=\"row\" class=\"n\" data-sort=\"{}\">{}{}</th>", cell.cell,
                  on_front ? " class=\"front-row\"" : "", cell.cell, cell.cell,
                  on_front ? " <abbr title=\"on the Pareto front\">\u2605</abbr>" : "");
  for (const auto& [name, value] : cell.axes)
    out += fmt::format("<td class=\"n\" data-sort=\"{0}\">{0}</td>", escaped(value));
  out += number_cell(cell.wrong_fraction, percent(cell.wrong_fraction));
  out += number_cell(double(cell.false_shadow), grouped(cell.false_shadow));
  out += number_cell(double(cell.missed_shadow), grouped(cell.missed_shadow));
  out += fmt::format("<td>{}</td>", escaped(cell.main_label));
  out += number_cell(cell.rms, shown(cell.rms));
  if (perceptual) out += number_cell(cell.flip, shown(cell.flip)) + number_cell(cell.ssim, shown(cell.ssim));
  out += number_cell(cell.edge_rms_texels, shown(cell.edge_rms_texels));
  out += number_cell(cell.raster_ms, std::isfinite(cell.raster_ms) ? milliseconds(cell.raster_ms) : "\u2013");
  out += number_cell(double(cell.map_texels), grouped(cell.map_texels));
  out += number_cell(double(cell.map_bytes), byte_count(cell.map_bytes));
  return out + fmt::format("<td class=\"run\"><code>{}</code></td></tr>\n", escaped(cell.command));
}

std::string table(const std::vector<CellSummary>& cells, const std::vector<std::size_t>& front) {
  const bool perceptual = std::isfinite(cells.front().flip);
  std::vector<std::string> columns{"cell"};
  for (const auto& [name, value] : cells.front().axes) columns.push_back(name);
  for (const char* name : {"wrong", "false shadow", "missed shadow", "mostly", "RMS"})
    columns.emplace_back(name);
  if (perceptual) columns.emplace_back("FLIP"), columns.emplace_back("SSIM");
  for (const char* name : {"edge RMS, texels", "time", "texels", "map", "command"})
    columns.emplace_back(name);
  std::string out =
      "<section id=\"cells\"><h2>Cells</h2>\n<div class=\"scroll\"><table class=\"cells\"><thead><tr>";
  for (const std::string& name : columns) out += fmt::format("<th scope=\"col\">{}</th>", escaped(name));
  out += "</tr></thead><tbody>\n";
  for (std::size_t i = 0; i < cells.size(); ++i)
    out += table_row(cells[i], std::find(front.begin(), front.end(), i) != front.end(), perceptual);
  return out + "</tbody></table></div></section>\n";
}

std::string fact(std::string_view name, const std::string& value) {
  return fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", name, escaped(value));
}

std::string provenance(const SweepHeader& header) {
  const Json json = Json::parse(header.configuration);
  std::string out = "<section id=\"provenance\"><h2>Provenance</h2>\n<dl class=\"provenance\">\n";
  out += fact("Program", fmt::format("gnomon {}", program_version()));
  for (const auto& [key, value] : json.items()) {
    if (key == "axes" || value.is_null()) continue;
    out += fact(key, value.is_string() ? value.get<std::string>() : value.dump());
  }
  for (const Json& axis : json.value("axes", Json::array())) {
    const Json& values = axis.at("values");
    const std::string list = values.size() <= 12 ? values.dump()
                                                 : fmt::format("{} values from {} to {}", values.size(),
                                                               values.front().dump(), values.back().dump());
    out += fact("axis " + axis.at("name").get<std::string>(), list);
  }
  return out +
         "</dl>\n<p class=\"save\"><a class=\"button\" href=\"sweep.csv\">sweep.csv</a> <a class=\"button\" "
         "href=\"sweep.jsonl\">sweep.jsonl</a> <a class=\"button\" "
         "href=\"sweep_times.jsonl\">sweep_times.jsonl</a></p></section>\n";
}

std::string read_all(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

std::string sweep_page(const SweepHeader& header, const std::vector<CellSummary>& cells,
                       const Thumbnails& thumbnails) {
  const std::string scene = Json::parse(header.configuration).value("/scene/name"_json_pointer, "");
  const std::vector<std::size_t> front = pareto_front(cells);
  std::string page = head("Sweep of " + scene + " \u2013 Gnomon") +
                     "<body>\n<a class=\"skip\" href=\"#top\">Skip to "
                     "the report</a>\n<header class=\"bar-top\"><span class=\"brand\">Gnomon</span>\n<nav "
                     "aria-label=\"Sections\"><ul>"
                     "<li><a href=\"#cost\">Cost</a></li><li><a href=\"#grid\">Grid</a></li><li><a "
                     "href=\"#cells\">Cells</a></li>"
                     "<li><a href=\"#provenance\">Provenance</a></li></ul></nav></header>\n<main>\n";
  page += fmt::format("<section id=\"top\"><h1>Sweep of {}</h1>\n<p class=\"verdict\">{}</p></section>\n",
                      escaped(scene), escaped(sentence(cells, front)));
  page += cost_charts(cells, front);
  if (const std::string grids = thumbnail_grids(cells, thumbnails); !grids.empty())
    page +=
        "<section id=\"grid\"><h2>Grid</h2>\n<p class=\"hint\">The ray-traced picture in grey; "
        "<b class=\"false-text\">orange</b>: drawn dark, truly lit; <b class=\"missed-text\">blue</b>: drawn "
        "lit, "
        "truly dark. The number is the share of wrong pixels.</p>\n" +
        grids + "</section>\n";
  page += table(cells, front) + provenance(header) + "</main>\n";
  return page.append("<script>").append(embedded::sweep("sweep.js")).append("</script>\n</body>\n</html>\n");
}

std::string thumbnail_path(const std::string& folder, std::size_t cell) {
  return fmt::format("{}/thumbnails/cell-{:06}.png", folder, cell);
}

bool has_thumbnail(std::size_t cell, std::size_t cells) {
  if (cells <= max_thumbnails) return true;
  // Cell i is the k-th chosen where floor(k * cells / max) = i.
  const std::size_t k = (cell * max_thumbnails + cells - 1) / cells;
  return k < max_thumbnails && k * cells / max_thumbnails == cell;
}

Expected<void> write_sweep_page(const std::string& folder) {
  const auto sweep = read_sweep(folder);
  if (!sweep) return fail(sweep.error());
  const auto cells = summarise(*sweep);
  if (!cells) return fail(cells.error());
  if (cells->empty()) return {};
  Thumbnails thumbnails;
  for (const CellSummary& cell : *cells)
    if (std::string png = read_all(thumbnail_path(folder, cell.cell)); !png.empty())
      thumbnails[cell.cell] = std::move(png);
  return write_file(folder + "/report.html", sweep_page(sweep->header, *cells, thumbnails));
}

}  // namespace gnomon::compare
