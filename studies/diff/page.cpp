// The page of a diff: what changed, by how much, and where. It has no script.
#include <fmt/core.h>

#include "compare/ladder/labels.h"
#include "compare/result/number_text.h"
#include "compare/result/outputs.h"
#include "report/html.h"
#include "report/shell.h"
#include "scene/files/pictures/image_io.h"
#include "scene/files/staged_files.h"
#include "scene/files/write_file.h"
#include "studies/diff/words.h"

namespace gnomon::studies {
namespace {

using compare::grouped;
using report::escaped;
using report::flowing;

std::string row(std::string_view head, std::initializer_list<std::string> cells) {
  std::string html = fmt::format("<tr><th scope=\"row\">{}</th>", head);
  for (const std::string& cell : cells) html += fmt::format("<td class=\"n\">{}</td>", cell);
  return html + "</tr>\n";
}

std::string table(const std::string& caption, std::initializer_list<std::string_view> heads,
                  const std::string& rows) {
  std::string html = fmt::format(
      "<div class=\"scroll\" role=\"region\" tabindex=\"0\" "
      "aria-label=\"{0}\"><table><caption>{0}</caption><thead><tr>",
      escaped(caption));
  for (const std::string_view head : heads)
    html += fmt::format("<th scope=\"col\"{}>{}</th>", head.empty() ? "" : " class=\"n\"", head);
  return html + "</tr></thead><tbody>\n" + rows + "</tbody></table></div>\n";
}

std::string figures_html(const LightDiff& light) {
  std::string rows;
  for (const FigureChange& change : light.figures)
    rows += row(escaped(compare::measure_words(*change.figure)),
                {flowing(compare::figure_text(*change.figure, change.before)),
                 flowing(compare::figure_text(*change.figure, change.after)), flowing(change_text(change))});
  for (const TimeChange& change : light.times)
    rows += row(escaped(change.words), {flowing(time_text(change.before)), flowing(time_text(change.after)),
                                        std::string(trend_name(change.trend))});
  return table("Figures of " + light.name, {"", "before", "now", "change"}, rows);
}

std::string labels_html(const LightDiff& light) {
  std::string rows;
  const auto counted = [&](std::uint64_t pixels) { return light.pixels ? grouped(pixels) : "\u2013"; };
  for (const LabelChange& label : light.labels) {
    const compare::LabelText& text = compare::label_text(label.label);
    rows += row(report::swatch(compare::label_colour(label.label), text.letter) + " " + escaped(text.name),
                {grouped(label.before), grouped(label.after), counted(label.newly_wrong),
                 counted(label.fixed), counted(label.still)});
  }
  return rows.empty() ? "<p>No pixel is wrong in either.</p>\n"
                      : table("Wrong pixels of " + light.name + " by cause",
                              {"", "before", "now", "new", "fixed", "as before"}, rows);
}

Expected<std::string> figure_html(const Rgb8Image& picture, const std::string& alt,
                                  const std::string& caption) {
  const auto png = encode_png(picture);
  if (!png) return fail(png.error());
  return fmt::format(
      "<figure><img src=\"{}\" width=\"{}\" height=\"{}\" alt=\"{}\"><figcaption>{}</figcaption></figure>\n",
      report::data_uri("image/png", *png), picture.size.width, picture.size.height, escaped(alt), caption);
}

Expected<std::string> pictures_html(const LightDiff& light) {
  if (!light.pixels)
    return fmt::format("<p>Which pixels changed is not known: {}</p>\n", flowing(light.no_pixels));
  const auto change =
      figure_html(light.pixels->change, "Which wrong pixels are new, fixed, and as before",
                  fmt::format("{} new, {} fixed, {} as before: {}", report::swatch(newly_wrong_colour, "N"),
                              report::swatch(fixed_colour, "F"), report::swatch(still_wrong_colour, "B"),
                              flowing(pixels_text(light))));
  if (!change) return change;
  if (light.pixels->newly_wrong == 0) return "<div class=\"pair\">" + *change + "</div>\n";
  std::string key;
  for (const LabelChange& label : light.labels)
    if (label.newly_wrong > 0) {
      const compare::LabelText& text = compare::label_text(label.label);
      key += fmt::format("{}{} {} {}", key.empty() ? "" : ", ",
                         report::swatch(compare::label_colour(label.label), text.letter), text.name,
                         grouped(label.newly_wrong));
    }
  const auto labels =
      figure_html(light.pixels->new_labels, "The pixels that are newly wrong, by cause", "New: " + key);
  if (!labels) return labels;
  return "<div class=\"pair\">" + *change + *labels + "</div>\n";
}

Expected<std::string> light_html(const LightDiff& light) {
  const auto pictures = pictures_html(light);
  if (!pictures) return pictures;
  std::string html = fmt::format("<section><h2>{}: {}</h2>\n", escaped(light.name), trend_name(light.trend));
  if (!light.too_much.empty())
    html += fmt::format("<p><strong>Worse than the limit: {}.</strong></p>\n", flowing(light.too_much));
  for (const std::string& chance : light.chances)
    html += fmt::format("<p>Chance: {}.</p>\n", flowing(chance));
  return html + figures_html(light) + labels_html(light) + *pictures + "</section>\n";
}

Expected<std::string> page(const Diff& diff) {
  const std::string title = fmt::format("{}: {}", diff.scene, verdict_text(diff));
  std::string html = fmt::format("<section><h1>{}</h1>\n", escaped(title));
  html += diff.fail_worse ? fmt::format("<p>Limit: worse by {} fails. {}.</p>\n",
                                        escaped(compare::threshold_text(*diff.fail_worse)),
                                        diff.too_much() ? "It is exceeded" : "It is kept")
                          : "";
  for (const std::string& note : diff.notes) html += fmt::format("<p>Also other: {}.</p>\n", flowing(note));
  std::string changed;
  for (const ChangedSetting& setting : diff.changed)
    changed += row(escaped(setting.key), {escaped(setting.before), escaped(setting.after)});
  if (!changed.empty()) html += table("Settings that changed", {"", "before", "now"}, changed);
  html += fmt::format("<p>Before: <code>{}</code></p>\n<p>Now: <code>{}</code></p></section>\n",
                      escaped(diff.commands[0]), escaped(diff.commands[1]));
  for (const LightDiff& light : diff.lights) {
    const auto part = light_html(light);
    if (!part) return part;
    html += *part;
  }
  return report::static_page(title + " \u2013 Gnomon", html);
}

}  // namespace

Expected<void> write_diff(const Diff& diff, const std::string& folder, const std::string& json) {
  const auto html = page(diff);
  if (!html) return fail(html.error());
  auto staged = StagedFolder::open(folder);
  if (!staged) return fail(staged.error());
  const std::string document = diff_json(diff);
  for (const auto& [name, text] : {std::pair{"/diff.json", document}, {"/report.html", *html}})
    if (auto written = write_file(staged->path() + name, text); !written) return written;
  StagedFiles also;
  std::vector<FileText> copies;
  if (!json.empty()) copies.push_back({json, document});
  return also.publish(*staged, "report.html", diff.paths, copies);
}

}  // namespace gnomon::studies
