// The summary that `gnomon compare` prints: per light the verdict, the counts, the budget and what the time
// bought. At most 80 columns; colour is the terminal's own bold and dim, so that it follows the user's theme.
#include <fmt/core.h>

#include <algorithm>

#include "compare/ladder/budget.h"
#include "compare/ladder/labels.h"
#include "compare/result/engine_units.h"
#include "compare/result/figures.h"
#include "compare/result/judged.h"
#include "compare/result/layout.h"
#include "compare/result/map_words.h"
#include "compare/result/number_text.h"
#include "compare/result/option_names.h"
#include "compare/result/output_parts.h"
#include "compare/result/outputs.h"
#include "compare/result/shadow_cost.h"
#include "compare/result/summary_page.h"
#include "compare/result/verdict.h"
#include "compare/result/views.h"
#include "scene/base/expected.h"
#include "scene/light.h"
#include "scene/light_map/light_view.h"

namespace gnomon::compare {
namespace {

std::string map_line(const Comparison& c, const LightComparison& light) {
  const raster::LightRecord& record = drawn_record(c, light);
  if (!c.raster.has_known_map()) return "not known";
  if (raster::samples_rays(c.raster.options.map.technique)) return "none: rays are cast";
  return fmt::format("{}{}, {} x {}{} texels", c.judged && c.judged->identified ? "inferred: " : "",
                     technique_name(c.raster.options.map.technique), record.map.view.size,
                     record.map.view.size,
                     record.map.view.face_count > 1 ? fmt::format(" x {}", record.map.view.face_count) : "") +
         map_details(c, &light);
}

/// Where the map lies; empty where that is for the technique to say, or not known.
std::string window_line(const Comparison& c, const LightComparison& light) {
  const LightView& view = drawn_record(c, light).map.view;
  const LightFace& face = view.face(0);
  if (!c.raster.has_map() || view.projection != LightProjection::orthographic || view.face_count > 1)
    return {};
  if (face.warp != 0.0 || !compares_depths(c.raster.options.map.technique)) return {};
  const Vec3 origin = face_origin(view, face);
  return fmt::format("{} x {} world units, depths {} to {} from {},{},{}",
                     plain_number(2.0 * face.half_extent.x), plain_number(2.0 * face.half_extent.y),
                     plain_number(face.near_depth), plain_number(face.far_depth), plain_number(origin.x),
                     plain_number(origin.y), plain_number(origin.z));
}

std::string hybrid_line(const raster::ExternalCosts& e) {
  const auto share = [](std::uint64_t part, std::uint64_t whole) {
    return percent(whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0);
  };
  return fmt::format(
      "{} surely lit, {} surely shadowed, {} ({} of {}; {} of the triangle tests); sheets {} ms, "
      "shadows {} "
      "ms, {} KiB",
      grouped(e.surely_lit), grouped(e.surely_shadowed), counted(e.rays, "ray"), share(e.rays, e.all_rays),
      grouped(e.all_rays), share(e.triangle_tests, e.all_triangle_tests), plain_number(e.build.median()),
      plain_number(e.shadow.median()), grouped(e.bytes / 1024));
}

std::string rays_line(const Comparison& c, const raster::ExternalCosts& e) {
  std::string text;
  for (const raster::MapSetting& setting : raster::map_settings())
    if (setting.group == raster::SettingGroup::rays)
      text += (text.empty() ? "" : ", ") + setting_words(setting, c.raster.options.map);
  return text + fmt::format(
                    "; {} and {} a frame ({} boxes and {} primitives a ray); receivers {} ms, rays {} ms, "
                    "denoiser {} ms; history {} KiB",
                    counted(e.rays, "ray"), counted(e.taps, "tap"), plain_number(e.boxes_per_ray),
                    plain_number(e.primitives_per_ray), plain_number(e.receivers_ms.median()),
                    plain_number(e.shadow.median()), plain_number(e.denoise.median()),
                    grouped(e.bytes / 1024));
}

/// A light without size takes one exact ray, and nothing is filtered.
std::string exact_ray_line(const raster::ExternalCosts& e) {
  return fmt::format("one exact ray for each pixel, since the light has no size: {} in {} ms, no denoiser",
                     counted(e.rays, "ray"), plain_number(e.shadow.median()));
}

std::string pixels_line(const PixelCounts& p) {
  return fmt::format("{} of {} compared; {} background, {} facing away, {} silhouette, {} uncertain",
                     grouped(p.compared), grouped(p.total), grouped(p.background), grouped(p.facing_away),
                     grouped(p.silhouette), grouped(p.uncertain));
}

std::string wrong_line(const ErrorStats& e) {
  const std::string ties =
      e.ties > 0 ? fmt::format(", {} off by exactly one half count half", grouped(e.ties)) : "";
  return fmt::format("{} ({}{}); false shadow {}, missed shadow {}", grouped(e.wrong),
                     percent(e.wrong_fraction), ties, grouped(e.false_shadow), grouped(e.missed_shadow));
}

std::string error_line(const LightFigures& light) {
  std::string text;
  for (const Figure& figure : figures())
    if (!figure.in_summary.empty()) {
      const double value = figure.of(light);
      text += std::string(figure.in_summary) + (std::isfinite(value) ? plain_number(value) : "none");
    }
  return text;
}

std::string subpixel_line(const LightComparison& light) {
  const SubpixelFigures& of = *light.subpixel;
  return fmt::format(
      "mean {} over {} places in each of {} pixels, silhouettes too ({} at centres); {} wrong; {} of the "
      "places are "
      "unknown",
      plain_number(of.mean_absolute), of.places, grouped(of.pixels), plain_number(light.error.mean_absolute),
      percent(of.wrong_fraction), percent(of.unknown));
}

// What is left of all lights' errors in the finished pictures.
std::string shaded_line(const ShadedError& shaded) {
  return fmt::format("the finished pictures differ by {} of a screen's range on average; FLIP {}",
                     percent(shaded.mean_absolute), plain_number(shaded.flip));
}

// "acne 12,345, blur 300"; where something is partly lit, with what each label has of the mean error.
std::string labels_line(const LightComparison& light) {
  std::string text;
  for (std::size_t k = 0; k < class_count; ++k) {
    if (!(light.class_errors[k] > 0.0) && light.classes[k] == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", label_text(static_cast<Label>(k + 1)).name,
                        grouped(light.classes[k]));
    if (light.error.fractional > 0) text += fmt::format(" (error {})", percent(light.class_errors[k]));
  }
  return text.empty() ? "none" : text;
}

std::string accidents_line(const RightByAccident& a) {
  return fmt::format("{} rightly dark only by acne, {} rightly lit only by a leak",
                     counted(a.shadowed, "pixel"), grouped(a.lit));
}

std::string seams_line(const SeamCount& seams, const LightView& view) {
  const bool cube = view.projection == LightProjection::perspective;
  return fmt::format("{} of {} beside another {} would be drawn otherwise by it", grouped(seams.changed),
                     counted(seams.at_border, "receiver"), cube ? "face of the cube" : "cascade");
}

// What no map has a part in, and what helps.
std::string terminator_line(const TerminatorCount& t) {
  if (t.dark + t.unlit == 0) return {};
  return fmt::format(
      "shadow terminator: triangle and smooth normal disagree on {} ({} dark by the triangle alone, {} by "
      "the "
      "normal); a finer mesh has less of it, raytrace --terminator-offset hides it",
      counted(t.dark + t.unlit, "pixel"), grouped(t.dark), grouped(t.unlit));
}

// What each step took and what it added.
std::string budget_line(const Comparison& c, const LightComparison& light) {
  std::string text;
  double sum = 0.0, sizes = 0.0;
  for (std::size_t k = 0; k < light.budget.size(); ++k) {
    const BudgetStep& step = light.budget[k];
    sum += step.signed_mean, sizes += step.absolute_mean;
    if (!(step.absolute_mean > 0.0)) continue;
    text += spoken(step_name(c, static_cast<Cause>(k)));
    if (step.darkened() > 0.0) text += ' ' + signed_number(-step.darkened());
    if (step.lightened() > 0.0) text += ' ' + signed_number(step.lightened());
    text += ", ";
  }
  return text + "sum " + signed_number(beyond_rounding(sum, sizes));
}

// The closed forms beside what was found.
void add_theory(SummaryPage& page, const TheoryStats& t) {
  page.field("theory",
             fmt::format("half the pixels need a bias below {} against acne, 99 % below {}",
                         plain_number(t.acne_free_bias.median), plain_number(t.acne_free_bias.p99)));
  const std::string measured = t.measured_aliasing.count > 0
                                   ? fmt::format(" ({} measured)", plain_number(t.measured_aliasing.median))
                                   : "";
  page.field("", fmt::format("a texel is {} pixels wide in the median{}, {} at 99 %",
                             plain_number(t.aliasing.median), measured, plain_number(t.aliasing.p99)));
}

// What moments let through inside shadows, as a part of the filter step.
void add_bleeding(SummaryPage& page, const Comparison& c, const LightComparison& light) {
  if (!raster::uses_moments(c.raster.options.map.technique)) return;
  const BleedingStats& b = *light.bleeding;
  page.field("bleeding",
             fmt::format("{} of the filter step, on {} pixel{}; at most {}", signed_number(b.mean),
                         grouped(b.pixels), b.pixels == 1 ? "" : "s", percent(b.max)));
}

// What the truth of a light with size is known by, and median widths across shadow edges.
void add_penumbra(SummaryPage& page, const PenumbraStats& p, int samples) {
  const std::string error =
      samples == 1 ? "how far off one is cannot be told"
                   : fmt::format("where a part of it is seen its standard error is {}, at most {}",
                                 plain_number(p.standard_error_mean), plain_number(p.standard_error_max));
  page.field("truth", fmt::format("{} of the light; {}",
                                  counted(static_cast<std::uint64_t>(samples), "sample"), error));
  if (p.weighted_difference > p.standard_error_mean)
    page.field("", fmt::format("weighed by what each part of the light contributes, V0 is another by {} on "
                               "average where a part is seen",
                               plain_number(p.weighted_difference)));
  if (p.edges == 0) return;
  page.field("penumbra",
             fmt::format("{} wide in truth, {} as drawn ({} of {})", plain_number(p.true_penumbra_world),
                         plain_number(p.drawn_penumbra_world), p.edges == 1 ? "the width" : "medians",
                         counted(p.edges, "edge")));
  if (p.umbra_edges == 0) return;
  page.field("umbra",
             fmt::format("{} wide in truth, {} as drawn ({} of {})", plain_number(p.true_umbra_world),
                         plain_number(p.drawn_umbra_world), p.umbra_edges == 1 ? "the width" : "medians",
                         counted(p.umbra_edges, "edge")));
}

void add_window(SummaryPage& page, const Comparison& c, const LightComparison& light) {
  if (const std::string window = window_line(c, light); !window.empty()) page.field("window", window);
  if (const std::string words = window_words(c, light); !words.empty())
    page.field(window_line(c, light).empty() ? "window" : "", words);
}

void add_external(SummaryPage& page, const Comparison& c, const LightComparison& light) {
  const auto& external = drawn_record(c, light).external;
  if (!external) return;
  if (!raster::samples_rays(c.raster.options.map.technique))
    page.field("hybrid", hybrid_line(*external));
  else
    page.field("rays", has_size(light_of(c, light)) ? rays_line(c, *external) : exact_ray_line(*external));
}

void add_light(SummaryPage& page, const Comparison& c, const LightComparison& light) {
  page.blank();
  page.heading(
      fmt::format("light '{}' ({})", light_of(c, light).name, light_type_name(light_of(c, light).type)));
  page.paragraph(verdict_on(c, light).whole());
  page.blank();
  page.field("map", map_line(c, light));
  if (!raster::samples_rays(c.raster.options.map.technique)) add_window(page, c, light);
  const std::string filter = filter_text(c.raster);
  if (!filter.empty()) page.field("filter", filter);
  add_external(page, c, light);
  page.field("pixels", pixels_line(light.pixels));
  if (light.pixels.compared > 0) {
    page.field("wrong", wrong_line(light.error));
    page.field("error", error_line(light));
    if (light.subpixel) page.field("in pixels", subpixel_line(light));
    if (c.shaded) page.field("shaded", shaded_line(*c.shaded));
    page.field("labels", labels_line(light));
    if (light.accidents.shadowed + light.accidents.lit > 0)
      page.field("by luck", accidents_line(light.accidents));
    page.field("budget", budget_line(c, light));
    if (light.seams) page.field("seams", seams_line(*light.seams, drawn_record(c, light).map.view));
    add_bleeding(page, c, light);
    if (light.penumbra) add_penumbra(page, *light.penumbra, true_record(c, light).samples);
    if (c.raster.has_map()) add_theory(page, light.theory);
    if (!light.bias_curve_withheld.empty()) page.field("bias", light.bias_curve_withheld);
  }
  if (const std::string line = terminator_line(light.terminator); !line.empty()) page.field("facets", line);
  for (const auto& [layer, text] : layer_lines(derived_for_engines(c, light))) page.field(layer, text);
  add_times(page, c, light);
}

// What is seen of the shadow terminator is worth a line of its own from a hundredth of the surface on.
bool shows_facets(const LightComparison& light) {
  const PixelCounts& p = light.pixels;
  return 100 * (light.terminator.dark + light.terminator.unlit) > p.compared + p.uncertain + p.facing_away;
}

// "sun: " where several are compared.
std::string whose(const Comparison& c, const LightComparison& light) {
  return c.lights.size() > 1 ? light_of(c, light).name + ": " : std::string();
}

void add_figures_in_short(SummaryPage& page, const Comparison& c, const LightComparison& light) {
  page.blank();
  if (c.lights.size() > 1) page.paragraph(one_line(light_of(c, light).name));
  page.field("map", map_line(c, light));
  if (const std::string filter = filter_text(c.raster); !filter.empty()) page.field("filter", filter);
  if (raster::samples_rays(c.raster.options.map.technique)) add_external(page, c, light);
  if (light.pixels.compared > 0) {
    page.field("wrong", wrong_line(light.error));
    page.field("labels", labels_line(light));
    if (light.subpixel) page.field("in pixels", subpixel_line(light));
  }
  if (!raster::samples_rays(c.raster.options.map.technique) &&
      (light.outside.receivers > 0 || !c.raster.options.map.window.empty()))
    page.field("window", window_words(c, light));
  if (shows_facets(light)) page.field("facets", terminator_line(light.terminator));
  add_time_in_short(page, c, light);
}

}  // namespace

std::string verdict_in_short(const Comparison& c, bool colour) {
  SummaryPage page(colour);
  for (const LightComparison& light : c.lights) {
    const Verdict verdict = verdict_on(c, light);
    page.heading(whose(c, light) + joined_sentences({verdict.error, verdict.uncertain}));
    if (!verdict.advice.empty()) page.line(verdict.advice);
  }
  if (const std::string views = views_line(c.views); !views.empty()) page.line(views);
  return page.take();
}

std::string figures_in_short(const Comparison& c, std::string_view place, bool colour) {
  SummaryPage page(colour);
  if (c.judged) {
    page.blank();
    for (const auto& [name, value] : judged_lines(c)) page.field(name, value);
  }
  for (const LightComparison& light : c.lights) add_figures_in_short(page, c, light);
  if (!c.judged && is_software(c.raster.context)) page.field("", std::string(software_note));
  page.field("", "-v prints the budget and all other figures");
  page.blank();
  page.line(place);
  return page.take();
}

std::string summary_table(const Comparison& c, bool colour) {
  SummaryPage page(colour);
  const ImageSize size = c.raster.options.size;
  page.heading(fmt::format("{}: {} x {} pixels, {}, {}", c.world->scene->name, size.width, size.height,
                           counted(c.world->triangle_count(), "triangle"),
                           counted(c.world->shapes.size(), "shape")));
  if (c.judged)
    for (const auto& [name, value] : judged_lines(c)) page.field(name, value);
  for (const LightComparison& light : c.lights) add_light(page, c, light);
  page.blank();
  page.field("whole", fmt::format("{} on {} thread{}; primary rays {}; peak memory {}",
                                  milliseconds(c.total_ms), c.threads, c.threads == 1 ? "" : "s",
                                  median_text(c.raytraced.primary_rays), byte_count(c.peak_memory_bytes)));
  if (!c.lights.empty() && !c.judged) add_once(page, c);
  return page.take();
}

}  // namespace gnomon::compare
