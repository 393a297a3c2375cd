#include "raster/gl/context.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>
#include <utility>

#include "scene/base/threads.h"

namespace gnomon::raster {
namespace {

tl::unexpected<Error> no_context(const std::string& tried) {
  return fail(ErrorKind::graphics, "no OpenGL 4.5 context: " + tried);
}

/// What a backend means to EGL, and what to call it when it fails; none of those that begin with OSMesa.
std::optional<std::pair<const char*, EglDevices>> egl_alone(Backend backend) {
  if (backend == Backend::egl) return std::pair{"egl", EglDevices::hardware_first};
  if (backend == Backend::egl_software) return std::pair{"egl-software", EglDevices::software};
  if (backend == Backend::egl_hardware) return std::pair{"egl-hardware", EglDevices::hardware};
  return std::nullopt;
}

}  // namespace

bool draws_in_software(std::string_view renderer) {
  constexpr std::array<std::string_view, 4> software{"llvmpipe", "softpipe", "swrast", "SwiftShader"};
  return std::any_of(software.begin(), software.end(),
                     [&](std::string_view word) { return renderer.find(word) != std::string_view::npos; });
}

namespace {

Expected<std::unique_ptr<Context>> first_context(Backend backend) {
  if (const auto egl = egl_alone(backend)) {
    auto context = create_egl_context(egl->second);
    return context ? std::move(context)
                   : no_context(fmt::format("{}: {}", egl->first, context.error().reason));
  }
  auto osmesa = create_osmesa_context();
  if (osmesa) return osmesa;
  std::string tried = fmt::format("osmesa: {}", osmesa.error().reason);
  if (backend == Backend::osmesa) return no_context(tried);
  for (const auto& [name, devices] :
       {std::pair{"egl in software", EglDevices::software}, {"egl on hardware", EglDevices::hardware}}) {
    auto context = create_egl_context(devices);
    if (context) (*context)->set_why_not_osmesa(osmesa.error().reason);
    if (context) return context;
    tried += fmt::format("; {}: {}", name, context.error().reason);
  }
  return no_context(tried);
}

/// Mesa's rasterizer draws on the calling thread.
bool draws_without_threads() {
  const char* threads = std::getenv("LP_NUM_THREADS");
  return threads != nullptr && std::string_view(threads) == "0";
}

}  // namespace

Expected<std::unique_ptr<Context>> create_context(Backend backend) {
  const int refused_before = refused_threads();
  auto context = first_context(backend);
  // llvmpipe would wait for ever for one of its threads that is missing.
  if (context && refused_threads() > refused_before && !draws_without_threads())
    return fail(ErrorKind::graphics,
                fmt::format("the graphics driver was refused a thread ({}); --threads 1 needs none of them",
                            thread_limit_words));
  return context;
}

}  // namespace gnomon::raster
