#include "studies/shimmer/outputs.h"

#include <fmt/core.h>

#include <algorithm>

#include "compare/result/result_parts.h"
#include "compare/result/text_layout.h"
#include "report/html.h"
#include "scene/files/pictures/image_io.h"

namespace gnomon::studies {
namespace {

using compare::Json;
using report::data_uri;

std::string label_words(std::size_t label, compare::Ladder ladder) {
  return label == outside_map_flip ? "outside the map" : compare::spoken(flip_label_name(label, ladder));
}

unsigned most_flips(const ShimmerLight& light) {
  const std::vector<std::uint16_t>& flips = light.temporal.flips().data;
  return *std::max_element(flips.begin(), flips.end());
}

// A step bears the number of the rung that it leads to.
Json labels_json(compare::Ladder ladder) {
  Json labels = Json::array();
  for (std::size_t k = 0; k < flip_label_count; ++k) {
    const glm::u8vec3 c = flip_colour(k, ladder);
    labels.push_back({{"key", flip_label_name(k, ladder)},
                      {"name", label_words(k, ladder)},
                      {"colour", report::hex_colour(c.r, c.g, c.b)},
                      {"letter", k == outside_map_flip ? "O" : std::to_string(k + 1)}});
  }
  return labels;
}

std::string facts(const Shimmer& shimmer, FilmFormat format) {
  Json verdicts = Json::array(), most = Json::array();
  for (const ShimmerLight& light : shimmer.lights) {
    verdicts.push_back(shimmer_sentence(shimmer, light));
    most.push_back(most_flips(light));
  }
  return Json{{"kind", "shimmer"},
              {"labels", labels_json(shimmer.ladder())},
              {"verdicts", std::move(verdicts)},
              {"most_flips", std::move(most)},
              {"film", {{"words", film_format_words(format)}, {"extension", film_extension(format)}}}}
      .dump();
}

Expected<report::PagePicture> heat_map(const ShimmerLight& light, std::size_t index) {
  const Rgb8Image image = flip_heat_map(light);
  const auto png = encode_png(image);
  if (!png) return fail(png.error());
  return report::PagePicture{
      fmt::format("flips-{}", index), data_uri("image/png", *png), image.size.width, image.size.height,
      fmt::format("Flips of each receiver, from black, none, to pale yellow, {}", most_flips(light))};
}

std::string film_data(const FilmOfLight& film) {
  Json seen = Json::array(), flips = Json::array();
  for (const std::string& png : film.seen) seen.push_back(data_uri("image/png", png));
  for (const std::string& png : film.flips) flips.push_back(data_uri("image/png", png));
  return Json{{"seen", std::move(seen)}, {"flips", std::move(flips)}}.dump();
}

}  // namespace

Expected<report::BuiltPage> shimmer_page(const Shimmer& shimmer, const FilmRecorder& films,
                                         std::string_view json, double max_mb, FilmFormat format) {
  report::PageShell shell;
  shell.title = "Shimmer of " + shimmer.world->scene->name + " \u2013 Gnomon";
  const auto base = encode_png(films.unshadowed());
  if (!base) return fail(base.error());
  shell.parts.push_back({"base", fmt::format("\"{}\"", data_uri("image/png", *base))});
  for (std::size_t i = 0; i < shimmer.lights.size(); ++i) {
    auto picture = heat_map(shimmer.lights[i], i);
    if (!picture) return fail(picture.error());
    shell.said.push_back(shimmer_sentence(shimmer, shimmer.lights[i]));
    shell.pictures.push_back(std::move(*picture));
    shell.parts.push_back({fmt::format("film-{}", i), film_data(films.lights()[i])});
  }
  shell.result = json;
  shell.data = facts(shimmer, format);
  report::BuiltPage page = report::build_page(shell);
  if (page.megabytes() <= max_mb) return page;
  shell.beside = true;
  return report::build_page(shell);
}

}  // namespace gnomon::studies
