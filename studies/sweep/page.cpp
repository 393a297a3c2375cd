#include "studies/sweep/page.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "compare/result/number_text.h"
#include "compare/result/option_names.h"
#include "report/html.h"
#include "report/sections.h"
#include "report/shell.h"
#include "scene/files/path_status.h"
#include "scene/files/read_file.h"
#include "scene/files/write_file.h"
#include "studies/sweep/cell_files.h"
#include "studies/sweep/charts.h"

namespace gnomon::compare {
namespace {

using Json = nlohmann::ordered_json;

// "The 24 cells have errors between 0.1 % and 12 %; …"
std::string sentence(const std::vector<CellSummary>& cells, const std::vector<std::size_t>& front) {
  const auto [least, most] = std::minmax_element(
      cells.begin(), cells.end(), [](const auto& a, const auto& b) { return a.error() < b.error(); });
  if (cells.size() == 1)
    return fmt::format("The one cell leaves {} wrong, with a mean error of {}.",
                       percent(cells[0].wrong_fraction), percent(cells[0].mean_absolute));
  std::string text = fmt::format("The {} cells have errors between {} and {}.", grouped(cells.size()),
                                 error_words(*least), error_words(*most));
  if (front.size() == 1)
    text += " One of them is worth having (\u2605): none has a smaller error, and none is clearly faster.";
  else if (!front.empty())
    text += fmt::format(
        " {} of them are worth having (\u2605): every cell with a smaller error takes clearly longer.",
        front.size());
  return text;
}

std::string headline_list(const Headline& headline) {
  if (headline.items.empty()) return {};
  std::string items;
  for (const HeadlineItem& item : headline.items)
    items += item.cell ? fmt::format(
                             "<li><span class=\"eyebrow\">{}</span> <a href=\"#cell-{}\">{}</a> "
                             "<span>{}</span></li>\n",
                             escaped(item.title), *item.cell, flowing(item.setting), flowing(item.figures))
                       : fmt::format("<li>{}.</li>\n", escaped(item.title));
  return "<ul class=\"headline\">\n" + items + "</ul>\n";
}

// What the ray tracer's points cost, on this machine and on any.
std::string ray_table(const std::vector<RayPoint>& rays) {
  if (rays.empty()) return {};
  std::string rows;
  for (const RayPoint& p : rays)
    rows += fmt::format(
        "<tr><th scope=\"row\">{}</th><td class=\"n\">{}</td><td class=\"n\">{}</td><td "
        "class=\"n\">{}</td><td "
        "class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{:.1f}</td><td "
        "class=\"n\">{:.1f}</td><td class=\"n\">{}</td></tr>\n",
        escaped(p.name), milliseconds(p.times.median()),
        p.shadow_times.runs.empty() ? "\u2013" : milliseconds(p.shadow_times.median()), grouped(p.wrong),
        grouped(p.uncertain), plain_number(p.mean_absolute), grouped(p.rays), p.boxes_per_ray,
        p.primitives_per_ray, byte_count(p.bytes));
  return "<h3>The ray tracer itself</h3>\n" +
         scroll_region(
             "The ray tracer itself",
             "<table class=\"families\"><thead><tr><th scope=\"col\">precision, samples of lights with "
             "size</th><th scope=\"col\" class=\"n\">time</th><th scope=\"col\" class=\"n\">shadows "
             "alone</th><th scope=\"col\" "
             "class=\"n\">wrong</th><th scope=\"col\" class=\"n\">in doubt</th><th scope=\"col\" "
             "class=\"n\">mean error</th><th scope=\"col\" class=\"n\">rays</th><th scope=\"col\" "
             "class=\"n\">boxes per ray</th><th scope=\"col\" class=\"n\">primitives per "
             "ray</th><th scope=\"col\" class=\"n\">structure</th></tr></thead><tbody>\n" +
                 rows + "</tbody></table>") +
         fmt::format(
             "<p class=\"hint\">Camera and shadow rays of the first cell's picture, against exact "
             "precision with {} samples.</p>\n",
             reference_samples);
}

std::string cost_charts(const std::vector<CellSummary>& cells, const std::vector<std::size_t>& front,
                        const std::vector<RayPoint>& rays) {
  std::string out =
      "<section id=\"cost\" aria-labelledby=\"cost-title\"><h2 id=\"cost-title\">What accuracy costs</h2>\n";
  if (const std::string chart = pareto_chart(cells, front, rays); !chart.empty()) {
    out += "<h3>Error against time</h3>\n<figure>" + scroll_region("Error against time", chart) +
           "<figcaption>Each cell is a point and opens its pictures; the error is " +
           (cells.front().is_filmed() ? "the flips per receiver and second of its film"
                                      : "the share of wrong pixels or the mean error, whichever is more") +
           ". The line joins those that are faster than every cell with "
           "a smaller error, by more than the times' spread. ";
    if (rays.empty())
      out += fmt::format(
          "The diamond is the ray tracer, whose shadows are the truth here; {} of its time are its shadows.",
          milliseconds(cells.front().exact_shadow_ms));
    else
      out += "The diamonds are the ray tracer itself.";
    if (std::any_of(cells.begin(), cells.end(), [](const CellSummary& c) { return c.derived; }))
      out += " Cells that differ in the constant bias alone come from one drawing and share its time.";
    out += "</figcaption></figure>\n";
  }
  if (const std::string chart = size_chart(cells); !chart.empty())
    out += "<h3>Error against map size</h3>\n<figure>" + scroll_region("Error against map size", chart) +
           "<figcaption>The best cell of each technique and size." +
           (cells.front().is_filmed()
                ? ""
                : " Where the map's sampling is all that is wrong, the error falls along the "
                  "dotted line: half of it at twice the size.") +
           "</figcaption></figure>\n";
  return out + ray_table(rays) + "</section>\n";
}

std::string fact(std::string_view name, const std::string& value) {
  return fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", name, escaped(value));
}

std::string provenance(const SweepHeader& header) {
  const Json json = Json::parse(header.configuration);
  std::string out =
      "<section id=\"provenance\" aria-labelledby=\"provenance-title\"><h2 id=\"provenance-title\">Where "
      "this comes from</h2>\n<dl class=\"provenance\">\n";
  out += fact("Program", fmt::format("gnomon {}", program_version()));
  const Json& scene = json.at("scene");
  for (const char* key : {"path", "sha256"})
    if (const std::string text = scene.value(key, std::string()); !text.empty())
      out += fact(key == std::string_view("path") ? "Scene" : "SHA-256 of the scene file", text);
  for (const auto& [name, value] : json.at("options").items())
    out += fact("--" + name, value.is_string() ? value.get<std::string>() : value.dump());
  if (json.contains("film")) {
    out += fact("--metric", "shimmer");
    for (const auto& [name, value] : json.at("film").items())
      out += fact(name == "sha256" ? "SHA-256 of the path's file" : "--" + name, value.get<std::string>());
  }
  for (const char* key : {"runs", "seed", "exposure"})
    if (json.contains(key) && !json.at(key).is_null())
      out += fact(key == std::string_view("runs") ? "Runs of each pass" : key, json.at(key).dump());
  for (const Json& axis : json.value("axes", Json::array())) {
    const Json& values = axis.at("values");
    std::string list;
    for (const Json& value : values) list += (list.empty() ? "" : ", ") + value.get<std::string>();
    if (values.size() > 12)
      list = fmt::format("{} values from {} to {}", values.size(), values.front().get<std::string>(),
                         values.back().get<std::string>());
    out += fact("Swept: --" + axis.at("name").get<std::string>(), list);
  }
  return out +
         "</dl>\n<p class=\"save\"><a class=\"button\" href=\"sweep.csv\">sweep.csv</a> <a class=\"button\" "
         "href=\"sweep.jsonl\">sweep.jsonl</a> <a class=\"button\" "
         "href=\"sweep_times.jsonl\">sweep_times.jsonl</a></p></section>\n";
}

std::string grid_section(const SweepPageInput& in, const std::vector<std::size_t>& front) {
  const std::string grids = thumbnail_grids(in, front);
  if (grids.empty()) return {};
  return "<section id=\"grid\" aria-labelledby=\"grid-title\"><h2 id=\"grid-title\">Grid</h2>\n<p "
         "class=\"hint\">The ray-traced picture in grey; <b class=\"false-text\">orange</b>: drawn dark, "
         "truly "
         "lit; <b class=\"missed-text\">blue</b>: drawn lit, truly dark. The number is the share of wrong "
         "pixels; \u2605: worth having.</p>\n<div id=\"grids\">" +
         grids + "</div></section>\n";
}

// Brought to life, and shown, by the script.
std::string cell_section() {
  return "<section id=\"cell\" aria-labelledby=\"cell-title\" hidden><h2 id=\"cell-title\">One cell</h2>\n<p "
         "class=\"lead cell-line\"></p>\n" +
         viewer_block(
             "", "cell",
             "Point at a pixel to read its label. Drag to move the divider, or the picture once it is "
             "enlarged; double-click enlarges. Keys: <kbd>F</kbd> flips, <kbd>+</kbd> <kbd>−</kbd> "
             "<kbd>0</kbd> zoom, arrows move, <kbd>Shift</kbd> with arrows steps from pixel to pixel.",
             false) +
         "<p class=\"cell-labels\"></p>\n<p class=\"command\"><code "
         "class=\"cell-command\"></code></p></section>\n";
}

std::string beside_line(const SweepPageInput& in) {
  return in.beside
             ? "<p class=\"setting beside\">The pictures would make this page too large for one file: they "
               "lie "
               "beside it, in <code>cells</code> and <code>thumbnails</code>. Keep the folder together.</p>\n"
             : "";
}

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
    CellPictures found{std::move(*thumbnail), std::string(data_in_file(*data)), std::move(*drawing)};
    if (!found.thumbnail.empty()) pictures[cell.cell] = std::move(found);
  }
  return pictures;
}

}  // namespace

std::string sweep_page(const SweepPageInput& in) {
  const std::string scene = Json::parse(in.header.configuration).value("/scene/name"_json_pointer, "");
  const std::vector<std::size_t> front = pareto_front(in.cells);
  PageShell shell;
  shell.title = "Sweep of " + scene + " \u2013 Gnomon";
  shell.links =
      R"(<li><a href="#grid">Grid</a></li><li><a href="#cost">Cost</a></li><li><a href="#cells">Cells</a></li><li><a
href="#provenance">Provenance</a></li>)";
  shell.main = fmt::format(
      "<section id=\"overview\" aria-labelledby=\"title\"><h1 id=\"title\">Sweep of {}</h1>\n{}<p "
      "class=\"verdict\">{}</p>\n{}</section>\n",
      escaped(scene), beside_line(in), escaped(sentence(in.cells, front)),
      headline_list(sweep_headline(in.cells, front, in.limit)));
  shell.main += grid_section(in, front) + cell_section() + cost_charts(in.cells, front, in.rays) +
                cell_table(in.cells, front) + provenance(in.header);
  shell.data = sweep_page_data(in, front);
  shell.beside = in.beside;
  shell.folder = "cells";
  if (!in.beside) {
    const auto add_picture = [&shell](const std::string& name, const std::string& png) {
      shell.parts.push_back({name + ".png", fmt::format("\"{}\"", data_uri("image/png", png))});
    };
    for (const auto& [cell, pictures] : in.pictures) {
      if (!pictures.data.empty()) shell.parts.push_back({cell_name(cell), pictures.data});
      if (!pictures.drawing.empty()) add_picture(cell_name(cell), pictures.drawing);
    }
    for (const auto& [name, png] : in.truths) add_picture(name, png);
  }
  return build_page(shell).html;
}

namespace {

Expected<WrittenPage> read_and_write_page(const std::string& folder, double report_max_mb,
                                          const std::optional<Threshold>& limit) {
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
  if (auto saved = write_file(folder + "/report.html", page); !saved) return fail(saved.error());
  return written;
}

}  // namespace

Expected<WrittenPage> write_sweep_page(const std::string& folder, double report_max_mb,
                                       const std::optional<Threshold>& limit) {
  auto page = read_and_write_page(folder, report_max_mb, limit);
  if (!page && page.error().kind == ErrorKind::bad_input)  // of what was written just now
    return fail(
        Error{ErrorKind::cannot_write, "cannot be read back: " + page.error().reason, page.error().file});
  return page;
}

}  // namespace gnomon::compare
