#include "studies/tune/sheet.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "compare/result/engine_units.h"
#include "compare/result/figures.h"
#include "compare/result/number_text.h"
#include "compare/result/output_parts.h"
#include "compare/result/outputs.h"
#include "report/html.h"
#include "scene/files/pictures/image_io.h"

namespace gnomon::compare {
namespace {

constexpr int crop_side = 72;  // pixels

/// Where a picture errs most: the square, of those a quarter of a side apart, with the largest sum of errors.
struct Place {
  int x = 0, y = 0, width = 0, height = 0;
};

double error_at(const Comparison& c, std::size_t pixel) {
  double most = 0.0;
  for (const LightComparison& light : c.lights)
    if (is_compared(light.labels.data[pixel]))
      most =
          std::max(most, std::abs(double{light.rungs[6].data[pixel]} - double{light.rungs[0].data[pixel]}));
  return most;
}

double error_in(const Comparison& c, const Place& place) {
  double sum = 0.0;
  const Image<Label>& image = c.lights.front().labels;
  for (int y = place.y; y < place.y + place.height; ++y)
    for (int x = place.x; x < place.x + place.width; ++x) sum += error_at(c, image.index(x, y));
  return sum;
}

Place worst_place(const Comparison& c) {
  const ImageSize size = c.lights.front().labels.size;
  Place best{0, 0, std::min(crop_side, size.width), std::min(crop_side, size.height)};
  double most = -1.0;
  for (Place at = best; at.y + at.height <= size.height; at.y += crop_side / 4)
    for (at.x = 0; at.x + at.width <= size.width; at.x += crop_side / 4)
      if (const double error = error_in(c, at); error > most) most = error, best = at;
  return best;
}

Expected<std::string> crop(const Rgb8Image& picture, const Place& place, std::string_view what) {
  Rgb8Image part({place.width, place.height});
  for (int y = 0; y < place.height; ++y)
    for (int x = 0; x < place.width; ++x) part.at(x, y) = picture.at(place.x + x, place.y + y);
  const auto png = encode_png(part);
  if (!png) return fail(png.error());
  return fmt::format("<figure><img src=\"{}\" alt=\"{}\"><figcaption>{}</figcaption></figure>",
                     data_uri("image/png", *png), what, what);
}

std::string row(std::string_view name, const std::string& value) {
  return fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", name, escaped(value));
}

/// The light that errs most by the goal's measure.
const LightComparison& worst_light(const Comparison& c, const Figure& measure) {
  return *std::max_element(c.lights.begin(), c.lights.end(), [&](const auto& a, const auto& b) {
    return measure.of(a) < measure.of(b) || std::isnan(measure.of(a));
  });
}

// Every compared pixel is counted; what stays open are those whose truth is not known.
std::string error_row(const LightComparison& light, const Figure& measure) {
  const PixelCounts& p = light.pixels;
  const double open = double(unknown_pixels(light, measure)) / double(std::max<std::uint64_t>(p.compared, 1));
  return row("error", fmt::format("{} (all {} compared pixels; {} of the truth is open)",
                                  figure_words(light, measure), grouped(p.compared), percent(open)));
}

std::string flicker_row(const LightComparison& light) {
  if (!light.shimmer) return {};
  const ShimmerFigures& film = *light.shimmer;
  return row("flicker",
             fmt::format("{} flips per receiver and second ({} frames of the camera's orbit or path)",
                         plain_number(film.flips_per_receiver_second), film.frames));
}

std::string time_row(const Comparison& c) {
  Times sum;
  for (const raster::LightRecord& light : c.raster.lights)
    for (const Times* times : {&light.map_pass, &light.shade_pass}) sum.add_part(*times);
  if (sum.runs.empty()) return {};
  const auto [least, most] = std::minmax_element(sum.runs.begin(), sum.runs.end());
  return row("time here", fmt::format("{} for map and shading (median of {}, {} to {}; {})",
                                      milliseconds(sum.median()), sum.runs.size(), milliseconds(*least),
                                      milliseconds(*most), c.raster.context.renderer));
}

std::string cost_rows(const Comparison& c) {
  std::uint64_t lookups = 0, compared = 0;
  bool counted = false;
  for (const LightComparison& light : c.lights) {
    compared += light.pixels.compared;
    if (light.lookups) lookups += *light.lookups, counted = true;
  }
  std::string text = row("map", fmt::format("{}, {} texels drawn a frame (counted)",
                                            byte_count(c.raster.map_bytes), grouped(c.raster.map_texels)));
  if (counted)
    text +=
        row("taps", fmt::format("{} a pixel, {} a frame (counted)",
                                plain_number(double(lookups) / double(std::max<std::uint64_t>(compared, 1))),
                                grouped(lookups)));
  return text;
}

std::string unit_rows(const Comparison& c, std::string_view engine) {
  std::string text;
  for (const EngineUnit& unit : engine_units(c, c.lights.front()))
    if (unit.value && (engine.empty() || unit.engine == engine))
      text += fmt::format("<li>{} <code>{} {}</code></li>", escaped(unit.engine), escaped(unit.setting),
                          plain_number(*unit.value));
  return text.empty() ? text : "<ul>" + text + "</ul>\n";
}

Expected<std::string> column(const SheetCandidate& candidate, const Comparison& c, const SheetInput& in,
                             bool answer) {
  const Place place = worst_place(c);
  const auto drawn = crop(raster_picture(c), place, "as drawn"),
             truth = crop(raytraced_picture(c), place, "by rays");
  if (!drawn) return fail(drawn.error());
  if (!truth) return fail(truth.error());
  const LightComparison& light = worst_light(c, in.goal.measure());
  const raster::MapOptions& map = candidate.setting.raster.map;
  std::string text = fmt::format("<section><h2>{}{}</h2>\n", escaped(candidate.name), answer ? " ★" : "");
  text += fmt::format(
      "<div class=\"pair\">{}{}</div><p class=\"small\">The place that errs most, {} × {} pixels from "
      "{}, {}.{}</p>\n",
      *drawn, *truth, place.width, place.height, place.x, place.y,
      c.views.views.empty() ? ""
                            : " " + escaped(fmt::format("View: {}.", c.views.views[c.views.worst].name)));
  text += "<table>" + row("size", fmt::format("{} × {}", map.size, map.size)) +
          error_row(light, in.goal.measure()) + flicker_row(light) + cost_rows(c) + time_row(c) +
          "</table>\n";
  text += fmt::format("<p class=\"small\"><code>{}</code></p>\n{}</section>\n", escaped(candidate.command),
                      unit_rows(c, in.engine));
  return text;
}

constexpr std::string_view style = R"(
@page { size: A4 landscape; margin: 10mm; }
body { font: 9pt/1.3 system-ui, sans-serif; margin: 1em auto; max-width: 277mm; color: #1c1e22; background: #fff; }
h1 { font-size: 14pt; margin: 0 0 .2em; } h2 { font-size: 11pt; margin: 0 0 .4em; } p { margin: .3em 0; }
main { display: flex; gap: 5mm; align-items: flex-start; } section { flex: 1 1 0; min-width: 0; border-top: 2px solid #1c1e22; padding-top: .4em; }
.pair { display: flex; gap: 2mm; } figure { margin: 0; flex: 1; } figcaption, .small { font-size: 7.5pt; color: #50555e; }
img { width: 100%; image-rendering: pixelated; display: block; } table { border-collapse: collapse; width: 100%; }
th, td { text-align: left; vertical-align: top; padding: .15em .4em .15em 0; border-bottom: 1px solid #d8dade; font-weight: normal; }
th { color: #50555e; white-space: nowrap; } @media screen { body { padding: 0 1em; } } code { font-size: 7.5pt; overflow-wrap: anywhere; } ul { margin: .3em 0; padding-left: 1.1em; font-size: 8pt; }
)";

}  // namespace

int size_at_memory(const Attempt& attempt, const std::vector<int>& sizes, std::uint64_t bytes) {
  int best = sizes.front();
  const double per_texel = double(attempt.map_bytes) / (double(attempt.size) * attempt.size);
  for (const int size : sizes)
    if (per_texel * size * size <= 1.01 * double(bytes)) best = size;
  return best;
}

Expected<Attempt> attempt_at(Engine& engine, const Setting& base, const TuneFamily& family, Attempt attempt,
                             const TuneGoal& goal) {
  Setting setting = base;
  setting.raster.map = family.map;
  setting.raster.map.size = attempt.size;
  setting.raster.runs = 0;
  const auto probe = engine.probe(setting, goal.measure());
  if (!probe) return fail(probe.error());
  if (probe->best && !probe->custom_shader) attempt.bias = probe->bias_at_best;
  return attempt;
}

Expected<std::string> tune_sheet(Engine& engine, const SheetInput& in) {
  std::string columns;
  for (std::size_t i = 0; i < in.candidates.size(); ++i) {
    const auto compared = engine.compare(in.candidates[i].setting);
    if (!compared) return fail(compared.error());
    const auto text = column(in.candidates[i], **compared, in, i == 0);
    if (!text) return fail(text.error());
    columns += *text;
  }
  const std::string wanted = in.goal.max_error
                                 ? limit_words(*in.goal.max_error)
                                 : "at most " + milliseconds(*in.goal.max_time_ms) + " for map and shading";
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta "
      "charset=\"utf-8\">{}<style>{}</style></head><body>\n<h1>Shadows of "
      "{}</h1>\n<p>Wanted: {}. The star is the answer; the others have at most as much memory for their "
      "maps. Texels and "
      "taps hold on every machine, times on this one.</p>\n<main>{}</main></body></html>\n",
      page_head({"Shadows of " + in.scene + " – Gnomon", style}), style, escaped(in.scene), escaped(wanted),
      columns);
}

}  // namespace gnomon::compare
