// What lies over the pictures: their names, the line of a swipe, the pixel that is explained and the one under the
// pointer in every pane. So do the light's handle and the edges of the map.
#include <fmt/core.h>
#include <imgui/imgui.h>

#include <cmath>

#include "lab/view/panels/panels.h"
#include "lab/view/state/projection.h"

namespace gnomon::lab {

namespace {

constexpr ImU32 white = IM_COL32(255, 255, 255, 235), black = IM_COL32(0, 0, 0, 200),
                sun = IM_COL32(255, 210, 60, 255);

ImVec2 at(double x, double y) {
  return {static_cast<float>(x), static_cast<float>(y)};
}

struct Overlay {
  PanelContext& context;
  ImDrawList& draw;
  float em;

  /// The view's name and what its colours stand for, no wider than `most`.
  void name(const Box& pane, Picture picture, double most, bool right = false) const {
    const std::string text(picture_title(picture));
    const std::string legend = most > 12.0 * double(em)
                                   ? broken_to_width(picture_legend(picture), most - double(em))
                                   : std::string();
    const ImVec2 size = ImGui::CalcTextSize(text.c_str()), more = ImGui::CalcTextSize(legend.c_str());
    const ImVec2 all{std::max(size.x, more.x), size.y + (legend.empty() ? 0.0f : more.y)};
    const float x =
        static_cast<float>(right ? pane.x + pane.width : pane.x) + (right ? -all.x - 0.9f * em : 0.5f * em);
    const float y = static_cast<float>(pane.y) + 0.4f * em;
    draw.AddRectFilled({x - 0.2f * em, y - 0.1f * em}, {x + all.x + 0.3f * em, y + all.y + 0.1f * em}, black,
                       0.2f * em);
    draw.AddText({x, y}, white, text.c_str());
    draw.AddText({x, y + size.y}, white, legend.c_str());
  }

  void line(Vec2 a, Vec2 b, ImU32 colour) const {
    draw.AddLine(at(a.x, a.y), at(b.x, b.y), black, 0.22f * em);
    draw.AddLine(at(a.x, a.y), at(b.x, b.y), colour, 0.1f * em);
  }

  /// A cross at a place of the picture, shares of its sides.
  void cross(const Box& place, Vec2 share, ImU32 colour, float reach) const {
    const Vec2 p{place.x + share.x * place.width, place.y + share.y * place.height};
    for (const Vec2 way : {Vec2{1, 0}, Vec2{0, 1}})
      for (const double side : {-1.0, 1.0})
        line(p + way * (side * 0.3 * double(reach)), p + way * (side * double(reach)), colour);
  }

  void edges(const ScreenCamera& camera, const std::vector<std::pair<Vec3, Vec3>>& all, ImU32 colour) const {
    for (const auto& [from, to] : all)
      if (const auto seen = camera.project(from, to)) line(seen->first, seen->second, colour);
  }

  /// What the maps cover, and what the camera sees for which they were laid, where it is frozen.
  void layout_of_maps(const ScreenCamera& camera) const {
    edges(camera, frustum_edges(context.shown.live.map), sun);
    if (const auto& corners = context.shown.live.map_camera) edges(camera, box_edges(*corners), white);
  }

  void handle(const ScreenCamera& camera) const {
    const LightHandle handle = light_handle(context.state);
    const auto place = camera.project(handle.place);
    if (!place) return;
    if (const auto seen = camera.project(handle.place, handle.centre)) line(seen->first, seen->second, sun);
    draw.AddCircleFilled(at(place->x, place->y), 0.62f * em, black);
    draw.AddCircleFilled(at(place->x, place->y), 0.5f * em, sun);
    for (int i = 0; handle.sun && i < 8; ++i) {
      const double a = i * pi / 4.0, r = 0.7 * double(em), s = 0.95 * double(em);
      line(*place + r * Vec2{std::cos(a), std::sin(a)}, *place + s * Vec2{std::cos(a), std::sin(a)}, sun);
    }
  }

  void view(const ShownView& shown) const {
    const ImageSize size = context.layout.picture;
    const Box place = placed(size, shown.pane, context.state.look), &part = shown.part;
    draw.PushClipRect(at(part.x, part.y), at(part.x + part.width, part.y + part.height), true);
    if (shown.picture != Picture::depth) {
      const ScreenCamera camera{posed_camera(context.state), place};
      if (shown.picture == Picture::texels || context.shown.live.map_camera) layout_of_maps(camera);
      if (const auto& probe = context.state.look.probe)
        cross(place, {(probe->x + 0.5) / size.width, (probe->y + 0.5) / size.height}, white, 0.9f * em);
      if (shows_scene(shown.picture)) handle(camera);
    }
    draw.PopClipRect();
  }

  /// The place under the pointer, in every pane but its own.
  void pointer() const {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const auto& panes = context.layout.panes;
    for (const Box& own : panes) {
      if (!own.holds(double(mouse.x), double(mouse.y)) || ImGui::GetIO().WantCaptureMouse) continue;
      const Box place = placed(context.layout.picture, own, context.state.look);
      const Vec2 share{(double(mouse.x) - place.x) / place.width, (double(mouse.y) - place.y) / place.height};
      for (std::size_t i = 0; i < panes.size(); ++i)
        if (&panes[i] != &own && context.state.look.quad[i] != Picture::depth)
          cross(placed(context.layout.picture, panes[i], context.state.look), share, sun, 0.6f * em);
    }
  }
};

/// What a pane of the four shows can be chosen by its name.
void pane_choice(PanelContext& context, std::size_t pane, const Box& box) {
  const float em = ImGui::GetFontSize();
  ImGui::SetNextWindowPos(at(box.x + 0.3 * double(em), box.y + 0.3 * double(em)));
  const std::string name = fmt::format("pane {}", pane + 1);
  bool asked = false;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0.0f, 0.0f));
  if (ImGui::Begin(name.c_str(), nullptr,
                   ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                       ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoBackground |
                       ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoFocusOnAppearing)) {
    const Picture now = context.state.look.quad[pane];
    const float free = static_cast<float>(box.width) - 0.6f * em;
    const bool narrow = free < 14.0f * em;  // the longest title has no room beside an arrow
    ImGui::SetNextItemWidth(narrow ? free : 14.0f * em);
    if (ImGui::BeginCombo("##view", std::string(picture_title(now)).c_str(),
                          narrow ? ImGuiComboFlags_NoArrowButton : ImGuiComboFlags_None)) {
      for (std::size_t i = 0; i < picture_count; ++i) {
        const auto picture = static_cast<Picture>(i);
        if (ImGui::Selectable(std::string(picture_title(picture)).c_str(), picture == now))
          context.ask(Change{SetPane{pane, picture}});
      }
      ImGui::EndCombo();
    } else {
      asked = ImGui::IsItemHovered() && !picture_legend(now).empty();
    }
  }
  ImGui::End();
  ImGui::PopStyleVar();
  if (!asked) return;
  ImGui::BeginTooltip();
  wrapped(picture_legend(context.state.look.quad[pane]), 26.0f * em);
  ImGui::EndTooltip();
}

}  // namespace

void overlay(PanelContext& context) {
  const Overlay over{context, *ImGui::GetBackgroundDrawList(), ImGui::GetFontSize()};
  const LabLayout& layout = context.layout;
  const ViewState& state = context.state;
  for (const ShownView& view : shown_views(layout, state.look, state.picture, state.previous))
    over.view(view);
  if (layout.panes.size() == 4) {
    for (std::size_t i = 0; i < 4; ++i) pane_choice(context, i, layout.panes[i]);
    return over.pointer();
  }
  const Box& pane = layout.panes.front();
  if (state.look.layout != PaneLayout::swipe) return over.name(pane, state.picture, pane.width);
  const double x = pane.x + state.look.swipe * pane.width, middle = pane.y + 0.5 * pane.height;
  over.line({x, double(pane.y)}, {x, double(pane.y + pane.height)}, white);
  over.draw.AddCircleFilled(at(x, middle), 0.6f * over.em, black);
  over.draw.AddCircleFilled(at(x, middle), 0.45f * over.em, white);
  over.name(pane, state.previous, 0.5 * pane.width);
  over.name(pane, state.picture, 0.5 * pane.width, true);
}

}  // namespace gnomon::lab
