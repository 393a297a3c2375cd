// One light: the viewer, the pictures of what is wrong, the labels and what causes and cures them; then its
// numbers.
#include <fmt/core.h>

#include <algorithm>

#include "compare/ladder/labels.h"
#include "compare/result/judged.h"
#include "compare/result/option_names.h"
#include "compare/result/output_parts.h"
#include "compare/result/outputs.h"
#include "compare/result/palette.h"
#include "compare/result/verdict.h"
#include "report/html.h"
#include "report/lessons.h"
#include "report/light_block.h"
#include "scene/light.h"

namespace gnomon::compare {
namespace {

std::string viewer(const LightBlock& b) {
  std::string options;
  const auto add = [&options](std::string_view id, std::string_view name) {
    options += fmt::format(R"(<option value="{}">{}</option>)", id, name);
  };
  add("picture-raster", "rasterized");
  add("picture-raytraced", "ray traced");
  add(fmt::format("picture-difference-{}", b.index), "difference");
  add(fmt::format("picture-labels-{}", b.index), "labels");
  if (!b.in.pictures.lights[b.index].decisions.png.empty())
    add(fmt::format("picture-decisions-{}", b.index), "who decided");
  return viewer_block(
      options, std::to_string(b.index),
      R"(Point at a pixel to read it, click to pin it; its story is below. Drag to move the divider, or the
picture once it is enlarged; double-click enlarges. Keys: <kbd>F</kbd> flips, <kbd>+</kbd> <kbd>−</kbd>
<kbd>0</kbd> zoom, arrows move, <kbd>Shift</kbd> with arrows steps from pixel to pixel, <kbd>Esc</kbd> lets
go. Exposure is in stops, on linear light, of both pictures. Scales are fixed: the same colour means the same
in every picture.)",
      true);
}

std::string bias_text(const Comparison& c, const LightComparison& light) {
  if (!draws_bias(c) || lacks_map(c)) return "";
  return fmt::format(", bias {} world units", plain_number(drawn_record(c, light).bias_constant_world));
}

std::string difference_figure(const LightBlock& b) {
  const ErrorStats& e = b.light.error;
  return fmt::format(
      "<figure>{}<figcaption>{} <b>False shadow</b>: drawn dark, truly lit, {}. {} <b>Missed "
      "shadow</b>: drawn lit, "
      "truly dark, {}.</figcaption></figure>\n",
      picture(
          b.in, b.in.pictures.lights[b.index].difference,
          "The picture in grey; pixels with a false shadow in orange, with a missed shadow in light blue.",
          fmt::format("picture-difference-{}", b.index)),
      swatch(false_shadow_colour, "\u2212"),
      keyed_things(b.key("error.false_shadow"), e.false_shadow, "pixel"), swatch(missed_shadow_colour, "+"),
      keyed_things(b.key("error.missed_shadow"), e.missed_shadow, "pixel"));
}

std::vector<std::size_t> occurring_classes(const LightComparison& light) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < class_count; ++k)
    if (light.classes[k] > 0) order.push_back(k);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return light.classes[a] > light.classes[b]; });
  return order;
}

std::string label_row(const LightBlock& b, Label label, const std::string& pixels, std::uint64_t count,
                      bool share) {
  const LabelText& text = label_text(label);
  const glm::u8vec3 c = label_colour(label);
  return fmt::format(
      R"(<tr data-colour="{}" data-label="{}"><td>{}</td><th scope="row">{}<small>{}</small></th><td
class="n">{}</td><td class="n">{}</td></tr>
)",
      hex_colour(c.r, c.g, c.b), text.name, swatch(c, text.letter), text.name, text.what, pixels,
      share ? b.share(count) : "");
}

std::string label_table(const LightBlock& b) {
  const PixelCounts& p = b.light.pixels;
  std::string rows;
  for (const std::size_t k : occurring_classes(b.light)) {
    const Label label = static_cast<Label>(k + 1);
    const std::uint64_t n = b.light.classes[k];
    rows += label_row(b, label, keyed_count(b.key(fmt::format("classes.{}", label_name(label))), n), n, true);
  }
  rows += fmt::format(
      R"(<tr class="sum"><td></td><th scope="row">wrong</th><td class="n">{}</td><td class="n">{}</td></tr>
)",
      keyed_count(b.key("error.wrong"), b.light.error.wrong),
      keyed(b.key("error.wrong_fraction"), b.light.error.wrong_fraction,
            percent(b.light.error.wrong_fraction)));
  const std::uint64_t ties = b.light.error.ties;
  if (ties > 0)
    rows += fmt::format(
        R"(<tr><td></td><th scope="row">off by exactly one half (two count as one wrong)</th><td
class="n">{}</td><td class="n">{}</td></tr>
)",
        keyed_count(b.key("error.ties"), ties), b.share(ties));
  const std::uint64_t right = p.compared - b.light.error.wrong - ties;
  rows += label_row(b, Label::right, grouped(right), right, true);
  rows += fmt::format(
      R"(<tr class="sum"><td></td><th scope="row">compared</th><td class="n">{}</td><td
class="n">{}</td></tr>
)",
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
      R"(<table class="labels"><caption>Labels</caption><thead><tr><td></td><th scope="col">label</th><th
scope="col" class="n">pixels</th><th scope="col" class="n">share</th></tr></thead><tbody>
{}</tbody></table>
)",
      rows);
}

std::string explanations(const LightBlock& b) {
  std::string items;
  std::vector<std::string_view> given;  // each lesson once
  for (const std::size_t k : occurring_classes(b.light)) {
    const Label label = static_cast<Label>(k + 1);
    const LabelText& text = label_text(label);
    const Lesson& lesson = lesson_of(label);
    const bool first = std::find(given.begin(), given.end(), lesson.name) == given.end();
    given.push_back(lesson.name);
    items += fmt::format(
        R"(<div><dt>{}{}</dt><dd>{}</dd><dd class="cure"><b>Cure.</b> {}</dd><dd>{}</dd></div>
)",
        swatch(label_colour(label), text.letter), text.name, text.cause, text.cure,
        first ? lesson_details(lesson) : fmt::format("Lesson: {}, above.", escaped(lesson.title)));
  }
  return items.empty() ? "" : R"(<h3>What causes it, what cures it</h3>
<dl class="explain">
)" + items + "</dl>\n";
}

std::string where(const Light& light) {
  const auto text = [](const Vec3& v) {
    return fmt::format("({}, {}, {})", plain_number(v.x), plain_number(v.y), plain_number(v.z));
  };
  if (light.type == LightType::directional) return "shining along " + text(light.direction);
  if (light.type == LightType::point) return "at " + text(light.position);
  return "at " + text(light.position) + ", shining along " + text(light.direction);
}

std::string map_size_text(const Comparison& c, const LightComparison& light) {
  if (lacks_map(c)) return "its map is not known";
  const LightView& view = drawn_record(c, light).map.view;
  return fmt::format(
      "{}map of {}\u202f×\u202f{}{} texels", c.judged && c.judged->identified ? "inferred " : "", view.size,
      view.size, view.face_count > 1 ? fmt::format("\u202f\u00d7\u202f{}", view.face_count) : std::string());
}

}  // namespace

std::size_t labelled_light(const Comparison& c) {
  const auto most = std::max_element(c.lights.begin(), c.lights.end(), [](const auto& a, const auto& b) {
    return a.error.wrong < b.error.wrong;
  });
  return static_cast<std::size_t>(most - c.lights.begin());
}

std::string label_figure(const PageInput& in, std::size_t index) {
  const Comparison& c = in.comparison;
  const std::string light =
      c.lights.size() > 1 ? fmt::format(", light {}", escaped(shown_light_name(c, index))) : std::string();
  return fmt::format(
      "<figure>{}<figcaption><b>Labels</b>{}: each wrong pixel in the colour of its cause; grey is "
      "right.</figcaption></figure>\n",
      picture(in, in.pictures.lights[index].labels, "Every wrong pixel in the colour of its label.",
              fmt::format("picture-labels-{}", index)),
      light);
}

std::string viewer_block(const std::string& options, std::string_view id, std::string_view hint,
                         bool exposure) {
  return fmt::format(
      R"(<div class="viewer" hidden>
<div class="viewer-bar" role="group" aria-label="Compare two pictures">
<label>Left <select class="pick">{0}</select></label> <label>Right <select
class="pick">{0}</select></label>
<span class="modes" role="group" aria-label="How"><button type="button"
data-mode="swipe">Swipe</button><button type="button" data-mode="side">Side by side</button><button
type="button" data-mode="flip">Flip</button></span>
<span class="modes" role="group" aria-label="Zoom"><button type="button" data-zoom="out"
aria-label="Zoom out">−</button><output class="zoom-value">1×</output><button type="button" data-zoom="in"
aria-label="Zoom in">+</button><button type="button" data-zoom="fit">Fit</button></span>
<label class="exposure"{3}>Exposure <input type="range" min="-6" max="6" step="0.25" value="0"></label>
</div>
<div class="stage" tabindex="0" role="group" aria-label="Two pictures of the scene"
aria-describedby="hint-{1}"><div class="pane"><img alt=""><span class="tag"></span></div><div
class="pane"><img alt=""><span class="tag"></span></div><div class="divider"></div></div>
<label class="slider">Divider <input type="range" min="0" max="100" value="50"></label>
<p class="probe" role="status">Point at a pixel to read it.</p>
<p class="hint" id="hint-{1}">{2}</p>
</div>
)",
      options, id, hint, exposure ? "" : " hidden");
}

std::string light_section(const PageInput& in, std::size_t i) {
  const LightBlock b{in, i, in.comparison.lights[i]};
  const Light& light = light_of(in.comparison, b.light);
  std::string out = fmt::format(
      R"(<section id="light-{0}" aria-labelledby="light-{0}-title">
<h2 id="light-{0}-title">Light: {1}</h2>
<p class="setting">{2}, {3}; {4}{5}</p>
{6})",
      i, escaped(shown_light_name(in.comparison, i)), light_type_name(light.type), where(light),
      map_size_text(in.comparison, b.light), bias_text(in.comparison, b.light),
      // A single light's verdict stands right above, on the first screen.
      in.comparison.lights.size() == 1 ? ""
                                       : fmt::format(R"(<p class="lead">{}</p>
)",
                                                     flowing(verdict_on(in.comparison, b.light).whole())));
  out += viewer(b);
  out += R"(<div class="pair">
)" + difference_figure(b);
  // One light's labels stand on the first screen.
  out += (i == labelled_light(in.comparison) ? "" : label_figure(in, i)) + "</div>\n";
  if (b.light.pixels.compared == 0) return out + label_table(b) + depth_map_block(b) + "</section>\n";
  out += R"(<div class="columns">
<div>)" + label_table(b) +
         "</div>\n<div>" + explanations(b) + "</div>\n</div>\n";
  out += hybrid_block(b) + ladder_block(b) + bias_block(b) + facts_block(b) + depth_map_block(b);
  return out + "</section>\n";
}

}  // namespace gnomon::compare
