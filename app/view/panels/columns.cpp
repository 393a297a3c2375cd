// The two columns beside the pictures, or the one that holds both as tabs.
#include <imgui/imgui.h>

#include "app/view/panels/panels.h"

namespace gnomon::app {

namespace {

constexpr ImGuiWindowFlags fixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                   ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                   ImGuiWindowFlags_NoBringToFrontOnFocus;

bool begin_at(const char* name, const Box& box) {
  ImGui::SetNextWindowPos({static_cast<float>(box.x), static_cast<float>(box.y)});
  ImGui::SetNextWindowSize({static_cast<float>(box.width), static_cast<float>(box.height)});
  return ImGui::Begin(name, nullptr, fixed);
}

}  // namespace

void left_column(PanelContext& context) {
  if (context.layout.settings.width == 0) return;
  if (begin_at("Settings", context.layout.settings)) {
    if (!context.layout.tabs) {
      settings_panel(context);
    } else if (ImGui::BeginTabBar("column")) {
      if (ImGui::BeginTabItem("Settings")) {
        ImGui::BeginChild("settings");
        settings_panel(context);
        ImGui::EndChild();
        ImGui::EndTabItem();
      }
      if (ImGui::BeginTabItem("Results")) {
        ImGui::BeginChild("results");
        results_panel(context);
        ImGui::EndChild();
        ImGui::EndTabItem();
      }
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

}  // namespace gnomon::app
