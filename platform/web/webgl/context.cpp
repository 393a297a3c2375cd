// A WebGL 2 context as raster/gl/context.h knows one: its functions are those of OpenGL 4.5 that raster/ calls, done with what
// WebGL 2 has (calls.h).
#include "raster/gl/context.h"

#include <emscripten/em_js.h>

#include <string>

#include "platform/web/webgl/calls.h"

// Without a page's element, so that a worker draws as well as a page. 0: there is none; else a handle.
EM_JS_DEPS(gnomon_context, "$GL");
EM_JS(int, gnomon_make_context, (), {
  const canvas = typeof OffscreenCanvas != "undefined" ? new OffscreenCanvas(1, 1)
                 : typeof document != "undefined"      ? document.createElement("canvas")
                                                       : null;
  if (!canvas) return 0;
  const handle = GL.createContext(canvas, {
    majorVersion : 2,
    minorVersion : 0,
    antialias : false,
    depth : false,
    stencil : false,
    alpha : true,
    enableExtensionsByDefault : false
  });
  if (handle) GL.makeContextCurrent(handle);
  return handle || 0;
});
EM_JS(void, gnomon_end_context, (int handle), { GL.deleteContext(handle); });
EM_JS(int, gnomon_choose_context, (int handle), { return GL.makeContextCurrent(handle) ? 1 : 0; });

namespace gnomon::raster {
namespace {

class WebContext final : public Context {
 public:
  explicit WebContext(int handle) : handle_(handle) {}
  ~WebContext() override { gnomon_end_context(handle_); }
  bool make_current() override {
    web::use_objects(objects_);
    return gnomon_choose_context(handle_) != 0;
  }
  Procedure procedure(const char* name) const override { return web::gl_procedure(name); }
  const char* backend() const override { return "webgl2"; }

 private:
  int handle_;
  std::shared_ptr<web::State> objects_ = web::new_objects();
};

}  // namespace

bool draws_in_software(std::string_view renderer) {
  return renderer.find("SwiftShader") != std::string_view::npos ||
         renderer.find("llvmpipe") != std::string_view::npos;
}

Expected<std::unique_ptr<Context>> create_context(Backend) {
  const int handle = gnomon_make_context();
  if (handle == 0)
    return fail(ErrorKind::graphics,
                "no WebGL 2 here to draw with: raytrace, plan, scenes, and judge of a capture with its map "
                "need none");
  auto context = std::make_unique<WebContext>(handle);
  context->make_current();
  if (const std::string name = web::use_extensions(); !name.empty())
    return fail(ErrorKind::graphics,
                "this browser's WebGL 2 lacks " + name +
                    ", without which no shadow map can be drawn (raytrace and plan need none)");
  return context;
}

}  // namespace gnomon::raster
