#include "studies/shimmer/page.h"

#include <fmt/core.h>

#include <algorithm>

#include "compare/ladder/budget.h"
#include "compare/result/number_text.h"
#include "compare/result/option_names.h"
#include "compare/result/result_parts.h"
#include "compare/result/text_layout.h"
#include "report/html.h"
#include "report/sections.h"
#include "scene/files/image_io.h"

namespace gnomon::compare {
namespace {

std::string key_of(std::size_t light, std::string_view rest) {
  return fmt::format("lights.{}.{}", light, rest);
}

std::string label_words(std::size_t label) {
  return label == outside_map_flip ? "outside the map" : spoken(flip_label_name(label));
}

// A step bears the number of the rung that it leads to.
std::string label_swatch(std::size_t label) {
  return swatch(flip_colour(label), label == outside_map_flip ? "O" : std::to_string(label + 1));
}

double mean(double sum, const TemporalSums& total) {
  return total.receivers > 0 ? sum / double(total.receivers) : 0.0;
}

std::string budget_table(const ShimmerLight& light, std::size_t i) {
  const TemporalSums& total = light.temporal.total();
  std::string rows;
  for (std::size_t k = 0; k < cause_count; ++k)
    rows += fmt::format(
        "<tr><th scope=\"row\">{} {}</th><td class=\"n\">{}</td><td class=\"n\">{}</td><td "
        "class=\"n\">{}</td></tr>\n",
        label_swatch(k), label_words(k),
        keyed(key_of(i, fmt::format("budget.{}.signed", k)), mean(total.signed_sum[k], total),
              signed_number(mean(beyond_rounding(total.signed_sum[k], total.absolute_sum[k]), total))),
        keyed(key_of(i, fmt::format("budget.{}.absolute", k)), mean(total.absolute_sum[k], total),
              unsigned_number(mean(total.absolute_sum[k], total))),
        keyed_count(key_of(i, fmt::format("by_label.{}", flip_label_name(k))), total.by_label[k]));
  rows += fmt::format("<tr><th scope=\"row\">{} {}</th><td></td><td></td><td class=\"n\">{}</td></tr>\n",
                      label_swatch(outside_map_flip), label_words(outside_map_flip),
                      keyed_count(key_of(i, "by_label.outside_map"), total.by_label[outside_map_flip]));
  rows += fmt::format(
      "<tr><th scope=\"row\">sum</th><td class=\"n\">{}</td><td class=\"n\">{}</td><td "
      "class=\"n\">{}</td></tr>\n",
      keyed(key_of(i, "error.signed"), mean(total.error_sum, total),
            signed_number(mean(beyond_rounding(total.error_sum, total.error_absolute_sum), total))),
      keyed(key_of(i, "error.absolute"), mean(total.error_absolute_sum, total),
            unsigned_number(mean(total.error_absolute_sum, total))),
      keyed_count(key_of(i, "flips"), total.flips));
  return scroll_region(fmt::format("Temporal budget {}", i),
                       "<table class=\"families\"><thead><tr><th scope=\"col\">step</th><th scope=\"col\" "
                       "class=\"n\">signed</th><th scope=\"col\" class=\"n\">absolute</th><th scope=\"col\" "
                       "class=\"n\">flips</th></tr></thead><tbody>\n" +
                           rows + "</tbody></table>");
}

std::string worst_table(const Shimmer& shimmer, const ShimmerLight& light, std::size_t i) {
  if (light.worst.empty()) return {};
  std::string rows;
  const auto width = static_cast<std::uint32_t>(shimmer.receivers.size.width);
  for (const WorstReceiver& one : light.worst)
    rows += fmt::format(
        "<tr><th scope=\"row\"><span class=\"place\" data-pixel=\"{0}\">{1}, {2}</span></th><td "
        "class=\"n\">{3}</td><td class=\"n\">{4}</td></tr>\n",
        one.pixel, one.pixel % width, one.pixel / width, grouped(one.flips), plain_number(one.absolute));
  return "<h3>The receivers that flip most</h3>\n" +
         scroll_region(
             fmt::format("Worst receivers {}", i),
             "<table class=\"worst\"><thead><tr><th scope=\"col\">pixel</th><th scope=\"col\" class=\"n\">"
             "flips</th><th scope=\"col\" class=\"n\">sum of |error|</th></tr></thead><tbody>\n" +
                 rows + "</tbody></table>");
}

std::string edges_line(const Shimmer& shimmer, const ShimmerLight& light, std::size_t i) {
  const EdgeSpeed speed = edge_speed(shimmer.options, light);
  if (std::isnan(speed.drawn_texels_per_frame)) return "<p>There is no true shadow edge.</p>\n";
  return fmt::format("<p>Drawn shadow edges sweep {} texels with each frame, the true ones {}.</p>\n",
                     keyed(key_of(i, "edges.drawn_texels_per_frame"), speed.drawn_texels_per_frame,
                           plain_number(speed.drawn_texels_per_frame)),
                     keyed(key_of(i, "edges.true_texels_per_frame"), speed.true_texels_per_frame,
                           plain_number(speed.true_texels_per_frame)));
}

Expected<std::string> light_part(const Shimmer& shimmer, std::size_t i, FilmFormat format) {
  const ShimmerLight& light = shimmer.lights[i];
  const auto heat = encode_png(flip_heat_map(light));
  if (!heat) return fail(heat.error());
  const ImageSize size = shimmer.receivers.size;
  const Image<std::uint16_t>& flips = light.temporal.flips();
  const unsigned most = *std::max_element(flips.data.begin(), flips.data.end());
  return fmt::format(
      R"(<section id="light-{0}" class="shimmer-light" data-light="{0}" aria-labelledby="light-{0}-title">
<h2 id="light-{0}-title">Light: {1}</h2>
<p class="verdict">{2}</p>
<div class="film" hidden></div>
<p class="setting">The films themselves lie beside this page, as {11}: <code>film-{0}-drawn.{12}</code>,
<code>film-{0}-truth.{12}</code>, <code>film-{0}-flips.{12}</code>.</p>
<h3>Flips from frame to frame</h3>
{3}
{4}<h3>Where it flips</h3>
<figure><img class="flips-map" src="{5}" width="{6}" height="{7}" alt="Flips of each receiver, from black, none, to pale yellow, {8}">
<figcaption>Flips of each receiver over the film, black none, pale yellow {8}.</figcaption></figure>
<h3>Which step does it</h3>
{9}{10}</section>
)",
      i, escaped(shimmer.world->scene->lights[light.light].name), flowing(shimmer_sentence(shimmer, light)),
      scroll_region(fmt::format("Flips from frame to frame {}", i), flips_chart(shimmer, light, i)),
      edges_line(shimmer, light, i), data_uri("image/png", *heat), size.width, size.height, most,
      budget_table(light, i), worst_table(shimmer, light, i), film_format_words(format),
      film_extension(format));
}

std::string head_data(const Shimmer& shimmer) {
  Json labels = Json::array();
  for (std::size_t k = 0; k < flip_label_count; ++k) {
    const glm::u8vec3 c = flip_colour(k);
    labels.push_back({{"name", label_words(k)}, {"colour", hex_colour(c.r, c.g, c.b)}});
  }
  const ImageSize size = shimmer.receivers.size;
  return Json{{"kind", "shimmer"},
              {"width", size.width},
              {"height", size.height},
              {"frames", shimmer.options.time.frames},
              {"fps", number(shimmer.options.time.fps)},
              {"anchors", shimmer.options.anchors},
              {"labels", std::move(labels)}}
      .dump();
}

std::string film_data(const FilmOfLight& film) {
  Json seen = Json::array(), flips = Json::array();
  for (const std::string& png : film.seen) seen.push_back(data_uri("image/png", png));
  for (const std::string& png : film.flips) flips.push_back(data_uri("image/png", png));
  return Json{{"seen", std::move(seen)}, {"flips", std::move(flips)}}.dump();
}

std::string provenance(const Shimmer& shimmer, const std::string& command) {
  const Scene& scene = *shimmer.world->scene;
  return fmt::format(
      R"(<section id="provenance" aria-labelledby="provenance-title"><h2 id="provenance-title">Where this comes from</h2>
<p class="command"><code>{}</code></p>
<dl class="provenance"><div><dt>Scene</dt><dd>{}</dd></div><div><dt>SHA-256 of the scene file</dt><dd>{}</dd></div><div><dt>Gnomon</dt><dd>{}</dd></div><div><dt>OpenGL</dt><dd>{} through {}: {}</dd></div></dl></section>
)",
      escaped(command), escaped(scene.path), scene.sha256, escaped(program_version()),
      escaped(shimmer.context.version), escaped(shimmer.context.backend), escaped(shimmer.context.renderer));
}

std::string overview(const Shimmer& shimmer) {
  const ShimmerOptions& o = shimmer.options;
  return fmt::format(
      R"(<section id="overview" aria-labelledby="title"><h1 id="title">Shimmer of {}</h1>
<p class="setting">{} map of {}² texels, {} frames at {:g} a second, camera {}, light {}. Receivers stay where the first
frame sees them; V6 is what was drawn of them, V0 the truth. A flip is a step of V6 that differs by more than one half from
that of V0.</p></section>
)",
      escaped(shimmer.world->scene->name), technique_name(o.compare.raster.map.technique),
      o.compare.raster.map.size, o.time.frames, o.time.fps, camera_path_name(o.path.camera),
      light_path_name(o.path.light));
}

}  // namespace

Expected<BuiltPage> shimmer_page(const Shimmer& shimmer, const FilmKeeper& films, const std::string& command,
                                 std::string_view json, double max_mb, FilmFormat format) {
  PageShell shell;
  shell.title = "Shimmer of " + shimmer.world->scene->name + " \u2013 Gnomon";
  shell.links = R"(<li><a href="#overview">Overview</a></li>)";
  shell.main = overview(shimmer);
  const auto base = encode_png(films.unshadowed());
  if (!base) return fail(base.error());
  shell.parts.push_back({"base", fmt::format("\"{}\"", data_uri("image/png", *base))});
  for (std::size_t i = 0; i < shimmer.lights.size(); ++i) {
    auto part = light_part(shimmer, i, format);
    if (!part) return fail(part.error());
    shell.main += *part;
    shell.links += fmt::format(R"(<li><a href="#light-{}">Light: {}</a></li>)", i,
                               escaped(shimmer.world->scene->lights[shimmer.lights[i].light].name));
    shell.parts.push_back({fmt::format("film-{}", i), film_data(films.lights()[i])});
  }
  shell.main += provenance(shimmer, command);
  shell.result = json;
  shell.data = head_data(shimmer);
  BuiltPage page = build_page(shell);
  if (page.megabytes() <= max_mb) return page;
  shell.beside = true;
  return build_page(shell);
}

}  // namespace gnomon::compare
