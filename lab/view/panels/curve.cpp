// The error of every constant bias from one rendering, with the bias as a line that can be dragged.
#include <fmt/core.h>
#include <imgui/imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "compare/result/number_text.h"
#include "compare/result/palette.h"
#include "lab/view/panels/panels.h"
#include "lab/view/state/presets.h"

namespace gnomon::lab {

namespace {

/// Heights go by the square root of the share. Without a bias half of the picture may be wrong, and what a good bias
/// leaves, some per mille, has to be seen beside it.
/// The marks' words stand in lines above the curves.
struct Plot {
  ImVec2 low;  ///< its lower left corner
  ImVec2 size;
  double most_bias, most_share;
  ImVec2 at(double bias, double share) const {
    return {low.x + size.x * static_cast<float>(bias / most_bias),
            low.y - size.y * static_cast<float>(std::sqrt(std::min(share / most_share, 1.0)))};
  }
};

/// Shares of wrong pixels with their numbers at the right, as many as have room.
void scale(const Plot& plot, const Ink& ink) {
  constexpr std::array<double, 7> shares{0.5, 0.2, 0.1, 0.05, 0.01, 0.001, 0.0001};
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float em = ImGui::GetFontSize(), right = plot.low.x + plot.size.x;
  float last = plot.low.y - plot.size.y;
  for (const double share : shares) {
    const float y = plot.at(0.0, share).y;
    if (share > plot.most_share || y - last < 1.2f * em || plot.low.y - y < 0.8f * em) continue;
    const std::string text = compare::percent(share);
    const float left = right - ImGui::CalcTextSize(text.c_str()).x - 0.4f * em;
    draw.AddLine({plot.low.x, y}, {left - 0.2f * em, y}, ink.grid);
    draw.AddText({left, y - 0.5f * em}, ink.faint, text.c_str());
    last = y;
  }
}

void line(const Plot& plot, const compare::LightComparison& light, ImU32 ink,
          double (*share)(const compare::BiasCurvePoint&, double compared)) {
  const auto compared = double(std::max<std::uint64_t>(1, light.pixels.compared));
  std::vector<ImVec2> points;
  for (const compare::BiasCurvePoint& point : light.bias_curve)
    points.push_back(plot.at(point.bias, share(point, compared)));
  ImGui::GetWindowDrawList()->AddPolyline(points.data(), static_cast<int>(points.size()), ink, 0,
                                          0.13f * ImGui::GetFontSize());
}

/// The largest share of wrong pixels that the plot shows, so that its curve fills it.
double most_share(const compare::LightComparison& light) {
  double most = 1.0 / double(std::max<std::uint64_t>(1, light.pixels.compared));
  for (const compare::BiasCurvePoint& point : light.bias_curve) most = std::max(most, point.wrong_fraction);
  return 1.05 * most;
}

/// `line`: of the words above the curves, from below.
void mark(const Plot& plot, double bias, ImU32 ink, const char* name, int line) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImVec2 foot = plot.at(std::clamp(bias, 0.0, plot.most_bias), 0.0);
  const ImVec2 word = ImGui::CalcTextSize(name);
  const float top = plot.low.y - plot.size.y - static_cast<float>(line + 1) * word.y;
  draw.AddLine(foot, {foot.x, top}, ink, 0.13f * ImGui::GetFontSize());
  draw.AddText({std::min(foot.x + 3.0f, plot.low.x + plot.size.x - word.x), top}, ink, name);
}

// "0.128 world units (2 texels): 0.75 % wrong."
std::string setting_text(const compare::BestBias::Setting& setting, double texel) {
  return fmt::format("{:.3g} world units ({}): {} wrong.", setting.constant_world,
                     compare::texels_text(texel > 0.0 ? setting.constant_world / texel : 0.0),
                     compare::percent(setting.wrong_fraction));
}

void drag_bias(PanelContext& context, const Plot& plot) {
  if (!ImGui::IsItemActive()) return;
  const double share = (ImGui::GetIO().MousePos.x - plot.low.x) / plot.size.x;
  const double world = std::clamp(static_cast<double>(share), 0.0, 1.0) * plot.most_bias;
  raster::MapOptions map = context.state.setup.map;
  const double texel = context.shown.live.texel_world;
  set_bias_texels(map.bias, texel > 0.0 ? world / texel : 0.0, texel);
  if (!(map == context.state.setup.map)) context.ask(Change{SetMap{map}});
}

}  // namespace

void curve_panel(PanelContext& context) {
  if (!ImGui::CollapsingHeader("Every constant bias", ImGuiTreeNodeFlags_DefaultOpen)) return;
  const compare::LightComparison& light = context.outcome()->comparison.lights.front();
  if (light.bias_curve.empty()) {
    return faint(light.bias_curve_withheld.empty()
                     ? "What another bias would do is known only once this technique is drawn with it."
                     : std::string(light.bias_curve_withheld));
  }
  const float em = ImGui::GetFontSize();
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const ImVec2 size{ImGui::GetContentRegionAvail().x, 9.5f * em};
  ImGui::InvisibleButton("curve", size);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("Drag: the constant bias");
  const Plot plot{{corner.x, corner.y + size.y},
                  {size.x, size.y - 2.0f * ImGui::GetTextLineHeight()},
                  std::max(1e-300, light.bias_curve.back().bias),
                  most_share(light)};
  drag_bias(context, plot);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(corner, {corner.x + size.x, corner.y + size.y}, context.ink.paper);
  draw.PushClipRect(corner, {corner.x + size.x, corner.y + size.y}, true);
  scale(plot, context.ink);
  line(plot, light, context.ink.text, [](const auto& p, double) { return p.wrong_fraction; });
  line(plot, light, colour(compare::missed_shadow_colour),
       [](const auto& p, double compared) { return double(p.missed_shadow) / compared; });
  line(plot, light, colour(compare::false_shadow_colour),
       [](const auto& p, double compared) { return double(p.false_shadow) / compared; });
  mark(plot, light.best_bias.constant_world, context.ink.good, "best", 1);
  mark(plot, context.shown.live.bias_world, context.ink.accent, "now", 0);
  draw.PopClipRect();
  draw.AddRect(corner, {corner.x + size.x, corner.y + size.y}, context.ink.grid);
  const double texel = light.bias_texel_world;
  faint(fmt::format("Biases from 0 to {:.3g} ({}). Orange: false shadow, blue: missed shadow, {}: both.",
                    plot.most_bias, compare::texels_text(texel > 0.0 ? plot.most_bias / texel : 0.0),
                    context.state.look.theme == Theme::dark ? "white" : "black"));
  const compare::BestBias& best = light.best_bias;
  wrapped("The best constant bias is " + setting_text({best.constant_world, best.wrong_fraction}, texel));
  if (best.smaller) wrapped("Hardly worse is " + setting_text(*best.smaller, texel));
  if (ImGui::Button("Take the best")) {
    raster::MapOptions map = context.state.setup.map;
    map.bias.unit = raster::BiasUnit::world;
    map.bias.constant = best.constant_world;
    context.ask(Change{SetMap{map}});
  }
  ImGui::Spacing();
}

}  // namespace gnomon::lab
