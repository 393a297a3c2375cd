// The menu bar: scenes and lessons, views and layouts, settings that show an artifact, files, help.
#include <imgui/imgui.h>

#include "lab/view/panels/panels.h"
#include "lab/view/state/presets.h"
#include "report/lessons.h"
#include "scene/load.h"

namespace gnomon::lab {

namespace {

void scene_menu(PanelContext& context) {
  if (context.opens_menu) ImGui::OpenPopup("Scene");
  if (!ImGui::BeginMenu("Scene")) return;
  const std::string& open = context.shown.scene->argument.name;
  if (ImGui::BeginMenu("Built-in scenes")) {
    for (const BuiltinScene& scene : builtin_scenes()) {
      const std::string name(scene.name);
      if (ImGui::MenuItem(name.c_str(), nullptr, name == open)) context.ask(OpenScene{name});
      if (ImGui::IsItemHovered())
        ImGui::SetTooltip("%.*s", int(scene.description.size()), scene.description.data());
    }
    ImGui::EndMenu();
  }
  if (ImGui::BeginMenu("Lessons")) {
    for (const report::Lesson& lesson : report::all_lessons()) {
      const std::string name(lesson.name), title(lesson.title);
      if (ImGui::MenuItem(title.c_str(), nullptr, name == open)) context.ask(OpenScene{name});
      if (ImGui::IsItemHovered())
        ImGui::SetTooltip("%.*s", int(lesson.command.size()), lesson.command.data());
    }
    ImGui::EndMenu();
  }
  ImGui::Separator();
  if (ImGui::MenuItem("As at the start", "R")) context.ask(Change{Reset{}});
  ImGui::TextDisabled("Let a file fall on the window to open it.");
  ImGui::Separator();
  if (ImGui::MenuItem("Save as scene", "ctrl+S")) context.ask(Command::save_scene);
  if (ImGui::MenuItem("Save the picture", "ctrl+P")) context.ask(Command::save_picture);
  if (ImGui::MenuItem("Save a screenshot", "P")) context.ask(Command::save_screenshot);
  if (ImGui::MenuItem("Copy the command line", "C")) context.ask(Command::copy_command);
  if (ImGui::MenuItem("Write the report", "ctrl+R", false, !context.job.running))
    context.ask(Command::write_report);
  ImGui::Separator();
  if (ImGui::MenuItem("Quit", "Q")) context.ask(Command::quit);
  ImGui::EndMenu();
}

const char* key_of(Picture picture) {
  constexpr const char* keys[] = {"1", "2", "3", "4", "6", "G", "T", "5"};
  return keys[static_cast<std::size_t>(picture)];
}

void view_menu(PanelContext& context) {
  if (!ImGui::BeginMenu("View")) return;
  const Look& look = context.state.look;
  for (std::size_t i = 0; i < picture_count; ++i) {
    const auto picture = static_cast<Picture>(i);
    if (ImGui::MenuItem(std::string(picture_title(picture)).c_str(), key_of(picture),
                        picture == context.state.picture))
      context.ask(Change{Show{picture}});
  }
  ImGui::Separator();
  constexpr const char* layouts[] = {"One view", "Two with a line between", "Four"};
  for (int i = 0; i < 3; ++i) {
    const auto layout = static_cast<PaneLayout>(i);
    if (ImGui::MenuItem(layouts[i], i == 0 ? "V" : nullptr, look.layout == layout))
      context.ask(Change{SetLayout{layout}});
  }
  ImGui::Separator();
  if (ImGui::MenuItem("Freeze the map's camera", "F", context.state.setup.map_camera.has_value()))
    context.ask(Change{FreezeMaps{}});
  ImGui::Separator();
  if (ImGui::MenuItem("Enlarge", "Z")) context.ask(Change{ZoomPicture{2.0, {0.5, 0.5}}});
  if (ImGui::MenuItem("Whole picture", nullptr, false, look.zoom > 1.0))
    context.ask(Change{ZoomPictureTo{1.0}});
  ImGui::EndMenu();
}

void show_menu(PanelContext& context) {
  if (!ImGui::BeginMenu("Show")) return;
  constexpr const char* keys[] = {"F6", "F7", "F8", "F9"};
  for (std::size_t i = 0; i < presets().size(); ++i) {
    const Preset& preset = presets()[i];
    if (ImGui::MenuItem(std::string(preset.title).c_str(), keys[i])) context.ask(UsePreset{i});
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%.*s", int(preset.what.size()), preset.what.data());
  }
  ImGui::Separator();
  if (ImGui::MenuItem("Best for this scene", "ctrl+B", false, !context.job.running))
    context.ask(Command::find_best);
  ImGui::EndMenu();
}

void window_menu(PanelContext& context) {
  if (!ImGui::BeginMenu("Window")) return;
  const Look& look = context.state.look;
  const auto flag = [&](const char* title, const char* key, bool Look::*field) {
    if (ImGui::MenuItem(title, key, look.*field)) context.ask(Change{ToggleFlag{field}});
  };
  flag("Settings", "F2", &Look::settings);
  flag("Results", "F3", &Look::results);
  flag("All panels", "F11", &Look::panels);
  ImGui::Separator();
  flag("Large type", "F4", &Look::large_type);
  if (ImGui::MenuItem("Light colours", "F5", look.theme == Theme::light)) context.ask(Change{NextTheme{}});
  if (ImGui::BeginMenu("Scale")) {
    for (const int percent : {100, 125, 150, 200, 250, 300}) {
      const double scale = percent / 100.0;
      if (ImGui::MenuItem((std::to_string(percent) + " %").c_str(), nullptr, look.ui_scale == scale))
        context.ask(Change{SetUiScale{scale}});
    }
    ImGui::EndMenu();
  }
  ImGui::EndMenu();
}

}  // namespace

void menu_bar(PanelContext& context) {
  if (context.layout.menu.width == 0 || !ImGui::BeginMainMenuBar()) return;
  scene_menu(context);
  view_menu(context);
  show_menu(context);
  window_menu(context);
  if (ImGui::BeginMenu("Help")) {
    if (ImGui::MenuItem("Keys and mouse", "F1", context.state.look.help))
      context.ask(Change{ToggleFlag{&Look::help}});
    ImGui::EndMenu();
  }
  ImGui::EndMainMenuBar();
}

}  // namespace gnomon::lab
