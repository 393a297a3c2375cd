// The window of keys.
#include <imgui/imgui.h>

#include "app/view/panels/panels.h"

namespace gnomon::app {

void help_window(PanelContext& context) {
  if (!context.state.look.help) return;
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * screen.x, 0.5f * screen.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSizeConstraints({0.0f, 0.0f}, {0.95f * screen.x, 0.9f * screen.y});
  bool open = true;
  if (ImGui::Begin(
          "Keys and mouse", &open,
          ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse)) {
    for (const KeyGroup& group : key_groups()) {
      ImGui::TextDisabled("%.*s", static_cast<int>(group.title.size()), group.title.data());
      if (!ImGui::BeginTable(std::string(group.title).c_str(), 2, ImGuiTableFlags_SizingFixedFit)) continue;
      ImGui::TableSetupColumn("keys", ImGuiTableColumnFlags_WidthFixed, 13.0f * ImGui::GetFontSize());
      for (const KeyHelp& key : group.keys) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(key.keys.data(), key.keys.data() + key.keys.size());
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(key.what.data(), key.what.data() + key.what.size());
      }
      ImGui::EndTable();
    }
  }
  ImGui::End();
  if (!open) context.ask(Change{SetFlag{&Look::help, false}});
}

}  // namespace gnomon::app
