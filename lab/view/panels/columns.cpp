// The two columns beside the pictures, or the one that holds both as tabs.
#include <imgui/imgui.h>

#include <utility>

#include "lab/view/panels/panels.h"

namespace gnomon::lab {

namespace {

constexpr ImGuiWindowFlags fixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                   ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                   ImGuiWindowFlags_NoBringToFrontOnFocus |
                                   ImGuiWindowFlags_NoFocusOnAppearing;

bool begin_at(const char* name, const Box& box) {
  ImGui::SetNextWindowPos({static_cast<float>(box.x), static_cast<float>(box.y)});
  ImGui::SetNextWindowSize({static_cast<float>(box.width), static_cast<float>(box.height)});
  return ImGui::Begin(name, nullptr, fixed);
}

/// Whether another pixel was chosen since the last frame: then it is to be seen.
bool another_pixel(const PanelContext& context) {
  const auto& probe = context.state.look.probe;
  const int now = probe ? 1 + probe->x + probe->y * context.layout.picture.width : 0;
  int& before = *ImGui::GetStateStorage()->GetIntRef(ImGui::GetID("pixel"));
  return std::exchange(before, now) != now && now != 0;
}

void tab(PanelContext& context, const char* name, bool first, void (*panel)(PanelContext&)) {
  const ImGuiTabItemFlags flags = first ? ImGuiTabItemFlags_SetSelected : ImGuiTabItemFlags_None;
  if (!ImGui::BeginTabItem(name, nullptr, flags)) return;
  ImGui::BeginChild(name);
  panel(context);
  ImGui::EndChild();
  ImGui::EndTabItem();
}

}  // namespace

void left_column(PanelContext& context) {
  if (context.layout.settings.width == 0) return;
  if (begin_at("Settings", context.layout.settings)) {
    const bool shows_pixel = another_pixel(context);
    if (!context.layout.tabs) {
      settings_panel(context);
    } else if (ImGui::BeginTabBar("column")) {
      tab(context, "Settings", false, settings_panel);
      tab(context, "Results", shows_pixel, results_panel);
      ImGui::EndTabBar();
    }
  }
  ImGui::End();
}

void right_column(PanelContext& context) {
  if (context.layout.results.width == 0) return;
  if (begin_at("Results", context.layout.results)) results_panel(context);
  ImGui::End();
}

}  // namespace gnomon::lab
