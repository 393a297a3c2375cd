// The pixel that was clicked: why it is wrong, its ladder, and the cut through the map there.
#include <fmt/core.h>
#include <imgui/imgui.h>

#include <algorithm>
#include <cmath>

#include "compare/ladder/labels.h"
#include "compare/result/number_text.h"
#include "compare/result/outputs.h"
#include "compare/result/palette.h"
#include "lab/view/panels/panels.h"
#include "lab/view/state/pixel_story.h"

namespace gnomon::lab {

namespace {

void ladder(const PanelContext& context, const PixelStory& story) {
  if (!ImGui::BeginTable("ladder", 3, ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_BordersInnerH))
    return;
  for (std::size_t k = 0; k < compare::rung_count; ++k) {
    const compare::RungText& rung = compare::rung_text(static_cast<compare::Rung>(k), story.ladder);
    const bool here = story.deciding == static_cast<int>(k) && k > 0;
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    if (here) ImGui::PushStyleColor(ImGuiCol_Text, context.ink.warning);
    ImGui::Text("%s %s", std::string(rung.symbol).c_str(), std::string(rung.name).c_str());
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", std::string(rung.what).c_str());
    ImGui::TableNextColumn();
    ImGui::Text("%.3g", story.rungs[k]);
    ImGui::TableNextColumn();
    if (here) {
      ImGui::TextUnformatted("wrong from here");
    } else if (k == 0) {
      ImGui::TextUnformatted(story.rungs[0] > 0.5 ? "lit" : "in shadow");
    }
    if (here) ImGui::PopStyleColor();
  }
  ImGui::EndTable();
}

/// From (texels, distance) to the screen: the light is above, distance grows downwards.
struct SlicePlot {
  ImVec2 corner, size;
  double first, last, near, far;
  ImVec2 at(double t, double distance) const {
    const double y = std::clamp((distance - near) / (far - near), -4.0, 5.0);
    return {corner.x + size.x * static_cast<float>((t - first) / (last - first)),
            corner.y + size.y * static_cast<float>(y)};
  }
};

SlicePlot frame_of(const LightCut& cut) {
  SlicePlot frame;
  frame.corner = ImGui::GetCursorScreenPos();
  frame.size = {ImGui::GetContentRegionAvail().x, 11.0f * ImGui::GetFontSize()};
  frame.first = cut.first;
  frame.last = cut.first + static_cast<double>(cut.stored.size());
  double near = cut.distance, far = cut.distance;
  const auto add = [&](double d) {
    if (std::isfinite(d)) near = std::min(near, d), far = std::max(far, d);
  };
  // The own texel and its neighbours must be seen; what lies farther off may be cut.
  const std::size_t own = cut.stored.size() / 2;
  for (std::size_t i = own > 0 ? own - 1 : 0; i <= std::min(own + 1, cut.stored.size() - 1); ++i) {
    add(cut.stored[i]);
    add(cut.stored[i] + cut.bias);
  }
  for (const Vec2& p : cut.receiver) add(p.y);
  const double margin = 0.12 * std::max(far - near, 1e-9 * std::max(1.0, std::abs(far)));
  frame.near = near - margin, frame.far = far + margin;
  return frame;
}

void texel_columns(const PanelContext& context, const LightCut& cut, const SlicePlot& frame) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float em = ImGui::GetFontSize();
  const ImU32 shade =
      context.state.look.theme == Theme::dark ? IM_COL32(255, 255, 255, 20) : IM_COL32(0, 0, 0, 20);
  const float bottom = frame.corner.y + frame.size.y;
  for (std::size_t i = 0; i < cut.stored.size(); ++i) {
    const double t = cut.first + static_cast<double>(i);
    const bool own = i == cut.stored.size() / 2;
    const ImVec2 left = frame.at(t, frame.near), right = frame.at(t + 1.0, frame.near);
    if (own) draw.AddRectFilled({left.x, frame.corner.y}, {right.x, bottom}, shade);
    draw.AddLine({left.x, frame.corner.y}, {left.x, bottom}, context.ink.grid);
    if (!std::isfinite(cut.stored[i])) continue;
    const ImVec2 a = frame.at(t, cut.stored[i]), b = frame.at(t + 1.0, cut.stored[i]);
    const ImVec2 c = frame.at(t, cut.stored[i] + cut.bias), d = frame.at(t + 1.0, cut.stored[i] + cut.bias);
    draw.AddRectFilled({c.x, c.y}, {d.x, bottom}, shade);  // what the test believes to be in shadow
    draw.AddLine(a, b, context.ink.text, (own ? 0.25f : 0.16f) * em);
    if (cut.bias != 0.0) draw.AddLine(c, d, context.ink.accent, 0.1f * em);
  }
}

void drawing(const PanelContext& context, const LightCut& cut, const PixelStory& story) {
  const SlicePlot frame = frame_of(cut);
  const float em = ImGui::GetFontSize();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImVec2 end{frame.corner.x + frame.size.x, frame.corner.y + frame.size.y};
  draw.AddRectFilled(frame.corner, end, context.ink.paper);
  draw.PushClipRect(frame.corner, end, true);
  texel_columns(context, cut, frame);
  for (const Vec2& p : cut.neighbours)
    draw.AddCircleFilled(frame.at(p.x, p.y), 0.09f * em, context.ink.faint, 6);
  std::vector<ImVec2> plane;
  for (const Vec2& p : cut.receiver) plane.push_back(frame.at(p.x, p.y));
  draw.AddPolyline(plane.data(), static_cast<int>(plane.size()), context.ink.good, 0, 0.12f * em);
  draw.AddCircleFilled(frame.at(cut.at, cut.distance), 0.3f * em, colour(compare::label_colour(story.label)));
  draw.AddCircle(frame.at(cut.at, cut.distance), 0.3f * em, context.ink.text, 0, 0.1f * em);
  draw.PopClipRect();
  draw.AddRect(frame.corner, end, context.ink.grid);
  ImGui::Dummy(frame.size);
  faint(fmt::format(
      "The light is above; across, {} texels along {}. Thick: stored depth; thin: with the constant bias; "
      "line: the receiver's plane; dots: pixels beside it.",
      cut.stored.size(), cut.along_v ? "v" : "u"));
}

/// The map around the pixel, as the light sees it.
void light_space_drawing(const PanelContext& context, const LightSpace& space, const PixelStory& story) {
  const float em = ImGui::GetFontSize();
  const float side = std::min(ImGui::GetContentRegionAvail().x, 13.0f * em);
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float texel = side / static_cast<float>(space.side);
  const auto at = [&](double u, double v) {
    return ImVec2{corner.x + static_cast<float>(u - space.first_u) * texel,
                  corner.y + side - static_cast<float>(v - space.first_v) * texel};
  };
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.PushClipRect(corner, {corner.x + side, corner.y + side}, true);
  for (int i = 0; i < space.side * space.side; ++i) {
    const int column = space.first_u + i % space.side, row = space.first_v + i / space.side;
    const double nearer = space.nearer[static_cast<std::size_t>(i)];
    const ImU32 fill = std::isnan(nearer)        ? context.ink.paper
                       : nearer > space.bias     ? IM_COL32(70, 74, 84, 255)
                       : nearer > space.rounding ? IM_COL32(150, 154, 162, 255)
                                                 : IM_COL32(236, 234, 226, 255);
    const ImVec2 low = at(column, row), high = at(column + 1, row + 1);
    draw.AddRectFilled({low.x, high.y}, {high.x, low.y}, fill);
    draw.AddRect({low.x, high.y}, {high.x, low.y}, IM_COL32(110, 114, 122, 255));
  }
  for (const Vec2& p : space.neighbours)
    draw.AddCircleFilled(at(p.x, p.y), 0.09f * em, IM_COL32(0, 114, 178, 255), 6);
  const ImVec2 own = at(space.u, space.v);
  draw.AddCircleFilled(own, 0.3f * em, colour(compare::label_colour(story.label)));
  draw.AddCircle(own, 0.3f * em, IM_COL32(0, 0, 0, 255), 0, 0.1f * em);
  draw.PopClipRect();
  ImGui::Dummy({side, side});
  faint(
      "The map around it, seen from the light: dark texels shadow this surface, grey ones only without the "
      "constant bias, bright ones never. Dots: pixels beside it.");
}

}  // namespace

void probe_panel(PanelContext& context) {
  if (!ImGui::CollapsingHeader("One pixel", ImGuiTreeNodeFlags_DefaultOpen)) return;
  if (!context.state.look.probe) return faint("Click a pixel of the picture to have it explained.");
  const ComparisonOutcome& outcome = *context.outcome();
  const ImageSize picture = context.layout.picture;
  const PixelStory story = tell_story(outcome, *context.state.look.probe, picture);
  const compare::LabelText& words = compare::label_text(story.label);
  const float size = ImGui::GetTextLineHeight();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 corner{at.x + 0.8f * size, at.y + size};
  ImGui::GetWindowDrawList()->AddRectFilled(at, corner, colour(compare::label_colour(story.label)));
  ImGui::GetWindowDrawList()->AddRect(at, corner, ImGui::GetColorU32(ImGuiCol_TextDisabled));
  ImGui::Dummy({0.9f * size, size});
  ImGui::SameLine();
  ImGui::TextUnformatted(
      fmt::format("{}, {}: {}", context.state.look.probe->x, context.state.look.probe->y, words.name)
          .c_str());
  wrapped(story.words);
  if (!story.cure.empty()) wrapped("What helps: " + story.cure);
  for (const std::string& remark : story.remarks) wrapped(remark);
  if (!story.seen) return;
  if (compare::is_compared(story.label)) ladder(context, story);
  static constexpr int texels = 4;
  if (const auto cut = cut_through(outcome, story, texels)) drawing(context, *cut, story);
  if (const auto space = light_space(outcome, story, texels)) light_space_drawing(context, *space, story);
  const std::string gap = std::isfinite(story.gap) ? fmt::format("gap {:.4g}", story.gap) : "nothing stored";
  faint(fmt::format("{}, distance {:.5g}, texel {:.2f}, {:.2f}{}", gap, story.distance, story.u, story.v,
                    outcome.comparison.raster.lights.front().map.view.face_count > 1
                        ? fmt::format(", face {}", story.face + 1)
                        : ""));
  ImGui::Spacing();
}

}  // namespace gnomon::lab
