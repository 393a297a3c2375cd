// Everything about one light: pictures of what is wrong, the labels, the ladder, every constant bias, edges,
// the map.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "compare/number_text.h"
#include "compare/option_names.h"
#include "compare/output_parts.h"
#include "compare/outputs.h"
#include "compare/palette.h"
#include "compare/report/charts.h"
#include "compare/report/explanations.h"
#include "compare/report/html.h"
#include "compare/report/sections.h"

namespace gnomon::compare {
namespace {

// One light with what its blocks need at hand.
struct Block {
  const PageInput& in;
  std::size_t index;
  const LightComparison& light;
  std::string key(std::string_view rest) const { return light_key(index, rest); }
  std::string share(std::uint64_t pixels) const {
    return percent(static_cast<double>(pixels) /
                   static_cast<double>(std::max<std::uint64_t>(light.pixels.compared, 1)));
  }
};

std::string swatch(const glm::u8vec3& c, std::string_view letter) {
  return fmt::format(
      "<svg class=\"swatch\" viewBox=\"0 0 22 22\" aria-hidden=\"true\" focusable=\"false\"><rect "
      "width=\"22\" "
      "height=\"22\" rx=\"3\" fill=\"{}\"/><text x=\"11\" y=\"16\" fill=\"{}\">{}</text></svg>",
      hex_colour(c.r, c.g, c.b), 2 * c.r + 5 * c.g + c.b > 8 * 110 ? "#000" : "#fff", letter);
}

std::string viewer(const Block& b) {
  std::string options;
  const auto add = [&options](std::string_view id, std::string_view name) {
    options += fmt::format("<option value=\"{}\">{}</option>", id, name);
  };
  add("picture-raster", "rasterized");
  add("picture-raytraced", "ray traced");
  add(fmt::format("picture-difference-{}", b.index), "difference");
  add(fmt::format("picture-labels-{}", b.index), "labels");
  return fmt::format(
      "<div class=\"viewer\" hidden>\n<div class=\"viewer-bar\" role=\"group\" aria-label=\"Compare two "
      "pictures\">\n"
      "<label>Left <select class=\"pick\">{0}</select></label> <label>Right <select "
      "class=\"pick\">{0}</select></label>\n"
      "<span class=\"modes\" role=\"group\" aria-label=\"How\"><button type=\"button\" "
      "data-mode=\"swipe\">Swipe</button>"
      "<button type=\"button\" data-mode=\"side\">Side by side</button><button type=\"button\" "
      "data-mode=\"flip\">Flip"
      "</button></span>\n<span class=\"modes\" role=\"group\" aria-label=\"Zoom\"><button type=\"button\" "
      "data-zoom=\"out\" "
      "aria-label=\"Zoom out\">\u2212</button><output>1\u00d7</output><button type=\"button\" "
      "data-zoom=\"in\" "
      "aria-label=\"Zoom in\">+</button><button type=\"button\" "
      "data-zoom=\"fit\">Fit</button></span>\n</div>\n"
      "<div class=\"stage\" tabindex=\"0\" role=\"group\" aria-label=\"Two pictures of the scene\" "
      "aria-describedby=\"hint-{1}\"><div class=\"pane\"><img alt=\"\"><span class=\"tag\"></span></div>"
      "<div class=\"pane\"><img alt=\"\"><span class=\"tag\"></span></div><div "
      "class=\"divider\"></div></div>\n"
      "<label class=\"slider\">Divider <input type=\"range\" min=\"0\" max=\"100\" value=\"50\"></label>\n"
      "<p class=\"probe\" role=\"status\">Point at a pixel to read it.</p>\n<p class=\"hint\" "
      "id=\"hint-{1}\">Drag to move the divider, "
      "or the picture "
      "once it is enlarged; double-click enlarges. Keys: <kbd>F</kbd> flips, <kbd>+</kbd> <kbd>\u2212</kbd> "
      "<kbd>0</kbd> zoom, "
      "arrows move, <kbd>Shift</kbd> with arrows reads pixels.</p>\n</div>\n",
      options, b.index);
}

std::string difference_figure(const Block& b) {
  const ErrorStats& e = b.light.error;
  return fmt::format(
      "<figure>{}<figcaption>{} <b>False shadow</b>: drawn dark, truly lit, {} pixels. {} <b>Missed "
      "shadow</b>: drawn lit, "
      "truly dark, {} pixels.</figcaption></figure>\n",
      picture(
          b.in.pictures.lights[b.index].difference,
          "The picture in grey; pixels with a false shadow in orange, with a missed shadow in light blue.",
          fmt::format("picture-difference-{}", b.index)),
      swatch(false_shadow_colour, "\u2212"), keyed_count(b.key("error.false_shadow"), e.false_shadow),
      swatch(missed_shadow_colour, "+"), keyed_count(b.key("error.missed_shadow"), e.missed_shadow));
}

std::string label_figure(const Block& b) {
  return fmt::format(
      "<figure>{}<figcaption>Each wrong pixel in the colour of its label; grey means right: light where "
      "lit, darker where in shadow.</figcaption></figure>\n",
      picture(b.in.pictures.lights[b.index].labels, "Every wrong pixel in the colour of its label.",
              fmt::format("picture-labels-{}", b.index)));
}

// --- labels
// ----------------------------------------------------------------------------------------------------------

std::vector<std::size_t> occurring_classes(const LightComparison& light) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < class_count; ++k)
    if (light.classes[k] > 0) order.push_back(k);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return light.classes[a] > light.classes[b]; });
  return order;
}

std::string label_row(const Block& b, Label label, const std::string& pixels, std::uint64_t count,
                      bool share) {
  const LabelText& text = label_text(label);
  const glm::u8vec3 c = label_colour(label);
  return fmt::format(
      "<tr data-colour=\"{}\" data-label=\"{}\"><td>{}</td><th scope=\"row\">{}<small>{}</small></th>"
      "<td class=\"n\">{}</td><td class=\"n\">{}</td></tr>\n",
      hex_colour(c.r, c.g, c.b), text.name, swatch(c, text.letter), text.name, text.what, pixels,
      share ? b.share(count) : "");
}

std::string label_table(const Block& b) {
  const PixelCounts& p = b.light.pixels;
  std::string rows;
  for (const std::size_t k : occurring_classes(b.light)) {
    const Label label = static_cast<Label>(k + 1);
    const std::uint64_t n = b.light.classes[k];
    rows += label_row(b, label, keyed_count(b.key(fmt::format("classes.{}", label_name(label))), n), n, true);
  }
  rows += fmt::format(
      "<tr class=\"sum\"><td></td><th scope=\"row\">wrong</th><td class=\"n\">{}</td><td "
      "class=\"n\">{}</td></tr>\n",
      keyed_count(b.key("error.wrong"), b.light.error.wrong),
      keyed(b.key("error.wrong_fraction"), b.light.error.wrong_fraction,
            percent(b.light.error.wrong_fraction)));
  const std::uint64_t right = p.compared - b.light.error.wrong;
  rows += label_row(b, Label::right, grouped(right), right, true);
  rows += fmt::format(
      "<tr class=\"sum\"><td></td><th scope=\"row\">compared</th><td class=\"n\">{}</td><td "
      "class=\"n\">{}</td></tr>\n",
      keyed_count(b.key("pixels.compared"), p.compared), p.compared > 0 ? "100 %" : "");
  const auto other = [&](Label label, std::uint64_t n) {
    if (n > 0)
      rows +=
          label_row(b, label, keyed_count(b.key(fmt::format("pixels.{}", label_name(label))), n), n, false);
  };
  other(Label::uncertain, p.uncertain);
  other(Label::silhouette, p.silhouette);
  other(Label::facing_away, p.facing_away);
  other(Label::background, p.background);
  return fmt::format(
      "<table class=\"labels\"><caption>Labels</caption><thead><tr><td></td><th scope=\"col\">label</th>"
      "<th scope=\"col\" class=\"n\">pixels</th><th scope=\"col\" "
      "class=\"n\">share</th></tr></thead><tbody>\n{}"
      "</tbody></table>\n",
      rows);
}

std::string explanations(const Block& b) {
  std::string items;
  for (const std::size_t k : occurring_classes(b.light)) {
    const Label label = static_cast<Label>(k + 1);
    const LabelText& text = label_text(label);
    items += fmt::format("<div><dt>{}{}</dt><dd>{}</dd><dd class=\"cure\"><b>Cure.</b> {}</dd></div>\n",
                         swatch(label_colour(label), text.letter), text.name, text.cause, text.cure);
  }
  return items.empty()
             ? ""
             : "<h3>What causes it, what cures it</h3>\n<dl class=\"explain\">\n" + items + "</dl>\n";
}

// --- the ladder
// ------------------------------------------------------------------------------------------------------

std::string ladder_table(const Block& b) {
  const auto means = rung_means(b.light);
  std::string rows;
  for (std::size_t k = 0; k < rung_count; ++k) {
    const RungText& rung = rung_text(static_cast<Rung>(k));
    std::string step = "<td></td><td></td><td></td>";
    if (k > 0) {
      const BudgetStep& budget = b.light.budget[k - 1];
      step = fmt::format("<td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>",
                         step_text(static_cast<Cause>(k - 1)).name,
                         keyed(b.key(fmt::format("budget.{}.signed", k - 1)), budget.signed_mean,
                               signed_number(budget.signed_mean)),
                         keyed(b.key(fmt::format("budget.{}.absolute", k - 1)), budget.absolute_mean,
                               fmt::format("{:.4f}", budget.absolute_mean)));
    }
    rows += fmt::format(
        "<tr><th scope=\"row\"><i>V</i><sub>{}</sub> {}<small>{}</small></th><td "
        "class=\"n\">{}</td>{}</tr>\n",
        k, rung.name, rung.what,
        keyed(b.key(fmt::format("ladder.{}.mean", k)), means[k], fmt::format("{:.4f}", means[k])), step);
  }
  const double sum = means.back() - means.front();
  return fmt::format(
      "<h3>The ladder, from the truth to what was drawn</h3>\n<p>Each rung changes one thing. The signed "
      "steps add up to "
      "the whole difference, exactly; an absolute step much larger than its signed one is error that cancels "
      "out on "
      "average, but not in the picture.</p>\n<div class=\"scroll\" role=\"region\" tabindex=\"0\" "
      "aria-label=\"The ladder\"><table class=\"ladder\"><thead><tr><th scope=\"col\">visibility</th><th "
      "scope=\"col\" "
      "class=\"n\">mean</th><th scope=\"col\">charged to</th><th scope=\"col\" class=\"n\">signed step</th>"
      "<th scope=\"col\" class=\"n\">absolute</th></tr></thead><tbody>\n{}<tr class=\"sum\"><th "
      "scope=\"row\">sum of the "
      "steps</th><td></td><td></td><td class=\"n\">{}</td><td "
      "class=\"n\">{}</td></tr></tbody></table></div>\n",
      rows, signed_number(sum), "");
}

// --- every constant bias
// ---------------------------------------------------------------------------------------------

std::string bias_words(const Block& b) {
  const BestBias& best = b.light.best_bias;
  const double texel = b.light.texel_world[1];
  const std::string best_text =
      texel > 0.0 ? fmt::format(" ({})", texels_text(best.constant_world / texel)) : std::string();
  std::string text = fmt::format(
      "A hard test shadows a pixel when its gap, the distance to the light minus the stored one, is larger "
      "than the bias. "
      "Sorting the gaps of one render gives the exact error of every constant bias. The best is {}{}, which "
      "leaves {} "
      "wrong.",
      keyed(b.key("best_bias.constant_world"), best.constant_world, plain_number(best.constant_world)),
      best_text, keyed(b.key("best_bias.wrong_fraction"), best.wrong_fraction, percent(best.wrong_fraction)));
  if (best.feasible) {
    text += " Some constant bias makes every compared pixel right.";
  } else if (std::isfinite(best.needs_less_than)) {
    text += fmt::format(
        " No constant bias can be right everywhere: {} lit pixels need at least {}, up to {}, and {} "
        "shadowed pixels need "
        "less than that, down to {}.",
        keyed_count(b.key("best_bias.lit_pixels_above"), best.lit_pixels_above),
        keyed(b.key("best_bias.needs_less_than"), best.needs_less_than, plain_number(best.needs_less_than)),
        keyed(b.key("best_bias.needs_more_than"), best.needs_more_than, plain_number(best.needs_more_than)),
        keyed_count(b.key("best_bias.shadowed_pixels_below"), best.shadowed_pixels_below),
        plain_number(best.needs_less_than));
  } else {
    text +=
        " No constant bias can be right everywhere: some shadowed pixels find no caster stored in the map.";
  }
  return "<p>" + text + "</p>\n";
}

std::string bias_block(const Block& b) {
  const std::string chart = bias_chart(b.light, drawn_record(b.in.comparison, b.light).bias_constant_world,
                                       fmt::format("bias-{}", b.index));
  if (chart.empty()) return "";
  return "<h3>Every constant bias, from this one render</h3>\n" + bias_words(b) +
         "<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"Chart of wrong pixels against "
         "the bias\">" +
         chart + "</div>\n";
}

// --- edges, gaps, the map
// --------------------------------------------------------------------------------------------

std::string fact(std::string_view name, const std::string& value, std::string_view what) {
  return fmt::format("<div><dt>{}</dt><dd class=\"big\">{}</dd><dd>{}</dd></div>\n", name, value, what);
}

std::string number_fact(const Block& b, std::string_view key, double value) {
  return keyed(b.key(key), value, plain_number(value));
}

std::string facts(const Block& b) {
  const LightComparison& l = b.light;
  std::string out;
  if (l.edges.edges > 0) {
    out += fact("Edge error", number_fact(b, "edges.rms_texels", l.edges.rms_texels) + " texels",
                fmt::format("root mean square over {} true edge pixels; {} pixels on the screen",
                            keyed_count(b.key("edges.count"), l.edges.edges),
                            number_fact(b, "edges.rms_pixels", l.edges.rms_pixels)));
    out += fact("Edge offset", number_fact(b, "edges.mean_texels", l.edges.mean_texels) + " texels",
                l.edges.mean_texels >= 0.0 ? "on average the drawn shadow is larger than the true one"
                                           : "on average the drawn shadow is smaller than the true one");
  }
  if (l.detachment.pixels > 0)
    out += fact("Detachment", number_fact(b, "detachment.mean_world", l.detachment.mean_world),
                fmt::format("world units from caster to drawn shadow on {} pixels, {} at most",
                            keyed_count(b.key("detachment.pixels"), l.detachment.pixels),
                            number_fact(b, "detachment.max_world", l.detachment.max_world)));
  out += fact("Texel width", number_fact(b, "map.texel_world.median", l.texel_world[1]),
              fmt::format("world units, median; from {} to {} over the compared surface",
                          number_fact(b, "map.texel_world.min", l.texel_world[0]),
                          number_fact(b, "map.texel_world.max", l.texel_world[2])));
  out += fact(
      "FLIP", number_fact(b, "error.flip", l.error.flip),
      "how visible the difference is when the two visibility pictures are flipped: 0 not at all, 1 entirely");
  out += fact("Mean error", number_fact(b, "error.mean_absolute", l.error.mean_absolute),
              fmt::format("mean |<i>V</i><sub>6</sub> \u2212 <i>V</i><sub>0</sub>|; root mean square {}",
                          number_fact(b, "error.rms", l.error.rms)));
  return "<h3>How far, how visible</h3>\n<dl class=\"facts\">\n" + out + "</dl>\n";
}

std::string depth_map_block(const Block& b) {
  const raster::ShadowMap& map = drawn_record(b.in.comparison, b.light).map;
  const EncodedPicture& shown = b.in.pictures.lights[b.index].depth_map_small;
  const bool cube = map.view.face_count > 1;
  const int step = cube ? (3 * map.view.size + shown.size.width - 1) / shown.size.width
                        : (map.view.size + shown.size.width - 1) / shown.size.width;
  return fmt::format(
      "<h3>The depth map</h3>\n<figure class=\"depth\">{}<figcaption><span class=\"scale-row\"><span>far "
      "{}</span>{}<span>near "
      "{}</span></span> Depth from the light in world units; dark grey where nothing is "
      "stored.{}{}</figcaption></figure>\n",
      picture(shown, "The depth map: near surfaces bright yellow, far ones dark purple.", ""),
      plain_number(map.view.far_depth), depth_scale(fmt::format("depth-scale-{}", b.index)),
      plain_number(map.view.near_depth),
      cube ? " Six faces: +x, \u2212x, +y above \u2212y, +z, \u2212z." : "",
      step > 1 ? fmt::format(" One pixel shows the nearest of {} \u00d7 {} texels.", step, step) : "");
}

std::string where(const Light& light) {
  const auto text = [](const Vec3& v) {
    return fmt::format("({}, {}, {})", plain_number(v.x), plain_number(v.y), plain_number(v.z));
  };
  if (light.type == LightType::directional) return "shining along " + text(light.direction);
  if (light.type == LightType::point) return "at " + text(light.position);
  return "at " + text(light.position) + ", shining along " + text(light.direction);
}

}  // namespace

std::string light_section(const PageInput& in, std::size_t i) {
  const Block b{in, i, in.comparison.lights[i]};
  const Light& light = light_of(in.comparison, b.light);
  const raster::ShadowMap& map = drawn_record(in.comparison, b.light).map;
  std::string out = fmt::format(
      "<section id=\"light-{0}\" aria-labelledby=\"light-{0}-title\">\n<h2 id=\"light-{0}-title\">Light: "
      "{1}</h2>\n"
      "<p class=\"setting\">{2}, {3}; map of {4}\u202f\u00d7\u202f{4}{5} texels, bias {6} world "
      "units</p>\n{7}",
      i, escaped(shown_light_name(in.comparison, i)), light_type_name(light.type), where(light),
      map.view.size, map.view.face_count > 1 ? "\u202f\u00d7\u202f6" : "",
      plain_number(drawn_record(in.comparison, b.light).bias_constant_world),
      // A single light's verdict stands right above, on the first screen.
      in.comparison.lights.size() == 1
          ? ""
          : fmt::format("<p class=\"lead\">{}</p>\n", escaped(verdict_sentence(in.comparison, b.light))));
  out += viewer(b);
  out += "<div class=\"pair\">\n" + difference_figure(b) + label_figure(b) + "</div>\n";
  if (b.light.pixels.compared == 0) return out + label_table(b) + depth_map_block(b) + "</section>\n";
  out += "<div class=\"columns\">\n<div>" + label_table(b) + "</div>\n<div>" + explanations(b) +
         "</div>\n</div>\n";
  out += ladder_table(b) + bias_block(b) + facts(b) + depth_map_block(b);
  return out + "</section>\n";
}

}  // namespace gnomon::compare
