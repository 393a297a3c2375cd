// The table of a sweep's cells. The scripts make its columns sortable and its commands easy to copy.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/result/number_text.h"
#include "report/html.h"
#include "studies/sweep/page.h"
#include "studies/sweep/words.h"

namespace gnomon::compare {
namespace {

std::string shown(double value) {
  return std::isfinite(value) ? plain_number(value) : std::string("\u2013");
}

constexpr const char *mostly = "mostly", *command = "command";  // the columns of words

// <td> with the number that sorting goes by.
std::string number_cell(double value, const std::string& text) {
  return fmt::format("<td class=\"n\" data-sort=\"{}\">{}</td>",
                     std::isfinite(value) ? fmt::to_string(value) : "", escaped(text));
}

std::string table_row(const CellSummary& cell, bool on_front, bool perceptual) {
  std::string out = fmt::format(
      "<tr id=\"cell-{0}\"{1}><th scope=\"row\" class=\"n\" data-sort=\"{0}\"><a "
      "href=\"#cell-{0}\">{0}</a>{2}</th>",
      cell.cell, on_front ? " class=\"front-row\"" : "",
      on_front ? " <abbr title=\"worth having\">\u2605</abbr>" : "");
  for (const auto& [name, value] : cell.axes) {
    const bool idle = std::find(cell.no_effect.begin(), cell.no_effect.end(), name) != cell.no_effect.end();
    out += fmt::format("<td class=\"n\" data-sort=\"{}\">{}{}</td>", escaped(value),
                       escaped(value_words(value)), idle ? " (no effect)" : "");
  }
  if (cell.is_filmed()) out += number_cell(cell.flips_per_second, plain_number(cell.flips_per_second));
  out += number_cell(cell.wrong_fraction, percent(cell.wrong_fraction));
  out += number_cell(double(cell.false_shadow), grouped(cell.false_shadow));
  out += number_cell(double(cell.missed_shadow), grouped(cell.missed_shadow));
  out += fmt::format("<td>{}</td>", escaped(label_words_of(cell.main_label)));
  out += number_cell(cell.mean_absolute, percent(cell.mean_absolute));
  out += number_cell(cell.rms, shown(cell.rms));
  if (perceptual) out += number_cell(cell.flip, shown(cell.flip)) + number_cell(cell.ssim, shown(cell.ssim));
  out += number_cell(cell.edge_rms_texels, shown(cell.edge_rms_texels));
  out += number_cell(cell.raster_ms, std::isfinite(cell.raster_ms) ? milliseconds(cell.raster_ms) : "\u2013");
  out += cell.shadows.timed() ? number_cell(cell.shadows.median, milliseconds(cell.shadows))
                              : number_cell(std::numeric_limits<double>::quiet_NaN(), "\u2013");
  out += number_cell(double(cell.map_texels), grouped(cell.map_texels));
  out += number_cell(double(cell.map_bytes), byte_count(cell.map_bytes));
  return out + fmt::format("<td class=\"run\"><code>{}</code></td></tr>\n", escaped(cell.command));
}

}  // namespace

std::string cell_table(const std::vector<CellSummary>& cells, const std::vector<std::size_t>& front) {
  const bool perceptual = std::isfinite(cells.front().flip);
  std::vector<std::string> columns{"cell"};
  for (const auto& [name, value] : cells.front().axes) columns.push_back(axis_words(name));
  if (cells.front().is_filmed()) columns.emplace_back("flips per receiver and second");
  for (const char* name : {"wrong", "false shadow", "missed shadow", mostly, "mean error", "RMS error"})
    columns.emplace_back(name);
  if (perceptual) columns.emplace_back("FLIP"), columns.emplace_back("SSIM");
  for (const char* name :
       {"edge error, texels", "time", "shadows alone", "texels drawn", "map memory", command})
    columns.emplace_back(name);
  std::string out =
      "<section id=\"cells\" aria-labelledby=\"cells-title\"><h2 id=\"cells-title\">Cells</h2>\n<p "
      "class=\"hint\">Each cell is one combination of settings. \u2605: worth "
      "having. Time is that of map and shading; shadows alone are the map "
      "and what looking it up adds to the same shading without shadows, with the interval that the runs "
      "leave it; errors of visibility are between 0 and 1.</p>\n<div "
      "class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"Table of cells\"><table "
      "class=\"cells\"><thead><tr>";
  for (const std::string& name : columns)
    out += fmt::format("<th scope=\"col\"{}>{}</th>", name == mostly || name == command ? "" : " class=\"n\"",
                       escaped(name));
  out += "</tr></thead><tbody>\n";
  for (std::size_t i = 0; i < cells.size(); ++i)
    out += table_row(cells[i], std::find(front.begin(), front.end(), i) != front.end(), perceptual);
  return out + "</tbody></table></div></section>\n";
}

}  // namespace gnomon::compare
