#include "studies/tune/sheet.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "compare/result/engine_units.h"
#include "compare/result/figures.h"
#include "compare/result/number_text.h"
#include "compare/result/output_parts.h"
#include "compare/result/outputs.h"
#include "compare/result/result_parts.h"
#include "report/html.h"
#include "report/shell.h"
#include "scene/files/pictures/image_io.h"

namespace gnomon::studies {
namespace {

using compare::Comparison;
using compare::LightComparison;
using compare::milliseconds;

constexpr int crop_side = 72;  // pixels

/// Where a picture errs most: the square, of those a quarter of a side apart, with the largest sum of errors.
struct Place {
  int x = 0, y = 0, width = 0, height = 0;
};

double error_at(const Comparison& c, std::size_t pixel) {
  double most = 0.0;
  for (const LightComparison& light : c.lights)
    if (compare::is_compared(light.labels.data[pixel]))
      most =
          std::max(most, std::abs(double{light.rungs[6].data[pixel]} - double{light.rungs[0].data[pixel]}));
  return most;
}

double error_in(const Comparison& c, const Place& place) {
  double sum = 0.0;
  const Image<compare::Label>& image = c.lights.front().labels;
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

Expected<report::PagePicture> crop(const Rgb8Image& picture, const Place& place, const std::string& name,
                                   const char* what) {
  Rgb8Image part({place.width, place.height});
  for (int y = 0; y < place.height; ++y)
    for (int x = 0; x < place.width; ++x) part.at(x, y) = picture.at(place.x + x, place.y + y);
  const auto png = encode_png(part);
  if (!png) return fail(png.error());
  return report::PagePicture{name, report::data_uri("image/png", *png), place.width, place.height, what};
}

/// The light that errs most by the goal's measure.
const LightComparison& worst_light(const Comparison& c, const compare::Figure& measure) {
  return *std::max_element(c.lights.begin(), c.lights.end(), [&](const auto& a, const auto& b) {
    return measure.of(a) < measure.of(b) || std::isnan(measure.of(a));
  });
}

// Every compared pixel is counted; what stays open are those whose truth is not known.
std::string error_text(const LightComparison& light, const compare::Figure& measure) {
  const compare::PixelCounts& p = light.pixels;
  const double open =
      double(compare::unknown_pixels(light, measure)) / double(std::max<std::uint64_t>(p.compared, 1));
  return fmt::format("{} (all {} compared pixels; {} of the truth is open)",
                     compare::figure_words(light, measure), compare::grouped(p.compared),
                     compare::percent(open));
}

std::string flicker_text(const compare::ShimmerFigures& film) {
  return fmt::format("{} flips per receiver and second ({} frames of the camera's orbit or path)",
                     compare::plain_number(film.flips_per_receiver_second), film.frames);
}

/// Empty where nothing was timed.
std::string time_text(const Comparison& c) {
  Times sum;
  for (const raster::LightRecord& light : c.raster.lights)
    for (const Times* times : {&light.map_pass, &light.shade_pass}) sum.add_part(*times);
  if (sum.runs.empty()) return {};
  const auto [least, most] = std::minmax_element(sum.runs.begin(), sum.runs.end());
  return fmt::format("{} for map and shading (median of {}, {} to {}; {})", milliseconds(sum.median()),
                     sum.runs.size(), milliseconds(*least), milliseconds(*most), c.raster.context.renderer);
}

/// Empty where no lookups were counted.
std::string taps_text(const Comparison& c) {
  std::uint64_t lookups = 0, compared = 0;
  bool counted = false;
  for (const LightComparison& light : c.lights) {
    compared += light.pixels.compared;
    if (light.lookups) lookups += *light.lookups, counted = true;
  }
  if (!counted) return {};
  return fmt::format("{} a pixel, {} a frame (counted)",
                     compare::plain_number(double(lookups) / double(std::max<std::uint64_t>(compared, 1))),
                     compare::grouped(lookups));
}

Json rows_json(const SheetCandidate& candidate, const Comparison& c, const compare::Figure& measure) {
  const int size = candidate.setting.raster.map.size;
  const LightComparison& light = worst_light(c, measure);
  Json rows = Json::array();
  const auto add = [&](const char* name, const std::string& text) {
    if (!text.empty()) rows.push_back({name, text});
  };
  const bool has_map = raster::reads_setting(candidate.setting.raster.map, "map-size");
  if (has_map) add("size", fmt::format("{} × {}", size, size));
  add("error", error_text(light, measure));
  if (light.shimmer) add("flicker", flicker_text(*light.shimmer));
  if (has_map)
    add("map", fmt::format("{}, {} drawn a frame (counted)", compare::byte_count(c.raster.map_bytes),
                           compare::counted(c.raster.map_texels, "texel")));
  else if (const auto& cast = c.raster.lights.front().external)
    add("rays", fmt::format("{} cast and {} taken a frame (counted)", compare::counted(cast->rays, "ray"),
                            compare::counted(cast->taps, "tap")));
  add("taps", taps_text(c));
  add("time here", time_text(c));
  return rows;
}

Json units_json(const Comparison& c, std::string_view engine) {
  Json units = Json::array();
  for (const compare::EngineUnit& unit : compare::engine_units(c, c.lights.front()))
    if (unit.value && (engine.empty() || unit.engine == engine))
      units.push_back({{"engine", unit.engine},
                       {"setting", unit.setting},
                       {"value", compare::plain_number(*unit.value)}});
  return units;
}

/// One column of the page (report/page/src/sheet_page.ts); its pictures are added to the shell's.
Expected<Json> candidate_json(const SheetCandidate& candidate, const Comparison& c, const SheetInput& in,
                              report::PageShell& shell) {
  const Place place = worst_place(c);
  const std::string number = std::to_string(shell.pictures.size() / 2);
  auto drawn = crop(compare::raster_picture(c), place, "drawn-" + number, "as drawn"),
       truth = crop(compare::raytraced_picture(c), place, "truth-" + number, "by rays");
  if (!drawn) return fail(drawn.error());
  if (!truth) return fail(truth.error());
  shell.pictures.push_back(std::move(*drawn)), shell.pictures.push_back(std::move(*truth));
  return Json{
      {"name", candidate.name},
      {"place", fmt::format("{} × {} pixels from {}, {}", place.width, place.height, place.x, place.y)},
      {"view", c.views.views.empty() ? Json(nullptr) : Json(c.views.views[c.views.worst].name)},
      {"rows", rows_json(candidate, c, in.goal.measure())},
      {"command", candidate.command},
      {"units", units_json(c, in.engine)}};
}

}  // namespace

int size_at_memory(const Attempt& attempt, const std::vector<int>& sizes, std::uint64_t bytes) {
  int best = sizes.front();
  const double per_texel = double(attempt.map_bytes) / (double(attempt.size) * attempt.size);
  for (const int size : sizes)
    if (per_texel * size * size <= 1.01 * double(bytes)) best = size;
  return best;
}

Expected<Attempt> attempt_at(Engine& engine, const compare::Setting& base, const TuneFamily& family,
                             Attempt attempt, const TuneGoal& goal) {
  compare::Setting setting = base;
  setting.raster.map = family.map;
  setting.raster.map.size = attempt.size;
  setting.raster.runs = 0;
  const auto probe = engine.probe(setting, goal.measure());
  if (!probe) return fail(probe.error());
  if (probe->best && !probe->custom_shader && !family.keeps_bias) attempt.bias = probe->bias_at_best;
  return attempt;
}

Expected<std::string> tune_sheet(Engine& engine, const SheetInput& in) {
  const std::string wanted = in.goal.max_error
                                 ? compare::limit_words(*in.goal.max_error)
                                 : "at most " + milliseconds(*in.goal.max_time_ms) + " for map and shading";
  report::PageShell shell;
  shell.title = "Shadows of " + in.scene + " \u2013 Gnomon";
  compare::Json candidates = compare::Json::array();
  for (const SheetCandidate& candidate : in.candidates) {
    const auto compared = engine.compare(candidate.setting);
    if (!compared) return fail(compared.error());
    auto json = candidate_json(candidate, **compared, in, shell);
    if (!json) return fail(json.error());
    candidates.push_back(std::move(*json));
  }
  shell.said = {"Wanted: " + wanted + ". The first is the answer."};
  shell.result = compare::dumped(
      compare::Json{{"scene", in.scene}, {"wanted", wanted}, {"candidates", std::move(candidates)}}, -1);
  shell.data = R"({"kind": "sheet", "labels": []})";
  return report::build_page(shell).html;
}

}  // namespace gnomon::studies
