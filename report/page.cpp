#include "report/page.h"

#include <fmt/core.h>

#include <limits>

#include "compare/result/number_text.h"
#include "compare/result/outputs.h"
#include "report/html.h"
#include "report/page_data.h"
#include "report/sections.h"
#include "report/write_outputs.h"

namespace gnomon::compare {
namespace {

std::string title(const PageInput& in) {
  if (in.introduction != nullptr) return in.introduction->title;
  const Comparison& c = in.comparison;
  std::string text = c.world->scene->name;
  if (c.lights.size() == 1 && c.lights[0].pixels.compared > 0)
    text += ": " + percent(c.lights[0].error.wrong_fraction) + " wrong";
  return text + " \u2013 Gnomon";
}

std::string links(const PageInput& in) {
  const Comparison& c = in.comparison;
  std::string text = in.introduction != nullptr ? in.introduction->links : std::string();
  text += R"(<li><a href="#overview">Overview</a></li>)";
  for (std::size_t i = 0; i < c.lights.size(); ++i)
    text += fmt::format(R"(<li><a href="#light-{}">Light: {}</a></li>)", i, escaped(shown_light_name(c, i)));
  return text +
         R"(<li><a href="#cost">Time and work</a></li><li><a href="#effects">Effects</a></li><li><a
href="#provenance">Provenance</a></li>)";
}

std::string sections(const PageInput& in) {
  std::string text = in.introduction != nullptr ? in.introduction->html : std::string();
  text += overview_section(in);
  for (std::size_t i = 0; i < in.comparison.lights.size(); ++i) text += light_section(in, i);
  return text + cost_section(in) + effects_section(in) + provenance_section(in);
}

/// The scripts read it, nobody else: a third of it was indentation.
std::string without_line_breaks(std::string_view json) {
  std::string text;
  text.reserve(json.size());
  for (std::size_t i = 0; i < json.size(); ++i) {
    if (json[i] != '\n') {
      text += json[i];
      continue;
    }
    while (i + 1 < json.size() && json[i + 1] == ' ') ++i;  // in strings line breaks are written \n
  }
  return text;
}

}  // namespace

BuiltPage report_page(PageInput in, PageData& data, double max_mb) {
  PageShell shell;
  shell.title = title(in);
  shell.links = links(in);
  shell.result = without_line_breaks(in.json);
  shell.data = std::move(data.head);
  shell.parts = std::move(data.parts);
  shell.main = sections(in);
  BuiltPage page = build_page(shell);
  if (page.megabytes() <= max_mb) return page;
  shell.beside = in.beside = true;
  shell.main = sections(in);
  return build_page(shell);
}

Expected<std::string> report_html(const Comparison& comparison) {
  const Expected<PictureSet> pictures = encode_pictures(comparison);
  if (!pictures) return fail(pictures.error());
  const std::string json = result_json(comparison), csv = result_csv(comparison);
  const PageInput input{comparison, *pictures, json, csv, comparison.total_ms};
  PageData data = page_data(input);
  return report_page(input, data, std::numeric_limits<double>::infinity()).html;
}

}  // namespace gnomon::compare
