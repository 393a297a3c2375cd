// The window: GLFW behind RAII. It owns the OpenGL 4.5 core context that everything in it is drawn with.
// Use it from the main thread only, but for wake().
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "lab/view/state/input.h"
#include "raster/gl/context.h"
#include "scene/base/expected.h"
#include "scene/image.h"

struct GLFWwindow;

namespace gnomon::lab {

/// What the window tells; each is called from poll() or wait().
struct WindowEvents {
  std::function<void(const Key& key)> key;  ///< pressed or repeated
  std::function<void(int button, bool down, const Modifiers& held)> button;
  std::function<void(double x, double y)> pointer;
  std::function<void(double notches, const Modifiers& held)> scroll;
  std::function<void(const std::string& path)> drop;  ///< a file let fall on the window
};

class Window {
 public:
  /// Error (graphics): no display, or no OpenGL 4.5 on it; the reason says which.
  static Expected<std::unique_ptr<Window>> open(const std::string& title, ImageSize size);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// The window's context as the rasterizer wants it. The window must outlive it.
  std::unique_ptr<raster::Context> context() const;
  /// Makes room for a second one of the same driver, for another thread. Error (graphics).
  Expected<void> add_hidden_context();
  /// The second one. The window must outlive it, and the thread that uses it.
  std::unique_ptr<raster::Context> hidden_context() const;
  GLFWwindow* handle() const { return window_; }
  /// What the display enlarges everything by: 1, 1.5, 2 ...
  double content_scale() const;

  void listen(WindowEvents events) { events_ = std::move(events); }
  void set_title(const std::string& title);
  void copy(const std::string& text);  ///< to the clipboard
  std::string clipboard() const;       ///< its text
  /// Does what happens when a file is let fall on the window.
  void drop(const std::string& path) const;
  /// Asks for a size; the display may grant it later, or another.
  void ask_for_size(ImageSize size);
  /// Pixels of the framebuffer, as the last event told: to ask the display every time would mean to wait for it. 0x0
  /// where it is iconified and the display says so.
  ImageSize framebuffer_size() const { return size_; }
  bool should_close() const;
  void show_frame();  ///< swaps the buffers

  void poll();                        ///< handles what has happened
  void wait(double at_most_seconds);  ///< sleeps until something happens
  static void wake();                 ///< ends a wait(); from any thread

 private:
  /// GLFW lives from before the window to after it.
  struct Library {
    Library() = default;
    ~Library();
    Library(const Library&) = delete;
    Library& operator=(const Library&) = delete;
  };
  explicit Window(std::unique_ptr<Library> library) : library_(std::move(library)) {}
  void connect();

  std::unique_ptr<Library> library_;
  GLFWwindow* window_ = nullptr;
  GLFWwindow* hidden_ = nullptr;
  WindowEvents events_;
  ImageSize size_{};
};

}  // namespace gnomon::lab
