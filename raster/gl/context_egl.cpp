// EGL without a window: a hardware device first, then Mesa's surfaceless platform, then any device. The few
// declarations are those of EGL/egl.h and EGL/eglext.h, so that building needs no EGL headers.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "raster/gl/context.h"
#include "raster/gl/dynamic_library.h"

namespace gnomon::raster {
namespace {

using Handle = void*;
using EglInt = std::int32_t;

constexpr EglInt egl_none = 0x3038;
constexpr EglInt egl_extensions = 0x3055;
constexpr EglInt egl_surface_type = 0x3033;
constexpr EglInt egl_renderable_type = 0x3040;
constexpr EglInt egl_opengl_bit = 0x0008;
constexpr EglInt egl_context_major_version = 0x3098;
constexpr EglInt egl_context_minor_version = 0x30FB;
constexpr EglInt egl_context_profile_mask = 0x30FD;
constexpr EglInt egl_context_core_profile_bit = 0x0001;
constexpr unsigned egl_opengl_api = 0x30A2;
constexpr unsigned egl_platform_device = 0x313F;
constexpr unsigned egl_platform_surfaceless_mesa = 0x31DD;

struct EglFunctions {
  Context::Procedure (*get_procedure)(const char*) = nullptr;
  EglInt (*get_error)() = nullptr;
  unsigned (*initialize)(Handle, EglInt*, EglInt*) = nullptr;
  unsigned (*terminate)(Handle) = nullptr;
  unsigned (*bind_api)(unsigned) = nullptr;
  unsigned (*choose_config)(Handle, const EglInt*, Handle*, EglInt, EglInt*) = nullptr;
  Handle (*create_context)(Handle, Handle, Handle, const EglInt*) = nullptr;
  unsigned (*destroy_context)(Handle, Handle) = nullptr;
  unsigned (*make_current)(Handle, Handle, Handle, Handle) = nullptr;
  // Extensions; null where EGL lacks them
  Handle (*get_platform_display)(unsigned, Handle, const EglInt*) = nullptr;
  unsigned (*query_devices)(EglInt, Handle*, EglInt*) = nullptr;
  const char* (*query_device_string)(Handle, EglInt) = nullptr;

  bool load(const DynamicLibrary& library) {
    const bool found =
        library.find("eglGetProcAddress", get_procedure) && library.find("eglGetError", get_error) &&
        library.find("eglInitialize", initialize) && library.find("eglTerminate", terminate) &&
        library.find("eglBindAPI", bind_api) && library.find("eglChooseConfig", choose_config) &&
        library.find("eglCreateContext", create_context) &&
        library.find("eglDestroyContext", destroy_context) && library.find("eglMakeCurrent", make_current);
    if (!found) return false;
    extension("eglGetPlatformDisplayEXT", get_platform_display);
    extension("eglQueryDevicesEXT", query_devices);
    extension("eglQueryDeviceStringEXT", query_device_string);
    return true;
  }

 private:
  template <class Function>
  void extension(const char* name, Function*& function) const {
    function = reinterpret_cast<Function*>(get_procedure(name));
  }
};

/// One way to get a display, and what to call it when it fails.
struct Candidate {
  std::string name;
  unsigned platform;
  Handle native;
};

class EglContext final : public Context {
 public:
  EglContext(DynamicLibrary library, const EglFunctions& functions, Handle display, Handle context,
             bool hardware)
      : library_(std::move(library)),
        functions_(functions),
        display_(display),
        context_(context),
        hardware_(hardware) {}
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;
  ~EglContext() override {
    functions_.make_current(display_, nullptr, nullptr, nullptr);
    functions_.destroy_context(display_, context_);
    // The display stays initialised: EGL shares it between all contexts of the process that use the same
    // device.
  }

  bool make_current() override {
    return functions_.bind_api(egl_opengl_api) != 0 &&
           functions_.make_current(display_, nullptr, nullptr, context_) != 0;
  }
  Procedure procedure(const char* name) const override { return functions_.get_procedure(name); }
  const char* backend() const override { return hardware_ ? "egl-hardware" : "egl-software"; }

 private:
  DynamicLibrary library_;
  EglFunctions functions_;
  Handle display_;
  Handle context_;
  bool hardware_;
};

std::vector<Handle> devices(const EglFunctions& egl) {
  EglInt count = 0;
  if (egl.query_devices == nullptr || !egl.query_devices(0, nullptr, &count)) return {};
  std::vector<Handle> found(static_cast<std::size_t>(std::max(count, 0)));
  if (!egl.query_devices(count, found.data(), &count)) return {};
  found.resize(static_cast<std::size_t>(std::max(count, 0)));
  return found;
}

bool is_software(const EglFunctions& egl, Handle device) {
  const char* text =
      egl.query_device_string == nullptr ? nullptr : egl.query_device_string(device, egl_extensions);
  return text != nullptr && std::string_view(text).find("EGL_MESA_device_software") != std::string_view::npos;
}

/// By the name of what draws, which holds for Mesa's surfaceless platform too. The context is current.
bool is_in_software(const EglFunctions& egl) {
  constexpr unsigned gl_renderer = 0x1F01;
  const auto get_string =
      reinterpret_cast<const unsigned char* (*)(unsigned)>(egl.get_procedure("glGetString"));
  const unsigned char* text = get_string == nullptr ? nullptr : get_string(gl_renderer);
  return draws_in_software(text == nullptr ? "" : reinterpret_cast<const char*>(text));
}

std::vector<Candidate> candidates(const EglFunctions& egl) {
  std::vector<Candidate> hardware, software;
  const std::vector<Handle> all = devices(egl);
  for (std::size_t i = 0; i < all.size(); ++i) {
    auto& list = is_software(egl, all[i]) ? software : hardware;
    list.push_back({fmt::format("device {}", i), egl_platform_device, all[i]});
  }
  hardware.push_back({"surfaceless", egl_platform_surfaceless_mesa, nullptr});
  hardware.insert(hardware.end(), software.begin(), software.end());
  return hardware;
}

// The context of one candidate, or why not.
Expected<Handle> open_context(const EglFunctions& egl, Handle display) {
  const auto why = [&](const char* call) {
    return fail(ErrorKind::graphics,
                fmt::format("{} failed (0x{:x})", call, static_cast<unsigned>(egl.get_error())));
  };
  if (!egl.bind_api(egl_opengl_api)) return why("eglBindAPI");
  constexpr std::array wanted{egl_surface_type, EglInt{0}, egl_renderable_type, egl_opengl_bit, egl_none};
  Handle config = nullptr;
  EglInt count = 0;
  if (!egl.choose_config(display, wanted.data(), &config, 1, &count) || count < 1)
    return why("eglChooseConfig");
  constexpr std::array attributes{
      egl_context_major_version,    EglInt{4}, egl_context_minor_version, EglInt{5}, egl_context_profile_mask,
      egl_context_core_profile_bit, egl_none};
  const Handle context = egl.create_context(display, config, nullptr, attributes.data());
  if (context == nullptr) return why("eglCreateContext (OpenGL 4.5 core)");
  if (egl.make_current(display, nullptr, nullptr, context)) return context;
  auto error = why("eglMakeCurrent without a surface");
  egl.destroy_context(display, context);
  return error;
}

Expected<Handle> open_display(const EglFunctions& egl, const Candidate& candidate) {
  const Handle display = egl.get_platform_display(candidate.platform, candidate.native, nullptr);
  if (display == nullptr) return fail(ErrorKind::graphics, "no display");
  if (!egl.initialize(display, nullptr, nullptr)) return fail(ErrorKind::graphics, "eglInitialize failed");
  return display;
}

}  // namespace

Expected<std::unique_ptr<Context>> create_egl_context(EglDevices devices) {
  constexpr std::array names{"libEGL.so.1", "libEGL.so"};
  auto library = DynamicLibrary::open(names);
  if (!library) return fail(library.error());
  EglFunctions egl;
  if (!egl.load(*library)) return fail(ErrorKind::graphics, "libEGL lacks functions of EGL 1.4");
  if (egl.get_platform_display == nullptr)
    return fail(ErrorKind::graphics, "libEGL has no eglGetPlatformDisplayEXT");
  std::string tried;
  const auto note = [&](const Candidate& candidate, const std::string& why) {
    tried += fmt::format("{}{}: {}", tried.empty() ? "" : ", ", candidate.name, why);
  };
  for (const Candidate& candidate : candidates(egl)) {
    const auto display = open_display(egl, candidate);
    const auto context = display ? open_context(egl, *display) : display;
    if (!context) {
      note(candidate, context.error().reason);
      continue;
    }
    const bool hardware = !is_in_software(egl);
    const bool fits = devices == EglDevices::hardware_first || hardware == (devices == EglDevices::hardware);
    if (fits) return std::make_unique<EglContext>(std::move(*library), egl, *display, *context, hardware);
    egl.make_current(*display, nullptr, nullptr, nullptr);
    egl.destroy_context(*display, *context);
    note(candidate, hardware ? "it is hardware" : "it is software");
  }
  return fail(ErrorKind::graphics, tried);
}

}  // namespace gnomon::raster
