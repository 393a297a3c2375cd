// The numbers of one light: the ladder, every constant bias, edges and gaps, the depth map.
#include <fmt/core.h>

#include <cmath>

#include "compare/bias/bias_advice.h"
#include "compare/ladder/budget.h"
#include "compare/ladder/labels.h"
#include "compare/result/option_names.h"
#include "compare/result/output_parts.h"
#include "compare/result/outputs.h"
#include "compare/result/palette.h"
#include "report/charts.h"
#include "report/html.h"
#include "report/lessons.h"
#include "report/light_block.h"

namespace gnomon::compare {
namespace {

std::string ladder_step(const LightBlock& b, std::size_t k) {
  const BudgetStep& step = b.light.budget[k];
  return fmt::format(
      R"(<td>{}</td><td class="n">{}</td><td class="n">{}</td><td class="n">{}</td><td class="n">{}</td>)",
      lacks_map(b.in.comparison) && k == 1 ? "unexplained" : step_text(static_cast<Cause>(k)).name,
      keyed_decrease(b.key(fmt::format("budget.{}.darkened", k)), step.darkened()),
      keyed(b.key(fmt::format("budget.{}.lightened", k)), step.lightened(), signed_number(step.lightened())),
      keyed(b.key(fmt::format("budget.{}.signed", k)), step.signed_mean,
            signed_number(beyond_rounding(step.signed_mean, step.absolute_mean))),
      keyed(b.key(fmt::format("budget.{}.absolute", k)), step.absolute_mean,
            unsigned_number(step.absolute_mean)));
}

std::string place_in_texels(double bias, double texel) {
  return texel > 0.0 ? fmt::format(" ({})", texels_text(bias / texel)) : std::string();
}

// Where the best lies far out on a plateau.
std::string smaller_bias_words(const BestBias& best, double texel) {
  if (!best.smaller) return {};
  return fmt::format(" The smaller {}{} leaves hardly more: {}.", plain_number(best.smaller->constant_world),
                     place_in_texels(best.smaller->constant_world, texel),
                     percent(best.smaller->wrong_fraction));
}

std::string bias_words(const LightBlock& b) {
  const BestBias& best = b.light.best_bias;
  const auto value = [&b](std::string_view key, double v) {
    return keyed(b.key(fmt::format("best_bias.{}", key)), v, plain_number(v));
  };
  const double texel = b.light.bias_texel_world;
  const raster::Bias& drawn = b.in.comparison.raster.options.map.bias;
  const bool more = !bias_parts(drawn).empty();
  std::string text = fmt::format(
      R"(A hard test shadows a pixel when its gap, the distance to the light minus the stored one{}, is
larger than the constant bias. Sorting the gaps of one render gives the exact error of every constant bias.
The best is {}{}, which leaves {} wrong.{})",
      more ? " and the other parts of the bias" : "", value("constant_world", best.constant_world),
      place_in_texels(best.constant_world, texel),
      keyed(b.key("best_bias.wrong_fraction"), best.wrong_fraction, percent(best.wrong_fraction)),
      smaller_bias_words(best, texel));
  if (best.feasible) return text + " Some constant bias makes every compared pixel right.";
  return text + " " + escaped(contradiction(best, texel, drawn));
}

std::string fact(std::string_view name, const std::string& value, const std::string& what) {
  return fmt::format("<div><dt>{}</dt><dd class=\"big\">{}</dd><dd>{}</dd></div>\n", name, value, what);
}

std::string fact_value(const LightBlock& b, std::string_view key, double value) {
  return keyed(b.key(key), value, plain_number(value));
}

std::string seam_facts(const LightBlock& b) {
  if (!b.light.seams) return "";
  const SeamCount& seams = *b.light.seams;
  return fact("Seams", keyed_things(b.key("seams.changed"), seams.changed, "receiver"),
              fmt::format("that the next cascade would draw otherwise, of {} beside another cascade",
                          keyed_things(b.key("seams.at_border"), seams.at_border, "receiver")));
}

std::string edge_facts(const LightBlock& b) {
  const EdgeStats& e = b.light.edges;
  if (e.edges == 0) return "";
  return fact("Edge error", fact_value(b, "edges.rms_texels", e.rms_texels) + " texels",
              fmt::format("root mean square over {} on true edges; {} pixels on the screen",
                          keyed_things(b.key("edges.count"), e.edges, "pixel"),
                          fact_value(b, "edges.rms_pixels", e.rms_pixels))) +
         fact("Edge offset",
              keyed(b.key("edges.mean_texels"), e.mean_texels, signed_number(e.mean_texels)) + " texels",
              fmt::format("on average the drawn shadow is {} than the true one",
                          e.mean_texels >= 0.0 ? "larger" : "smaller"));
}

std::string detachment_fact(const LightBlock& b) {
  const Detachment& d = b.light.detachment;
  if (d.pixels == 0) return "";
  return fact("Detachment", fact_value(b, "detachment.mean_world", d.mean_world),
              fmt::format("world units from caster to drawn shadow on {}, {} at most",
                          keyed_things(b.key("detachment.pixels"), d.pixels, "pixel"),
                          fact_value(b, "detachment.max_world", d.max_world)));
}

std::string bleeding_fact(const LightBlock& b) {
  const BleedingStats& bleeding = b.light.bleeding;
  if (bleeding.pixels == 0) return "";
  return fact("Light bleeding", fact_value(b, "bleeding.mean", bleeding.mean),
              fmt::format("mean light that the filter lets into closed shadow, on {}; {} at most",
                          keyed_things(b.key("bleeding.pixels"), bleeding.pixels, "pixel"),
                          fact_value(b, "bleeding.max", bleeding.max)));
}

std::string penumbra_facts(const LightBlock& b) {
  if (!b.light.penumbra || b.light.penumbra->edges == 0) return "";
  const PenumbraStats& p = *b.light.penumbra;
  const auto both = [&](std::string_view what, double truth, double drawn, std::uint64_t edges,
                        std::string_view edge_key) {
    return fmt::format("world units wide as drawn, {} in truth; medians over {}",
                       fact_value(b, fmt::format("penumbra.true_{}_world", what), truth),
                       keyed_things(b.key(fmt::format("penumbra.{}", edge_key)), edges, "edge")) +
           (drawn == 0.0 ? "; the technique draws none" : "");
  };
  std::string text = fact("Penumbra", fact_value(b, "penumbra.drawn_penumbra_world", p.drawn_penumbra_world),
                          both("penumbra", p.true_penumbra_world, p.drawn_penumbra_world, p.edges, "edges"));
  if (p.umbra_edges > 0)
    text += fact("Umbra", fact_value(b, "penumbra.drawn_umbra_world", p.drawn_umbra_world),
                 both("umbra", p.true_umbra_world, p.drawn_umbra_world, p.umbra_edges, "umbra_edges"));
  if (true_record(b.in.comparison, b.light).samples == 1)
    return text + fact("Standard error of the truth", "unknown", "of one sample it cannot be told");
  return text +
         fact("Standard error of the truth",
              fact_value(b, "penumbra.standard_error_mean", p.standard_error_mean),
              fmt::format("mean over pixels that see a part of the light, from its samples; {} at most",
                          fact_value(b, "penumbra.standard_error_max", p.standard_error_max)));
}

// The closed forms beside what was found.
std::string theory_facts(const LightBlock& b) {
  const TheoryStats& t = b.light.theory;
  if (t.acne_free_bias.count == 0) return "";
  const std::string measured =
      t.measured_aliasing.count == 0
          ? std::string()
          : fmt::format(", {} as measured",
                        fact_value(b, "theory.measured_aliasing.median", t.measured_aliasing.median));
  return fact("Bias that theory asks for",
              fact_value(b, "theory.acne_free_bias.median", t.acne_free_bias.median),
              fmt::format("world units keep half of the pixels free of acne, {} keep 99 %",
                          fact_value(b, "theory.acne_free_bias.p99", t.acne_free_bias.p99))) +
         (t.aliasing.count == 0
              ? std::string()
              : fact("A texel on the screen",
                     fact_value(b, "theory.aliasing.median", t.aliasing.median) + " pixels",
                     fmt::format("wide in the median by its footprint{}; {} at the worst "
                                 "hundredth. Perspective makes {} of it, the surface's tilt {}.",
                                 measured, fact_value(b, "theory.aliasing.p99", t.aliasing.p99),
                                 fact_value(b, "theory.perspective.median", t.perspective.median),
                                 fact_value(b, "theory.projection.median", t.projection.median))));
}

std::string texel_fact(const LightBlock& b) {
  const auto& [least, median, most] = b.light.texel_world;
  return fact("Texel width", fact_value(b, "map.texel_world.median", median),
              least == most ? std::string("world units, everywhere")
                            : fmt::format("world units, median; from {} to {} over the compared surface",
                                          fact_value(b, "map.texel_world.min", least),
                                          fact_value(b, "map.texel_world.max", most)));
}

// Where the edges lie wrong and how far shadows stand off: empty where neither was measured.
std::string edge_maps(const LightBlock& b) {
  const LightPictures& pictures = b.in.pictures.lights[b.index];
  if (pictures.edges.png.empty()) return "";
  return fmt::format(
      R"(<div class="pair">
<figure>{}<figcaption>How far drawn shadow edges lie from the true ones, on the band between the two. White: not
at all. {} the drawn shadow is larger, {} smaller; full colour from {:g} texels on.</figcaption></figure>
<figure>{}<figcaption>How far shadows stand off what casts them: black not at all, pale yellow {:g} texels or
more.</figcaption></figure>
</div>
)",
      picture(b.in, pictures.edges,
              "Bands between drawn and true shadow edges, coloured by their width and side.", ""),
      swatch(false_shadow_colour, "+"), swatch(missed_shadow_colour, "\u2212"), edge_scale_texels,
      picture(b.in, pictures.detachment, "Gaps between casters and their shadows, brighter where wider.", ""),
      detachment_scale_texels);
}

}  // namespace

std::string ladder_block(const LightBlock& b) {
  const auto means = b.light.rung_mean;
  std::string rows;
  for (std::size_t k = 0; k < rung_count; ++k) {
    const RungText& rung = rung_text(static_cast<Rung>(k));
    rows += fmt::format(
        R"(<tr><th scope="row"><i>V</i><sub>{}</sub> {}<small>{}</small></th><td class="n">{}</td>{}</tr>
)",
        k, rung.name, rung.what,
        keyed(b.key(fmt::format("ladder.{}.mean", k)), means[k], fmt::format("{:.4f}", means[k])),
        k == 0 || k > known_steps(b.in.comparison) ? "<td></td><td></td><td></td><td></td><td></td>"
                                                   : ladder_step(b, k - 1));
  }
  const std::string table = fmt::format(
      R"(<table class="ladder"><thead><tr><th scope="col">visibility</th><th scope="col" class="n">mean</th>
<th scope="col">charged to</th><th scope="col" class="n">darker</th><th scope="col"
class="n">lighter</th><th scope="col" class="n">signed step</th>
<th scope="col" class="n">absolute</th></tr></thead><tbody>
{}<tr class="sum"><th scope="row">sum of the steps</th><td></td><td></td><td></td><td></td><td class="n">{}</td><td></td></tr>
</tbody></table>)",
      rows, signed_number(beyond_rounding(means.back() - means.front(), means.back() + means.front())));
  return R"(<h3>The ladder, from the truth to what was drawn</h3>
<p>Each rung changes one thing. The signed steps add up to the whole difference, exactly; an
absolute step much larger than its signed one is error that cancels out on average, but not in the
picture.</p>
)" + scroll_region("The ladder of light " + std::to_string(b.index + 1), table) +
         lesson_details(lesson("error-budget"));
}

std::string bias_block(const LightBlock& b) {
  if (b.light.pixels.compared == 0) return "";
  if (!b.light.bias_curve_withheld.empty())
    return "<h3>How the error depends on the bias</h3>\n<p>" + escaped(b.light.bias_curve_withheld) +
           "</p>\n" + engine_units_table(b);
  const double used = drawn_record(b.in.comparison, b.light).bias_constant_world;
  const std::string chart = bias_chart(b.light, used, fmt::format("bias-{}", b.index));
  if (chart.empty()) return "";
  return "<h3>How the error depends on the bias, from this one render</h3>\n<p>" + bias_words(b) + "</p>\n" +
         scroll_region("Chart of wrong pixels against the bias of light " + std::to_string(b.index + 1),
                       chart) +
         bias_kinds_table(b) + engine_units_table(b) + lesson_details(lesson("bias"));
}

std::string facts_block(const LightBlock& b) {
  const ErrorStats& error = b.light.error;
  const auto alone = [&b](const char* key, double value) {
    return std::isfinite(value) ? fmt::format("; over compared pixels alone {}", fact_value(b, key, value))
                                : std::string();
  };
  return R"(<h3>How far, how visible</h3>
<dl class="facts">
)" + (lacks_map(b.in.comparison) ? "" : seam_facts(b) + edge_facts(b)) +
         detachment_fact(b) + bleeding_fact(b) + penumbra_facts(b) +
         (lacks_map(b.in.comparison) ? "" : texel_fact(b) + theory_facts(b)) +
         fact("FLIP", fact_value(b, "error.flip", error.flip),
              "how visible the difference is when the two visibility pictures are flipped: 0 not at all, 1 "
              "entirely" +
                  alone("error.flip_compared", error.flip_compared)) +
         (std::isfinite(error.ssim)
              ? fact("SSIM", fact_value(b, "error.ssim", error.ssim),
                     "how alike the structure of the two visibility pictures is: 1 the same" +
                         alone("error.ssim_compared", error.ssim_compared))
              : std::string()) +
         fact("Mean error", fact_value(b, "error.mean_absolute", error.mean_absolute),
              fmt::format("mean |<i>V</i><sub>6</sub> \u2212 <i>V</i><sub>0</sub>|; root mean square {}",
                          fact_value(b, "error.rms", error.rms))) +
         "</dl>\n" + edge_maps(b);
}

std::string depth_map_block(const LightBlock& b) {
  if (lacks_map(b.in.comparison)) return "";
  const LightPictures& pictures = b.in.pictures.lights[b.index];
  const LightView& view = drawn_record(b.in.comparison, b.light).map.view;
  const int step = pictures.depth_map_small_step;
  return fmt::format(
      R"(<h3>The depth map</h3>
<figure class="depth">{}<figcaption><span class="scale-row"><span>far {}</span>{}<span>near {}</span></span>
Depth from the light in world units{}; dark grey where nothing is stored.{}{}{}</figcaption></figure>
)",
      picture(b.in, pictures.depth_map_small,
              "The depth map: near surfaces bright yellow, far ones dark purple.", ""),
      plain_number(view.depth_range().max), depth_scale(fmt::format("depth-scale-{}", b.index)),
      plain_number(view.depth_range().min),
      view.projection == LightProjection::perspective ? ", on a logarithmic scale" : "",
      view.face_count == 1 ? ""
      : view.projection == LightProjection::perspective
          ? " Six faces: +x, \u2212x, +y above \u2212y, +z, \u2212z."
          : " Each cascade's own map, the finest first.",
      step > 1 ? fmt::format(" One pixel shows the nearest of {} \u00d7 {} texels.", step, step) : "",
      compares_depths(b.in.comparison)
          ? ""
          : " This technique does not read it: it is what a hard test would look up.");
}

}  // namespace gnomon::compare
