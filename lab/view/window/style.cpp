#include "lab/view/window/style.h"

#include <imgui/imgui.h>

#include <array>

#include "scene/files/path_status.h"
#include "scene/files/read_file.h"

namespace gnomon::lab {

namespace {

constexpr std::array fonts{"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                           "/usr/share/fonts/TTF/DejaVuSans.ttf",
                           "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf"};
// Latin with accents, Greek, dashes and quotes, superscripts, arrows, a few mathematical signs, check marks: no more
// than is shown, for a font is made again at every scale.
constexpr std::array<ImWchar, 17> glyphs{0x0020, 0x017f, 0x0391, 0x03c9, 0x2010, 0x2027,
                                         0x2070, 0x2079, 0x2190, 0x2193, 0x2212, 0x2212,
                                         0x2248, 0x2265, 0x2713, 0x2717, 0};

void darker_panels() {
  ImGui::StyleColorsDark();
  ImVec4* colours = ImGui::GetStyle().Colors;
  colours[ImGuiCol_WindowBg] = {0.11f, 0.12f, 0.14f, 1.0f};
  colours[ImGuiCol_PopupBg] = {0.14f, 0.15f, 0.18f, 1.0f};
  colours[ImGuiCol_MenuBarBg] = {0.15f, 0.16f, 0.19f, 1.0f};
  colours[ImGuiCol_FrameBg] = {0.20f, 0.22f, 0.26f, 1.0f};
  colours[ImGuiCol_FrameBgHovered] = {0.26f, 0.29f, 0.34f, 1.0f};
  colours[ImGuiCol_FrameBgActive] = {0.30f, 0.34f, 0.40f, 1.0f};
  colours[ImGuiCol_SliderGrab] = {0.16f, 0.45f, 0.66f, 1.0f};  // white numbers are read on it
  colours[ImGuiCol_SliderGrabActive] = {0.20f, 0.55f, 0.80f, 1.0f};
  colours[ImGuiCol_CheckMark] = {0.34f, 0.71f, 0.91f, 1.0f};
  colours[ImGuiCol_Button] = {0.18f, 0.30f, 0.47f, 1.0f};  // some stand on a picture
  colours[ImGuiCol_TextDisabled] = {0.66f, 0.68f, 0.72f, 1.0f};
}

void lighter_panels() {
  ImGui::StyleColorsLight();
  ImVec4* colours = ImGui::GetStyle().Colors;
  colours[ImGuiCol_WindowBg] = {0.97f, 0.97f, 0.96f, 1.0f};
  colours[ImGuiCol_PopupBg] = {1.0f, 1.0f, 1.0f, 1.0f};
  colours[ImGuiCol_FrameBg] = {0.87f, 0.88f, 0.90f, 1.0f};
  colours[ImGuiCol_SliderGrab] = {0.42f, 0.68f, 0.88f, 1.0f};  // black numbers are read on it
  colours[ImGuiCol_SliderGrabActive] = {0.30f, 0.60f, 0.84f, 1.0f};
  colours[ImGuiCol_CheckMark] = {0.0f, 0.40f, 0.66f, 1.0f};
  colours[ImGuiCol_Button] = {0.68f, 0.82f, 0.97f, 1.0f};  // some stand on a picture
  colours[ImGuiCol_TextDisabled] = {0.36f, 0.37f, 0.40f, 1.0f};
}

}  // namespace

void apply_style(Theme theme, const TypeSize& type) {
  ImGuiStyle fresh;
  ImGui::GetStyle() = fresh;
  theme == Theme::dark ? darker_panels() : lighter_panels();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowPadding = {10.0f, 8.0f};
  style.FramePadding = {6.0f, 3.0f};
  style.ItemSpacing = {8.0f, 5.0f};
  style.FrameRounding = 3.0f;
  style.GrabMinSize = 12.0f;
  style.ScrollbarSize = 12.0f;
  style.ScaleAllSizes(static_cast<float>(type.scale));
  style.WindowRounding = 0.0f;
  style.WindowBorderSize = 0.0f;
  style.FramePadding.y = static_cast<float>(type.padding);
}

Expected<std::string> read_font() {
  for (const char* file : fonts)
    if (file_kind_or_none(file) == FileKind::file) return read_file(file);
  return std::string();
}

void load_font(const TypeSize& type, std::string& bytes) {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  atlas.Clear();
  ImFontConfig given;
  given.FontDataOwnedByAtlas = false;
  if (!bytes.empty() &&
      atlas.AddFontFromMemoryTTF(bytes.data(), static_cast<int>(bytes.size()), static_cast<float>(type.font),
                                 &given, glyphs.data()) != nullptr)
    return;
  ImFontConfig own;
  own.SizePixels = static_cast<float>(type.font);
  atlas.AddFontDefault(&own);
}

Ink ink_of(Theme theme) {
  if (theme == Theme::dark)
    return {0xffe8e6e4, 0xffb0aca8, 0xff4a4642, 0xff1c1816, 0xffe9b456, 0xff4a9cff, 0xff8fce60};
  return {0xff201c1a, 0xff605a55, 0xffcfcbc8, 0xffffffff, 0xffa86600, 0xff004fc0, 0xff3c7a10};
}

std::string broken_at_blanks(std::string_view text, double width,
                             const std::function<double(std::string_view)>& measure) {
  const double blank = measure(" ");
  std::string out;
  double line = 0.0;
  bool begins = true;
  while (!text.empty()) {
    const std::size_t end = text.find_first_of(" \n");
    const std::string_view word = text.substr(0, end);
    const double wide = measure(word);
    if (!begins) {
      const bool fits = line + blank + wide <= width;
      out += fits ? ' ' : '\n';
      line = fits ? line + blank : 0.0;
    }
    out += word;
    line += wide;
    begins = false;
    if (end == std::string_view::npos) break;
    if (text[end] == '\n') out += '\n', line = 0.0, begins = true;
    text.remove_prefix(end + 1);
  }
  return out;
}

}  // namespace gnomon::lab
