// What the sweep page's script reads: words, axes, and of each cell what the viewer says of it. The cells'
// pictures are parts of the data, or files beside the page (cell_files.h).
#include <algorithm>
#include <nlohmann/json.hpp>

#include "compare/result/number_text.h"
#include "report/page_data.h"
#include "studies/sweep/page.h"
#include "studies/sweep/words.h"

namespace gnomon::compare {
namespace {

using Json = nlohmann::ordered_json;

// "4.1 % wrong, mean error 4.1 %: false shadow 12, missed shadow 3, mostly acne; 12 ms …"
std::string cell_line(const CellSummary& cell) {
  std::string text = (cell.is_filmed() ? error_words(cell) + "; " : std::string()) +
                     percent(cell.wrong_fraction) + " wrong, mean error " + percent(cell.mean_absolute) +
                     ": false shadow " + grouped(cell.false_shadow) + ", missed shadow " +
                     grouped(cell.missed_shadow);
  if (!cell.main_label.empty()) text += ", mostly " + label_words_of(cell.main_label);
  if (std::isfinite(cell.raster_ms)) text += "; " + milliseconds(cell.raster_ms) + " for map and shading";
  return text;
}

Json cell_json(const SweepPageInput& in, const CellSummary& cell, bool on_front) {
  Json values = Json::array();
  Json shown = Json::array();
  for (const auto& [name, value] : cell.axes) values.push_back(value), shown.push_back(value_words(value));
  const auto pictures = in.pictures.find(cell.cell);
  return {{"cell", cell.cell},
          {"values", std::move(values)},
          {"shown", std::move(shown)},
          {"wrong", cell.wrong_fraction},
          {"front", on_front},
          {"line", cell_line(cell)},
          {"command", cell.command},
          {"pictures", pictures != in.pictures.end() && !pictures->second.data.empty()},
          {"drawn", pictures != in.pictures.end() && !pictures->second.drawing.empty()}};
}

}  // namespace

std::string sweep_page_data(const SweepPageInput& in, const std::vector<std::size_t>& front) {
  Json axes = Json::array(), cells = Json::array();
  for (const auto& [name, value] : in.cells.front().axes) axes.push_back(name);
  for (std::size_t i = 0; i < in.cells.size(); ++i)
    cells.push_back(cell_json(in, in.cells[i], std::find(front.begin(), front.end(), i) != front.end()));
  return Json{{"kind", "sweep"},
              {"labels", Json::parse(label_words())},
              {"axes", std::move(axes)},
              {"cells", std::move(cells)}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace gnomon::compare
