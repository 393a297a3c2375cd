#include "studies/sweep/page.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "compare/result/number_text.h"
#include "report/html.h"
#include "report/page.h"
#include "report/shell.h"
#include "scene/base/stages.h"
#include "scene/files/path_status.h"
#include "scene/files/read_file.h"
#include "scene/files/write_file.h"
#include "studies/sweep/cell_files.h"

namespace gnomon::studies {
namespace {

using Json = nlohmann::ordered_json;

/// Empty where the file is not there: not every cell has a thumbnail, nor a drawing of its own.
Expected<std::string> read_if_there(const std::string& path) {
  const auto there = is_there(path);
  if (!there) return fail(there.error());
  return *there ? read_file(path) : std::string();
}

Expected<std::map<std::string, std::string>> read_truths(const std::string& folder) {
  std::map<std::string, std::string> truths;
  const auto names = truths_in(folder);
  if (!names) return fail(names.error());
  for (const std::string& name : *names) {
    auto png = read_file(cells_folder(folder) + "/" + name);
    if (!png) return fail(png.error());
    truths[name.substr(0, name.find('.'))] = std::move(*png);
  }
  return truths;
}

Expected<std::map<std::size_t, CellPictures>> read_pictures(const std::string& folder,
                                                            const std::vector<CellSummary>& cells) {
  std::map<std::size_t, CellPictures> pictures;
  for (const CellSummary& cell : cells) {
    const std::string name = cells_folder(folder) + "/" + cell_name(cell.cell);
    auto thumbnail = read_if_there(thumbnail_path(folder, cell.cell)), data = read_if_there(name + ".js"),
         drawing = read_if_there(name + ".png");
    for (const auto* file : {&thumbnail, &data, &drawing})
      if (!*file) return fail(file->error());
    if (!data->empty() && !is_cell_data(cell.cell, *data)) return fail(not_cell_data(name + ".js"));
    CellPictures found{std::move(*thumbnail), std::string(report::data_in_file(*data)), std::move(*drawing)};
    if (!found.thumbnail.empty()) pictures[cell.cell] = std::move(found);
  }
  return pictures;
}

}  // namespace

namespace {

report::PagePicture thumbnail(const SweepPageInput& in, const CellSummary& cell,
                              const CellPictures& pictures) {
  const std::string share = compare::percent(cell.figures.error.wrong_fraction) + " wrong";
  return {.name = fmt::format("thumbnail-{}", cell.cell),
          .source = in.beside ? fmt::format("thumbnails/{}.png", cell_name(cell.cell))
                              : report::data_uri("image/png", pictures.thumbnail),
          .alt = share,
          .caption = fmt::format("Cell {}, {}: {}", cell.cell, axes_words(cell), share),
          .waits = true};
}

std::vector<report::PagePicture> thumbnails(const SweepPageInput& in) {
  std::vector<report::PagePicture> list;
  for (const CellSummary& cell : in.cells)
    if (const auto pictures = in.pictures.find(cell.cell); pictures != in.pictures.end())
      list.push_back(thumbnail(in, cell, pictures->second));
  return list;
}

}  // namespace

std::string sweep_page(const SweepPageInput& in) {
  report::PageShell shell;
  shell.title = "Sweep of " +
                compare::Json::parse(in.header.configuration).value("/scene/name"_json_pointer, "") +
                " \u2013 Gnomon";
  shell.said = sweep_headline(in.cells, pareto_front(in.cells), in.limit).lines();
  shell.pictures = thumbnails(in);
  shell.result = sweep_document(in);
  shell.data = fmt::format(R"({{"kind":"sweep","labels":{}}})", report::label_facts().dump());
  shell.beside = in.beside;
  shell.folder = "cells";
  if (!in.beside) {
    const auto add_picture = [&shell](const std::string& name, const std::string& png) {
      shell.parts.push_back({name + ".png", fmt::format("\"{}\"", report::data_uri("image/png", png))});
    };
    for (const auto& [cell, pictures] : in.pictures) {
      if (!pictures.data.empty()) shell.parts.push_back({cell_name(cell), pictures.data});
      if (!pictures.drawing.empty()) add_picture(cell_name(cell), pictures.drawing);
    }
    for (const auto& [name, png] : in.truths) add_picture(name, png);
  }
  return report::build_page(shell).html;
}

namespace {

Expected<WrittenPage> read_and_write_page(const std::string& folder, double report_max_mb,
                                          const std::optional<compare::Threshold>& limit) {
  const auto sweep = read_sweep(folder);
  if (!sweep) return fail(sweep.error());
  const auto cells = summarise(*sweep);
  if (!cells) return fail(cells.error());
  WrittenPage written;
  if (cells->empty()) return written;
  const auto pictures = read_pictures(folder, *cells);
  if (!pictures) return fail(pictures.error());
  const auto truths = read_truths(folder);
  if (!truths) return fail(truths.error());
  const auto rays = read_ray_points(folder);
  if (!rays) return fail(rays.error());
  SweepPageInput input{sweep->header, *cells, *pictures, *truths, *rays, false, limit};
  written.headline = sweep_headline(*cells, pareto_front(*cells), limit);
  std::string page = sweep_page(input);
  written.page_mb = static_cast<double>(page.size()) / 1e6;
  written.beside = input.beside = written.page_mb > report_max_mb;
  if (input.beside) page = sweep_page(input);
  if (auto saved = write_file_in(folder, "report.html", page); !saved) return fail(saved.error());
  return written;
}

}  // namespace

Expected<WrittenPage> write_sweep_page(const std::string& folder, double report_max_mb,
                                       const std::optional<compare::Threshold>& limit) {
  const TimedStage stage("page");
  auto page = read_and_write_page(folder, report_max_mb, limit);
  if (!page && page.error().kind == ErrorKind::bad_input)  // of what was written just now
    return fail(
        Error{ErrorKind::cannot_write, "cannot be read back: " + page.error().reason, page.error().file});
  return page;
}

}  // namespace gnomon::studies
