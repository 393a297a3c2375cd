// The results: what is wrong, how much of it, why, what another bias would make of it, and what it took.
#include <fmt/core.h>
#include <imgui/imgui.h>

#include <algorithm>
#include <cmath>

#include "compare/ladder/labels.h"
#include "compare/result/number_text.h"
#include "compare/result/outputs.h"
#include "compare/result/palette.h"
#include "lab/view/panels/panels.h"
#include "lab/view/state/status.h"

namespace gnomon::lab {

namespace {

using compare::LightComparison;

/// Returns the colour of a step that a wrong pixel is charged to.
ImU32 step_colour(std::size_t step, compare::Ladder ladder) {
  return colour(compare::label_colour(compare::step_text(static_cast<compare::Cause>(step), ladder).label));
}

void right_aligned(const std::string& text) {
  const float width = ImGui::CalcTextSize(text.c_str()).x;
  ImGui::SameLine(std::max(0.0f, ImGui::GetContentRegionAvail().x + ImGui::GetCursorPosX() - width));
  ImGui::TextUnformatted(text.c_str());
}

void swatch(ImU32 fill) {
  const float size = ImGui::GetTextLineHeight();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 low{at.x, at.y + 0.15f * size}, high{at.x + 0.7f * size, at.y + 0.85f * size};
  ImGui::GetWindowDrawList()->AddRectFilled(low, high, fill);
  ImGui::GetWindowDrawList()->AddRect(low, high, ImGui::GetColorU32(ImGuiCol_TextDisabled));
  ImGui::Dummy({0.8f * size, size});
  ImGui::SameLine();
}

std::string signed_percent(double share) {
  if (std::abs(share) < 1e-5) return "0 %";  // less than is written of any share
  return (share < 0.0 ? "\u2212" : "+") + compare::percent(std::abs(share));
}

/// The mean absolute error of each step, side by side; the whole bar is their sum.
void budget(const PanelContext& context, const LightComparison& light, compare::Ladder ladder) {
  ImGui::TextUnformatted("Error budget");
  double sum = 0.0;
  for (const compare::BudgetStep& step : light.budget) sum += step.absolute_mean;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 size{ImGui::GetContentRegionAvail().x, 1.3f * ImGui::GetFontSize()};
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(at, {at.x + size.x, at.y + size.y}, context.ink.grid);
  float x = at.x;
  for (std::size_t i = 0; sum > 0.0 && i < light.budget.size(); ++i) {
    const auto width = static_cast<float>(light.budget[i].absolute_mean / sum) * size.x;
    draw.AddRectFilled({x, at.y}, {x + width, at.y + size.y}, step_colour(i, ladder));
    x += width;
  }
  ImGui::Dummy(size);
  for (std::size_t i = 0; i < light.budget.size(); ++i) {
    const compare::BudgetStep& step = light.budget[i];
    if (step.absolute_mean == 0.0) continue;
    const compare::StepText& words = compare::step_text(static_cast<compare::Cause>(i), ladder);
    swatch(step_colour(i, ladder));
    ImGui::TextUnformatted(std::string(words.name).c_str());
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("What: %s.", std::string(words.what).c_str());
    right_aligned(
        fmt::format("{} ({})", compare::percent(step.absolute_mean), signed_percent(step.signed_mean)));
  }
  faint("What each step changes of the light, on average (\u2212: it makes it darker).");
}

void labels(const LightComparison& light) {
  if (!ImGui::CollapsingHeader("Labels", ImGuiTreeNodeFlags_DefaultOpen)) return;
  for (std::size_t i = 0; i < compare::class_count; ++i) {
    if (light.classes[i] == 0 && !(light.class_errors[i] > 0.0)) continue;
    const auto label = static_cast<compare::Label>(i + 1);
    const compare::LabelText& words = compare::label_text(label);
    swatch(colour(compare::label_colour(label)));
    ImGui::Text("%s  %s", std::string(words.letter).c_str(), std::string(words.name).c_str());
    if (ImGui::IsItemHovered()) {
      ImGui::BeginTooltip();
      wrapped(fmt::format("What: {}.", words.what), 26.0f * ImGui::GetFontSize());
      wrapped(fmt::format("Why: {}", words.cause), 26.0f * ImGui::GetFontSize());
      wrapped(fmt::format("Cure: {}", words.cure), 26.0f * ImGui::GetFontSize());
      ImGui::EndTooltip();
    }
    right_aligned(light.error.fractional > 0 ? fmt::format("{} ({})", compare::grouped(light.classes[i]),
                                                           compare::percent(light.class_errors[i]))
                                             : compare::grouped(light.classes[i]));
  }
  ImGui::TextDisabled("wrong pixels%s, of %s compared",
                      light.error.fractional > 0 ? " (share of the mean error)" : "",
                      compare::grouped(light.pixels.compared).c_str());
}

void row(const char* what, const std::string& time) {
  ImGui::TextUnformatted(what);
  right_aligned(time);
}

void times(const PanelContext& context) {
  if (!ImGui::CollapsingHeader("Times", ImGuiTreeNodeFlags_DefaultOpen)) return;
  const Readings now = readings_of(context.shown, context.state);
  row("Live picture, with reading back",
      now.raster_ms > 0.0 ? compare::milliseconds(now.raster_ms) : "not timed yet");
  const ShadowTimeWords words = shadow_time_words(context.shown, context.state);
  for (const auto& [name, time] : words.rows) wrapped(fmt::format("{}: {}", name, time));
  if (!words.by.empty()) faint(words.by);
}

}  // namespace

void results_panel(PanelContext& context) {
  const ComparisonOutcome* outcome = context.outcome();
  if (outcome == nullptr) return faint("Comparing ...");
  const LightComparison& light = outcome->comparison.lights.front();
  wrapped(outcome->verdict.headline());
  if (!outcome->verdict.detail.empty()) faint(outcome->verdict.detail);
  if (!context.is_current()) {
    faint("These are of the setting before; the new one is being compared.");
  } else if (outcome->preview) {
    faint("Of a picture a quarter as wide; the whole one follows.");
  } else {
    faint("Of the whole picture.");
  }
  ImGui::Separator();
  probe_panel(context);
  budget(context, light, compare::ladder_of(context.state.setup.map.technique));
  labels(light);
  curve_panel(context);
  times(context);
}

}  // namespace gnomon::lab
