#include "lab/view/window/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>

#include "app/process/interrupt.h"

namespace gnomon::lab {

namespace {

/// GLFW's own words on its last error.
std::string library_reason() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text == nullptr ? "no reason given" : text;
}

tl::unexpected<Error> cannot_open(const std::string& reason) {
  return fail(ErrorKind::graphics, "cannot open a window: " + reason);
}

class WindowContext final : public raster::Context {
 public:
  explicit WindowContext(GLFWwindow* window) : window_(window) {}
  bool make_current() override {
    glfwMakeContextCurrent(window_);
    return glfwGetCurrentContext() == window_;
  }
  Procedure procedure(const char* name) const override { return glfwGetProcAddress(name); }
  const char* backend() const override { return "window"; }

 private:
  GLFWwindow* window_;
};

/// Where there is no Wayland, GLFW 3.4 would look for it all the same, and libwayland prints a line of its own.
void choose_platform() {
#ifdef GLFW_PLATFORM
  const auto names_one = [](const char* variable) {
    const char* value = std::getenv(variable);
    return value != nullptr && *value != '\0';
  };
  if (!names_one("WAYLAND_DISPLAY") && !names_one("WAYLAND_SOCKET"))
    glfwInitHint(GLFW_PLATFORM, GLFW_PLATFORM_X11);
#endif
}

void ask_for_core_context() {
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHint(GLFW_SAMPLES, 0);  // the pictures come finished
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
}

Modifiers held_of(int mods) {
  return {(mods & GLFW_MOD_SHIFT) != 0, (mods & GLFW_MOD_CONTROL) != 0};
}

Window& window_of(GLFWwindow* window) {
  return *static_cast<Window*>(glfwGetWindowUserPointer(window));
}

/// Xlib ends the process with exit code 1 where its connection is lost, after a handler that may end it otherwise. GLFW loads
/// the library; on Wayland there is none.
void end_in_words_without_display() {
  using Handler = int (*)(void* display);
  void* xlib = dlopen("libX11.so.6", RTLD_NOW | RTLD_NOLOAD);
  if (xlib == nullptr) return;
  if (const auto set = reinterpret_cast<Handler (*)(Handler)>(dlsym(xlib, "XSetIOErrorHandler")))
    set([](void*) -> int {
      const app::OutputGuard whole_outputs;
      app::end_process(static_cast<int>(ErrorKind::graphics), "the display is gone, and the window with it");
    });
}

}  // namespace

Window::Library::~Library() {
  glfwTerminate();
}

Expected<std::unique_ptr<Window>> Window::open(const std::string& title, ImageSize size) {
  choose_platform();
  if (glfwInit() != GLFW_TRUE) return cannot_open(library_reason());
  end_in_words_without_display();
  std::unique_ptr<Window> window(new Window(std::make_unique<Library>()));
  ask_for_core_context();
  window->window_ = glfwCreateWindow(size.width, size.height, title.c_str(), nullptr, nullptr);
  if (window->window_ == nullptr) return cannot_open("OpenGL 4.5 core: " + library_reason());
  glfwMakeContextCurrent(window->window_);
  glfwSwapInterval(1);
  window->connect();
  return window;
}

Window::~Window() {
  if (hidden_ != nullptr) glfwDestroyWindow(hidden_);
  if (window_ != nullptr) glfwDestroyWindow(window_);
}

void Window::connect() {
  glfwSetWindowUserPointer(window_, this);
  glfwGetFramebufferSize(window_, &size_.width, &size_.height);
  glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* w, int width, int height) {
    window_of(w).size_ = {width, height};
  });
  glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int mods) {
    const auto& told = window_of(w).events_.key;
    if (told && action != GLFW_RELEASE) told({key, held_of(mods)});
  });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int mods) {
    const auto& told = window_of(w).events_.button;
    if (told) told(button, action == GLFW_PRESS, held_of(mods));
  });
  glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) {
    const auto& told = window_of(w).events_.pointer;
    if (told) told(x, y);
  });
  glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double y) {
    const auto& told = window_of(w).events_.scroll;
    const auto down = [w](int key) { return glfwGetKey(w, key) == GLFW_PRESS; };
    if (told)
      told(y, {down(GLFW_KEY_LEFT_SHIFT) || down(GLFW_KEY_RIGHT_SHIFT),
               down(GLFW_KEY_LEFT_CONTROL) || down(GLFW_KEY_RIGHT_CONTROL)});
  });
  glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** paths) {
    const auto& told = window_of(w).events_.drop;
    if (told && count > 0) told(paths[0]);
  });
}

std::unique_ptr<raster::Context> Window::context() const {
  return std::make_unique<WindowContext>(window_);
}

Expected<void> Window::add_hidden_context() {
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  hidden_ = glfwCreateWindow(1, 1, "gnomon", nullptr, nullptr);
  if (hidden_ == nullptr) return cannot_open("a second OpenGL 4.5 core context: " + library_reason());
  return {};
}

std::unique_ptr<raster::Context> Window::hidden_context() const {
  return std::make_unique<WindowContext>(hidden_);
}

double Window::content_scale() const {
  float x = 1.0f, y = 1.0f;
  glfwGetWindowContentScale(window_, &x, &y);
  return std::max(1.0, static_cast<double>(std::max(x, y)));
}

void Window::set_title(const std::string& title) {
  glfwSetWindowTitle(window_, title.c_str());
}

void Window::copy(const std::string& text) {
  glfwSetClipboardString(window_, text.c_str());
}

std::string Window::clipboard() const {
  const char* text = glfwGetClipboardString(window_);
  return text == nullptr ? "" : text;
}

void Window::drop(const std::string& path) const {
  if (events_.drop) events_.drop(path);
}

void Window::ask_for_size(ImageSize size) {
  glfwSetWindowSize(window_, size.width, size.height);
}

bool Window::should_close() const {
  return glfwWindowShouldClose(window_) == GLFW_TRUE;
}

void Window::show_frame() {
  glfwSwapBuffers(window_);
}

void Window::poll() {
  glfwPollEvents();
}

void Window::wait(double at_most_seconds) {
  glfwWaitEventsTimeout(at_most_seconds);
}

void Window::wake() {
  glfwPostEmptyEvent();
}

}  // namespace gnomon::lab
