#include "lab/view/window/interface.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui/backends/imgui_impl_glfw.h>
#include <imgui/backends/imgui_impl_opengl3.h>
#include <imgui/imgui.h>

#include "lab/view/window/style.h"

namespace gnomon::lab {

namespace {

/// Between what the backend has heard of the mouse and the frame that is made of it.
void move_pointer(const ScriptPointer& pointer) {
  ImGuiIO& io = ImGui::GetIO();
  const auto x = static_cast<float>(pointer.x), y = static_cast<float>(pointer.y);
#if IMGUI_VERSION_NUM >= 18700
  io.AddMousePosEvent(x, y);
  for (std::size_t i = 0; i < pointer.down.size(); ++i)
    io.AddMouseButtonEvent(static_cast<int>(i), pointer.down[i]);
#else
  io.MousePos = {x, y};
  for (std::size_t i = 0; i < pointer.down.size(); ++i) io.MouseDown[i] = pointer.down[i];
#endif
}

#if IMGUI_VERSION_NUM >= 18700
ImGuiKey interface_key(int key) {
  switch (key) {
    case GLFW_KEY_LEFT:
      return ImGuiKey_LeftArrow;
    case GLFW_KEY_RIGHT:
      return ImGuiKey_RightArrow;
    case GLFW_KEY_UP:
      return ImGuiKey_UpArrow;
    case GLFW_KEY_DOWN:
      return ImGuiKey_DownArrow;
    case GLFW_KEY_TAB:
      return ImGuiKey_Tab;
    case GLFW_KEY_SPACE:
      return ImGuiKey_Space;
    case GLFW_KEY_ENTER:
      return ImGuiKey_Enter;
    case GLFW_KEY_ESCAPE:
      return ImGuiKey_Escape;
    case GLFW_KEY_PAGE_UP:
      return ImGuiKey_PageUp;
    case GLFW_KEY_PAGE_DOWN:
      return ImGuiKey_PageDown;
    default:
      return ImGuiKey_None;
  }
}
#endif

/// Does what the backend does when a key goes down or up.
void hold_key(const Key& key, bool down) {
  ImGuiIO& io = ImGui::GetIO();
#if IMGUI_VERSION_NUM >= 18700
  io.AddKeyEvent(ImGuiMod_Ctrl, down && key.held.control);
  io.AddKeyEvent(ImGuiMod_Shift, down && key.held.shift);
  if (const ImGuiKey code = interface_key(key.code); code != ImGuiKey_None) io.AddKeyEvent(code, down);
#else
  io.KeyCtrl = down && key.held.control;
  io.KeyShift = down && key.held.shift;
  io.KeysDown[key.code] = down;
#endif
}

bool moves_through_panels(int key) {
  switch (key) {
    case GLFW_KEY_LEFT:
    case GLFW_KEY_RIGHT:
    case GLFW_KEY_UP:
    case GLFW_KEY_DOWN:
    case GLFW_KEY_TAB:
    case GLFW_KEY_SPACE:
    case GLFW_KEY_ENTER:
    case GLFW_KEY_ESCAPE:
    case GLFW_KEY_PAGE_UP:
    case GLFW_KEY_PAGE_DOWN:
      return true;
    default:
      return false;
  }
}

}  // namespace

Expected<std::unique_ptr<Interface>> Interface::open(const Window& window) {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  std::unique_ptr<Interface> interface(new Interface);
  auto font = read_font();
  if (!font) return fail(font.error());
  interface->font_ = std::move(*font);
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // nothing is remembered from one run to the next
  io.LogFilename = nullptr;
  io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
  if (!ImGui_ImplGlfw_InitForOpenGL(window.handle(), true) || !ImGui_ImplOpenGL3_Init("#version 330 core"))
    return fail(ErrorKind::graphics, "Dear ImGui does not start on this OpenGL context");
  return interface;
}

Interface::~Interface() {
  if (ImGui::GetIO().BackendRendererUserData != nullptr) ImGui_ImplOpenGL3_Shutdown();
  if (ImGui::GetIO().BackendPlatformUserData != nullptr) ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

void Interface::use_type(const Look& look, const TypeSize& type) {
  if (font_scale_ != type.scale) {
    const bool again = font_scale_ != 0.0;
    if (again) ImGui_ImplOpenGL3_DestroyFontsTexture();
    load_font(type, font_);
    if (again) ImGui_ImplOpenGL3_CreateFontsTexture();
    font_scale_ = type.scale;
  }
  if (styled_ != std::pair{look.theme, type.scale}) {
    apply_style(look.theme, type);
    styled_ = std::pair{look.theme, type.scale};
  }
}

void Interface::begin_frame(const std::optional<ScriptPointer>& pointer, const std::optional<Key>& key) {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  if (pointer) move_pointer(*pointer);
  if (script_key_ && !key) hold_key(*script_key_, false);
  if (key) hold_key(*key, true);
  script_key_ = key;
  ImGui::NewFrame();
}

void Interface::end_frame() {
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

bool Interface::wants_pointer() const {
  return ImGui::GetIO().WantCaptureMouse;
}

bool Interface::wants_key(int key) const {
  const ImGuiIO& io = ImGui::GetIO();
  const bool menu = ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopup);
  return io.WantTextInput || ((io.NavVisible || menu) && moves_through_panels(key));
}

bool Interface::leave_panels() {
  if (!ImGui::GetIO().WantCaptureKeyboard) return false;
  ImGui::SetWindowFocus(nullptr);
  return true;
}

}  // namespace gnomon::lab
