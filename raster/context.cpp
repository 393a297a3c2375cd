#include "raster/context.h"

#include <fmt/format.h>

#include "raster/context_backends.h"

namespace gnomon::raster {
namespace {

tl::unexpected<Error> no_context(const std::string& tried) {
  return fail(ErrorKind::graphics, "no OpenGL 4.5 context: " + tried);
}

}  // namespace

Expected<std::unique_ptr<Context>> create_context(Backend backend) {
  if (backend == Backend::egl) {
    auto context = create_egl_context(EglDevices::hardware_first);
    return context ? std::move(context) : no_context(fmt::format("egl: {}", context.error().reason));
  }
  auto osmesa = create_osmesa_context();
  if (osmesa) return osmesa;
  std::string tried = fmt::format("osmesa: {}", osmesa.error().reason);
  if (backend == Backend::osmesa) return no_context(tried);
  for (const auto& [name, devices] :
       {std::pair{"egl in software", EglDevices::software}, {"egl on hardware", EglDevices::hardware}}) {
    auto context = create_egl_context(devices);
    if (context) return context;
    tried += fmt::format("; {}: {}", name, context.error().reason);
  }
  return no_context(tried);
}

}  // namespace gnomon::raster
