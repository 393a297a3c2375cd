#include "report/page.h"

#include <fmt/core.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "compare/result/judged.h"
#include "compare/result/number_text.h"
#include "compare/result/output_parts.h"
#include "compare/result/outputs.h"
#include "compare/result/verdict.h"
#include "report/html.h"
#include "report/pixels/page_data.h"
#include "report/write_outputs.h"

namespace gnomon::report {
namespace {

std::string title(const PageInput& in) {
  const compare::Comparison& c = in.comparison;
  const std::string& scene = c.world->scene->name;
  if (in.introduction != nullptr) return in.introduction->title;
  if (c.judged) return "Judging " + compare::renderer_text(*c.judged) + ": " + scene + " \u2013 Gnomon";
  const bool one = c.lights.size() == 1 && c.lights[0].pixels.compared > 0;
  return scene + (one ? ": " + compare::percent(c.lights[0].error.wrong_fraction) + " wrong" : "") +
         " \u2013 Gnomon";
}

/// The pictures' names, by which the sections ask for them, and what they show.
class Pictures {
 public:
  explicit Pictures(const PageInput& in) : in_(in) {}

  std::vector<PagePicture> all() && {
    add("raster", in_.pictures.raster, "The scene as the rasterizer drew it, with shadow maps.");
    add("raytraced", in_.pictures.raytraced, "The same view ray traced, with exact shadows.");
    for (std::size_t i = 0; i < in_.pictures.lights.size(); ++i) add_light(i);
    return std::move(pictures_);
  }

 private:
  void add(std::string name, const compare::EncodedPicture& encoded, std::string alt) {
    if (encoded.png.empty()) return;
    pictures_.push_back(
        {.name = std::move(name),
         .source = in_.beside ? escaped(encoded.file_name) : data_uri("image/png", encoded.png),
         .width = encoded.size.width,
         .height = encoded.size.height,
         .alt = std::move(alt)});
  }

  void add_light(std::size_t i) {
    const compare::LightPictures& of = in_.pictures.lights[i];
    const auto name = [i](std::string_view kind) { return fmt::format("{}-{}", kind, i); };
    add(name("difference"), of.difference,
        "The picture in grey; pixels with a false shadow in orange, with a missed shadow in light blue.");
    add(name("labels"), of.labels, "Every error in the colour of its label, as strong as it is.");
    add(name("decisions"), of.decisions,
        "The picture in grey, tinted where the map decides alone; traced pixels stand out.");
    add(name("edges"), of.edges,
        "Bands between drawn and true shadow edges, coloured by their width and side.");
    add(name("detachment"), of.detachment, "Gaps between casters and their shadows, brighter where wider.");
    if (in_.comparison.raster.has_map())
      add(name("depth-map"), of.depth_map_small,
          "The depth map: near surfaces bright yellow, far ones dark purple.");
  }

  const PageInput& in_;
  std::vector<PagePicture> pictures_;
};

/// The scripts read it, nobody else: much of it was indentation.
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

/// To be saved from the page itself, unless it has files beside it: these two are among them.
std::vector<PageLink> links(const PageInput& in) {
  return {{"result.json", in.beside ? "result.json" : data_uri("application/json", in.json)},
          {"result.csv", in.beside ? "result.csv" : data_uri("text/csv", in.csv)}};
}

std::vector<std::string> said_first(const compare::Comparison& c) {
  std::vector<std::string> sentences;
  if (const std::string reduced = reduced_words(c); !reduced.empty()) sentences.push_back(reduced);
  for (std::size_t i = 0; i < c.lights.size(); ++i)
    sentences.push_back((c.lights.size() > 1 ? shown_light_name(c, i) + ": " : std::string()) +
                        compare::verdict_on(c, c.lights[i]).whole());
  return sentences;
}

std::string with_facts(std::string_view head, const PageInput& in) {
  auto json = nlohmann::ordered_json::parse(head);
  json.update(report_facts(in));
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace

BuiltPage report_page(PageInput in, PageData& data, double max_mb) {
  PageShell shell;
  shell.title = title(in);
  shell.result = without_line_breaks(in.json);
  shell.data = with_facts(data.head, in);
  shell.parts = std::move(data.parts);
  shell.pictures = Pictures(in).all();
  shell.saved = links(in);
  shell.said = said_first(in.comparison);
  BuiltPage page = build_page(shell);
  if (page.megabytes() <= max_mb) return page;
  shell.beside = in.beside = true;
  shell.pictures = Pictures(in).all();
  shell.saved = links(in);
  return build_page(shell);
}

Expected<std::string> report_html(const compare::Comparison& comparison) {
  const Expected<compare::PictureSet> pictures = compare::encode_pictures(comparison);
  if (!pictures) return fail(pictures.error());
  const std::string json = compare::result_json(comparison), csv = compare::result_csv(comparison);
  const PageInput input{comparison, *pictures, json, csv};
  PageData data = page_data(input);
  return report_page(input, data, std::numeric_limits<double>::infinity()).html;
}

}  // namespace gnomon::report
