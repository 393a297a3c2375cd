// The first screen: both pictures with their times, and for each light the verdict beside its error budget.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "compare/ladder/budget.h"
#include "compare/ladder/labels.h"
#include "compare/measure/reduced.h"
#include "compare/result/judged.h"
#include "compare/result/number_text.h"
#include "compare/result/option_names.h"
#include "compare/result/output_parts.h"
#include "compare/result/outputs.h"
#include "compare/result/verdict.h"
#include "report/charts.h"
#include "report/html.h"
#include "report/sections.h"

namespace gnomon::compare {
namespace {

std::string timed(std::string_view key, const Times& times) {
  if (times.runs.empty()) return "not timed";
  return keyed(fmt::format("{}.median", key), times.median(), milliseconds(times.median()));
}

double median_sum(const Comparison& c, const Times& (*pick)(const Comparison&, const LightComparison&)) {
  double sum = 0.0;
  for (const LightComparison& light : c.lights) sum += pick(c, light).median();
  return sum;
}

const Times& map_times(const Comparison& c, const LightComparison& light) {
  return drawn_record(c, light).map_pass;
}
const Times& shade_times(const Comparison& c, const LightComparison& light) {
  return drawn_record(c, light).shade_pass;
}
const Times& ray_times(const Comparison& c, const LightComparison& light) {
  return true_record(c, light).exact_times();
}

// One light's time under its key, or the sum of several.
std::string shadow_time(const Comparison& c, std::string_view pass,
                        const Times& (*pick)(const Comparison&, const LightComparison&)) {
  if (c.lights.size() == 1)
    return timed(light_key(0, fmt::format("times_ms.{}", pass)), pick(c, c.lights[0]));
  return escaped(milliseconds(median_sum(c, pick)));
}

std::string raster_caption(const Comparison& c) {
  if (c.lights.empty()) return "<b>Rasterizer</b>, shadow maps";
  if (c.judged)
    return fmt::format("<b>{}</b>{}{}", escaped(c.judged->renderer), c.judged->version.empty() ? "" : " ",
                       escaped(c.judged->version)) +
           (c.judged->of_ratio ? ", with its shadow"
                               : ": what it drew of the light, white lit and black shadowed");
  const bool is_hybrid = c.raster.options.map.technique == raster::Technique::hybrid;
  return fmt::format("<b>{}</b>, {}{}: {} for the {}{}, {} to shade with {}",
                     is_hybrid ? "Hybrid" : "Rasterizer", is_hybrid ? "sheets and rays" : "shadow map",
                     c.lights.size() > 1 && !is_hybrid ? "s" : "", shadow_time(c, "map_pass", map_times),
                     is_hybrid ? "sheet" : "map", c.lights.size() > 1 || is_hybrid ? "s" : "",
                     shadow_time(c, "shade_pass", shade_times),
                     c.lights.size() > 1 || is_hybrid ? "them" : "it");
}

std::string raytraced_caption(const Comparison& c) {
  if (c.lights.empty()) return "<b>Ray tracer</b>, exact shadows";
  const bool soft = true_record(c, c.lights.front()).is_soft();
  return fmt::format("<b>Ray tracer</b>, exact shadows: {} for shadow rays, {} for primary rays",
                     shadow_time(c, soft ? "soft_shadow_rays" : "shadow_rays", ray_times),
                     timed("times_ms.primary_rays", c.raytraced.primary_rays));
}

// What the two pictures show differently by design.
std::string raster_remark(const Comparison& c) {
  if (c.judged) return "";
  const bool glass = c.plan.simulates(Effect::refraction);
  if (!glass && !c.plan.simulates(Effect::reflection)) return "";
  return glass
             ? R"(<small class="remark">Drawn plainly: what reflects or is seen through is matte grey here, and to
the shadow map glass is opaque.</small>)"
             : R"(<small class="remark">Drawn plainly: what reflects is matte grey here.</small>)";
}

std::string raytraced_remark(const Comparison& c) {
  if (!c.plan.simulates(Effect::refraction)) return "";
  return R"(<small class="remark">Light passes through glass here. The comparison counts glass as opaque, as the
map does: where glass alone casts a shadow, this picture is bright all the same.</small>)";
}

std::string figure(const PageInput& in, const EncodedPicture& encoded, std::string_view id,
                   std::string_view alt, const std::string& caption) {
  return fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n", picture(in, encoded, alt, id),
                     caption);
}

std::string map_text(const Comparison& c) {
  const raster::MapOptions& map = c.raster.options.map;
  if (lacks_map(c)) return "a shadow whose map is not known";
  const std::string_view how = c.judged && c.judged->identified ? "inferred: " : "";
  std::string text = fmt::format("{}{} shadows, map {}\u202f\u00d7\u202f{}", how,
                                 technique_name(map.technique), map.size, map.size);
  if (!compares_depths(map.technique)) return text;
  text += fmt::format(" {}", depth_format_name(map.depth_format));
  if (!draws_bias(c)) return text + ", shader of --shader-dir";
  if (c.lights.size() == 1) {
    const double bias = drawn_record(c, c.lights[0]).bias_constant_world,
                 texel = c.lights[0].bias_texel_world;
    text += fmt::format(", bias {}", plain_number(bias));
    if (texel > 0.0) text += fmt::format(" ({})", texels_text(bias / texel));
  }
  return text + beside_constant(map);
}

std::string setting_line(const PageInput& in) {
  const Comparison& c = in.comparison;
  const ImageSize size = c.raster.options.size;
  const std::string_view beside =
      in.beside ? R"(<p class="setting beside">The pixels would make this page too large for one file: its
pictures and data lie beside it, in its folder and in <code>report-data</code>. Keep them together.</p>
)"
                : "";
  const int step = image_step(size);
  const std::string reduced =
      step == 1
          ? std::string()
          : fmt::format(
                R"(<p class="setting">This page shows one pixel of every {0} × {0} (a place is counted in these); its numbers, and the
pictures in its folder, are of all pixels.</p>
)",
                step);
  return fmt::format(
      R"(<p class="setting">{} × {} pixels <span aria-hidden="true">·</span> {} <span
aria-hidden="true">·</span> {} triangle{}, {} shape{}</p>
{}{})",
      size.width, size.height, escaped(map_text(c)),
      keyed_count("scene.triangles", c.world->triangle_count()), c.world->triangle_count() == 1 ? "" : "s",
      keyed_count("scene.shapes", c.world->shapes.size()), c.world->shapes.size() == 1 ? "" : "s", reduced,
      beside);
}

// A step's name in words.
std::string_view step_words(const Comparison& c, std::size_t k) {
  return lacks_map(c) && k == 1 ? "unexplained" : step_text(static_cast<Cause>(k)).name;
}

/// The headline large, what else there is to say below it.
std::string verdict_block(const Verdict& verdict) {
  std::string out = fmt::format(R"(<p class="verdict">{}</p>
)",
                                flowing(verdict.headline()));
  if (!verdict.detail.empty())
    out += fmt::format(R"(<p class="verdict-detail">{}</p>
)",
                       flowing(verdict.detail));
  return out;
}

std::string card(const PageInput& in, std::size_t i) {
  const Comparison& c = in.comparison;
  const LightComparison& light = c.lights[i];
  const std::string title = c.lights.size() > 1
                                ? fmt::format(R"(<p class="eyebrow">Light: <a href="#light-{}">{}</a></p>
)",
                                              i, escaped(shown_light_name(c, i)))
                                : std::string();
  const std::string budget =
      light.pixels.compared == 0
          ? std::string()
          : fmt::format(
                R"(<div class="card-budget"><p class="eyebrow">Where the error comes from: how far each step
darkens the picture and lightens it, as mean visibility. Pale: what later steps undo. Full colour: the wrong
pixels that are left.</p>
{}</div>
)",
                budget_table(c, i));
  return fmt::format(R"(<div class="card"><div>{}{}</div>{}</div>
)",
                     title, verdict_block(verdict_on(c, light)), budget);
}

}  // namespace

namespace {

std::string budget_row(std::string_view name_of_step, const BudgetStep& step, std::size_t k,
                       std::size_t index, double compared, double scale) {
  const auto key = [&](std::string_view name) {
    return light_key(index, fmt::format("budget.{}.{}", k, name));
  };
  const TwoSides left{static_cast<double>(step.false_shadow) / compared,
                      static_cast<double>(step.missed_shadow) / compared};
  return fmt::format(
      R"(<tr><th scope="row">{}</th><td class="wide">{}</td><td class="n">{}</td><td class="n">{}</td></tr>
)",
      name_of_step, two_sided_bar({step.darkened(), step.lightened()}, left, scale),
      keyed_decrease(key("darkened"), step.darkened()),
      keyed(key("lightened"), step.lightened(), signed_number(step.lightened())));
}

}  // namespace

std::string budget_table(const Comparison& c, std::size_t index) {
  const LightComparison& light = c.lights[index];
  const auto compared = static_cast<double>(light.pixels.compared);
  const TwoSides left{static_cast<double>(light.error.false_shadow) / compared,
                      static_cast<double>(light.error.missed_shadow) / compared};
  double scale = std::max({left.darker, left.lighter, 1e-9});
  for (const BudgetStep& step : light.budget) scale = std::max({scale, step.darkened(), step.lightened()});
  const double last = light.rung_mean.back(), first = light.rung_mean.front();
  std::string rows;
  for (std::size_t k = 0; k < cause_count; ++k)
    if (light.budget[k].absolute_mean > 0.0 ||
        light.budget[k].false_shadow + light.budget[k].missed_shadow > 0)
      rows += budget_row(step_words(c, k), light.budget[k], k, index, compared, scale);
  return fmt::format(
      R"(<table class="budget"><thead><tr><th scope="col">step</th><td class="wide"></td><th
scope="col" class="n">darker</th><th scope="col" class="n">lighter</th></tr></thead><tbody>
{}<tr class="sum"><th scope="row">sum</th><td class="wide">{}</td><td class="n" colspan="2">{}</td></tr></tbody></table>
)",
      rows, two_sided_bar({}, left, scale), signed_number(beyond_rounding(last - first, last + first)));
}

std::string overview_section(const PageInput& in) {
  const Comparison& c = in.comparison;
  const std::string name = c.world->scene->name;
  std::string out = fmt::format(R"(<section id="overview" aria-labelledby="title">
<h1 id="title">{}</h1>
{})",
                                escaped(name.empty() ? "Scene without a name" : name), setting_line(in));
  out += fmt::format(R"(<div class="{}">
)",
                     c.lights.empty() ? "pair" : "trio");
  out +=
      figure(in, in.pictures.raster, "picture-raster",
             "The scene as the rasterizer drew it, with shadow maps.", raster_caption(c) + raster_remark(c));
  out += figure(in, in.pictures.raytraced, "picture-raytraced",
                "The same view ray traced, with exact shadows.", raytraced_caption(c) + raytraced_remark(c));
  if (!c.lights.empty()) out += label_figure(in, labelled_light(c));
  out += "</div>\n";
  for (std::size_t i = 0; i < c.lights.size(); ++i) out += card(in, i);
  if (c.lights.empty())
    out += R"(<p class="verdict">The scene has no light: there is no shadow to compare.</p>
)";
  return out + "</section>\n";
}

}  // namespace gnomon::compare
