// One line below: what was last done, or what is wrong with what was asked for.
#include <fmt/core.h>
#include <imgui/imgui.h>

#include "lab/view/panels/panels.h"
#include "lab/view/state/status.h"
#include "scene/base/expected.h"

namespace gnomon::lab {

namespace {

std::string progress(const PanelContext& context) {
  if (context.shown.opening) return "opening the scene";
  if (!context.shown.is_drawn(context.state)) return "drawing";
  if (context.shown.is_done(context.state)) return "finished";
  return context.is_current() ? "comparing in full (a quarter of the size is shown)" : "comparing";
}

/// Shows as much of the text as there is room for; all of it where the pointer rests.
void fitted_text(const std::string& text, float room) {
  const auto width = [&](std::size_t length) {
    return ImGui::CalcTextSize(text.data(), text.data() + length).x;
  };
  if (width(text.size()) <= room) return ImGui::TextUnformatted(text.c_str());
  std::size_t length = text.size();
  const float left = room - ImGui::CalcTextSize("…").x;
  while (length > 0 && (width(length) > left || (text[length] & 0xc0) == 0x80)) --length;
  ImGui::TextUnformatted((text.substr(0, length) + "…").c_str());
  if (!ImGui::IsItemHovered()) return;
  ImGui::BeginTooltip();
  wrapped(text, 0.6f * ImGui::GetIO().DisplaySize.x);
  ImGui::EndTooltip();
}

}  // namespace

void status_bar(PanelContext& context) {
  const Box& box = context.layout.status;
  if (box.width == 0) return;
  ImGui::SetNextWindowPos({static_cast<float>(box.x), static_cast<float>(box.y)});
  ImGui::SetNextWindowSize({static_cast<float>(box.width), static_cast<float>(box.height)});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(10.0f * static_cast<float>(context.type.scale),
                                                          static_cast<float>(context.type.padding)));
  constexpr ImGuiWindowFlags flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                     ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoBringToFrontOnFocus;
  if (ImGui::Begin("Status", nullptr, flags)) {
    const std::string right = context.job.running ? fmt::format("{}, {:.0f} s (Esc stops it)",
                                                                context.job.title, context.job.seconds)
                                                  : progress(context);
    const float width = ImGui::CalcTextSize(right.c_str()).x;
    const float end = ImGui::GetContentRegionAvail().x + ImGui::GetCursorPosX();
    const float room = ImGui::GetContentRegionAvail().x - width - ImGui::GetFontSize();
    if (context.shown.unreadable) {
      ImGui::PushStyleColor(ImGuiCol_Text, context.ink.warning);
      fitted_text(one_line(context.shown.unreadable->message()), room);
      ImGui::PopStyleColor();
    } else {
      fitted_text(context.note, room);
    }
    ImGui::SameLine(end - width);
    ImGui::TextDisabled("%s", right.c_str());
  }
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace gnomon::lab
