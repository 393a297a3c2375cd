// The grid of thumbnails. A thumbnail shows the ray-traced picture in grey with false shadow and missed
// shadow in their two colours; under it stands the share of wrong pixels, so that colour never speaks alone.
#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "compare/result/number_text.h"
#include "report/html.h"
#include "studies/sweep/cell_files.h"
#include "studies/sweep/page.h"
#include "studies/sweep/words.h"

namespace gnomon::compare {
namespace {

constexpr std::size_t max_grids = 24;

using Values = std::vector<std::string>;
using CellNumbers = std::set<std::size_t>;

struct Layout {
  std::size_t row_axis = 0, column_axis = 0;
  Values rows, columns;
};

Values values_of(const std::vector<CellSummary>& cells, std::size_t axis) {
  Values values;
  for (const CellSummary& cell : cells)
    if (std::find(values.begin(), values.end(), cell.axes[axis].second) == values.end())
      values.push_back(cell.axes[axis].second);
  return values;
}

// "technique pcf, cull none": the axes that are neither rows nor columns.
std::string rest_of(const CellSummary& cell, const Layout& layout) {
  std::string text;
  for (std::size_t k = 0; k < cell.axes.size(); ++k)
    if (k != layout.row_axis && k != layout.column_axis)
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", axis_words(cell.axes[k].first),
                          value_words(cell.axes[k].second));
  return text;
}

std::string cell_html(const SweepPageInput& in, const CellSummary& cell, bool on_front) {
  const auto pictures = in.pictures.find(cell.cell);
  const std::string share = percent(cell.wrong_fraction);
  std::string picture;
  if (pictures != in.pictures.end())
    picture = fmt::format("<img loading=\"lazy\" alt=\"{} wrong\" src=\"{}\">", escaped(share),
                          in.beside ? fmt::format("thumbnails/{}.png", cell_name(cell.cell))
                                    : data_uri("image/png", pictures->second.thumbnail));
  return fmt::format("<td><a href=\"#cell-{}\">{}<span>{}{}</span></a></td>", cell.cell, picture,
                     escaped(share), on_front ? " \u2605" : "");
}

std::string grid_html(const SweepPageInput& in, const std::vector<const CellSummary*>& cells,
                      const Layout& layout, const std::string& rest, const CellNumbers& best) {
  const std::string row_name = axis_words(cells.front()->axes[layout.row_axis].first);
  const std::string column_name = axis_words(cells.front()->axes[layout.column_axis].first);
  const bool one_axis = layout.row_axis == layout.column_axis;
  std::string out = fmt::format(
      "<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"Grid: {0}\"><table "
      "class=\"grid\"><caption>{0}</caption><thead><tr>",
      escaped(rest.empty() ? (one_axis ? column_name : row_name + " by " + column_name) : rest));
  if (!one_axis) out += fmt::format("<td>{} \u2193 {} \u2192</td>", escaped(row_name), escaped(column_name));
  for (const std::string& value : layout.columns)
    out += fmt::format("<th scope=\"col\">{}</th>", escaped(value_words(value)));
  out += "</tr></thead><tbody>";
  for (const std::string& row : one_axis ? Values{""} : layout.rows) {
    out += one_axis ? "<tr>" : fmt::format("<tr><th scope=\"row\">{}</th>", escaped(value_words(row)));
    for (const std::string& column : layout.columns) {
      const auto found = std::find_if(cells.begin(), cells.end(), [&](const CellSummary* cell) {
        return cell->axes[layout.column_axis].second == column &&
               (one_axis || cell->axes[layout.row_axis].second == row);
      });
      out += found == cells.end() ? "<td></td>" : cell_html(in, **found, best.contains((*found)->cell));
    }
    out += "</tr>";
  }
  return out + "</tbody></table></div>\n";
}

}  // namespace

std::string thumbnail_grids(const SweepPageInput& in, const std::vector<std::size_t>& front) {
  CellNumbers best;
  for (const std::size_t i : front) best.insert(in.cells[i].cell);
  // Of a long axis only the cells with a thumbnail are shown.
  std::vector<CellSummary> cells;
  for (const CellSummary& cell : in.cells)
    if (in.pictures.empty() || in.pictures.contains(cell.cell)) cells.push_back(cell);
  if (cells.empty() || cells.front().axes.empty()) return {};
  Layout layout;
  layout.column_axis = cells.front().axes.size() - 1;
  layout.rows = values_of(cells, layout.row_axis);
  layout.columns = values_of(cells, layout.column_axis);
  Values rests;
  std::vector<std::vector<const CellSummary*>> groups;
  for (const CellSummary& cell : cells) {
    const std::string rest = rest_of(cell, layout);
    const auto index = static_cast<std::size_t>(std::find(rests.begin(), rests.end(), rest) - rests.begin());
    if (index == rests.size()) {
      rests.push_back(rest);
      groups.emplace_back();
    }
    groups[index].push_back(&cell);
  }
  std::string out;
  for (std::size_t i = 0; i < groups.size() && i < max_grids; ++i)
    out += grid_html(in, groups[i], layout, rests[i], best);
  if (groups.size() > max_grids)
    out += fmt::format("<p class=\"hint\">{} more combinations are in the table.</p>\n",
                       groups.size() - max_grids);
  return out;
}

}  // namespace gnomon::compare
