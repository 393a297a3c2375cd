// The window of keys.
#include <imgui/imgui.h>

#include <span>
#include <string>

#include "lab/view/panels/panels.h"

namespace gnomon::lab {

namespace {

constexpr float keys_width = 13.0f, text_width = 36.0f;  // in heights of the font

void group_table(const KeyGroup& group) {
  ImGui::TextDisabled("%.*s", static_cast<int>(group.title.size()), group.title.data());
  if (!ImGui::BeginTable(std::string(group.title).c_str(), 2, ImGuiTableFlags_SizingFixedFit)) return;
  ImGui::TableSetupColumn("keys", ImGuiTableColumnFlags_WidthFixed, keys_width * ImGui::GetFontSize());
  for (const KeyHelp& key : group.keys) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(key.keys.data(), key.keys.data() + key.keys.size());
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(key.what.data(), key.what.data() + key.what.size());
  }
  ImGui::EndTable();
}

/// In two columns where there is room, so that nothing has to be scrolled.
void all_groups(float width) {
  const std::span<const KeyGroup> groups = key_groups();
  const bool two = width > 2.0f * text_width * ImGui::GetFontSize();
  constexpr std::size_t at_left = 2;  // half of all keys
  ImGui::BeginGroup();
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (two && i == at_left) {
      ImGui::EndGroup();
      ImGui::SameLine(0.0f, 2.0f * ImGui::GetFontSize());
      ImGui::BeginGroup();
    }
    group_table(groups[i]);
  }
  ImGui::EndGroup();
}

}  // namespace

void help_window(PanelContext& context) {
  if (!context.state.look.help) return;
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * screen.x, 0.5f * screen.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSizeConstraints({0.0f, 0.0f}, {0.95f * screen.x, 0.9f * screen.y});
  bool open = true;
  if (ImGui::Begin("Keys and mouse", &open,
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse))
    all_groups(screen.x);
  ImGui::End();
  if (!open) context.ask(Change{SetFlag{&Look::help, false}});
}

}  // namespace gnomon::lab
