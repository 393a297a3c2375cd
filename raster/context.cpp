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
  std::string tried;
  if (backend != Backend::egl) {
    auto context = create_osmesa_context();
    if (context) return context;
    tried = fmt::format("osmesa: {}", context.error().reason);
    if (backend == Backend::osmesa) return no_context(tried);
    tried += "; ";
  }
  auto context = create_egl_context();
  if (context) return context;
  return no_context(fmt::format("{}egl: {}", tried, context.error().reason));
}

}  // namespace gnomon::raster
