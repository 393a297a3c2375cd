#include "platform/web/webgl/calls.h"

#include <GLES3/gl3.h>
#include <emscripten/em_js.h>

#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <string>

#include "platform/web/webgl/glsl.h"
#include "platform/web/webgl/read_back.h"
#include "platform/web/webgl/state.h"

EM_JS(char*, gnomon_renderer, (), {
  const info = GLctx.getExtension("WEBGL_debug_renderer_info");
  return stringToNewUTF8(GLctx.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : GLctx.RENDERER));
});

// What EXT_disjoint_timer_query_webgl2 counts in, bits; 0 where it is not there.
EM_JS(int, gnomon_timer_bits, (), {
  const timer = GLctx.getExtension("EXT_disjoint_timer_query_webgl2");
  return timer ? GLctx.getQuery(timer.TIME_ELAPSED_EXT, timer.QUERY_COUNTER_BITS_EXT) : 0;
});

namespace gnomon::web {
namespace {

// OpenGL's, which WebGL's header has not.
constexpr GLenum most_buffer_texels = 0x8C2B, gpu_disjoint = 0x8FBB;

void get_integer(GLenum name, GLint* value) {
  if (name == GL_NUM_EXTENSIONS) return void(*value = 1);  // the loader wants one (get_string_at())
  if (name != most_buffer_texels) return glGetIntegerv(name, value);
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, value);
  *value *= fetch_width;
}
void get_integer_64(GLenum, GLint64* value) {
  *value = 0;
}
const GLubyte* get_string(GLenum name) {
  static std::map<GLenum, std::string> texts;
  std::string& text = texts[name];
  if (name == GL_RENDERER) {
    char* const renderer = gnomon_renderer();
    text = renderer;
    std::free(renderer);
  } else {
    text = reinterpret_cast<const char*>(glGetString(name));
    if (name == GL_VERSION) text = "4.5 over WebGL 2: " + text;  // that whose functions are called
  }
  return reinterpret_cast<const GLubyte*>(text.c_str());
}
const GLubyte* get_string_at(GLenum, GLuint) {
  return reinterpret_cast<const GLubyte*>("");
}
void get_query(GLenum, GLenum, GLint* bits) {
  *bits = gnomon_timer_bits();
}
/// Of timer queries. All ones: something came between, and the result is worth nothing (raster/gl/span_clock).
void get_query_object(GLuint query, GLenum name, GLuint* value) {
  glGetQueryObjectuiv(query, name, value);
  if (name != GL_QUERY_RESULT) return;
  GLboolean disjoint = GL_FALSE;
  glGetBooleanv(gpu_disjoint, &disjoint);
  if (disjoint == GL_TRUE) *value = ~GLuint{0};
}
void ignore_vertex_array(GLuint) {}  // the shaders fetch
void vertex_array_two(GLuint, GLuint) {}
void vertex_array_three(GLuint, GLuint, GLuint) {}
void vertex_array_buffer(GLuint, GLuint, GLuint, GLintptr, GLsizei) {}
void vertex_array_format(GLuint, GLuint, GLint, GLenum, GLboolean, GLuint) {}
void debug_callback(const void*, const void*) {}

}  // namespace

namespace {
std::shared_ptr<State> current_state;
}  // namespace

State& state() {
  return *current_state;
}

std::shared_ptr<State> new_objects() {
  return std::make_shared<State>();
}

void use_objects(std::shared_ptr<State> of_context) {
  current_state = std::move(of_context);
}

Procedure found(std::span<const Named> all, const char* name) {
  for (const Named& known : all)
    if (std::strcmp(known.name, name) == 0) return known.function;
  return nullptr;
}

Procedure gl_procedure(const char* name) {
  static const Named all[] = {
      named("glGetTextureSubImage", read_texture),
      named("glCreateFramebuffers", glGenFramebuffers),
      named("glDeleteFramebuffers", glDeleteFramebuffers),
      named("glCreateVertexArrays", glGenVertexArrays),
      named("glDeleteVertexArrays", glDeleteVertexArrays),
      named("glBindVertexArray", ignore_vertex_array),
      named("glVertexArrayElementBuffer", vertex_array_two),
      named("glEnableVertexArrayAttrib", vertex_array_two),
      named("glVertexArrayAttribBinding", vertex_array_three),
      named("glVertexArrayVertexBuffer", vertex_array_buffer),
      named("glVertexArrayAttribFormat", vertex_array_format),
      named("glGetShaderiv", glGetShaderiv),
      named("glGetShaderInfoLog", glGetShaderInfoLog),
      named("glGetProgramiv", glGetProgramiv),
      named("glGetProgramInfoLog", glGetProgramInfoLog),
      named("glViewport", glViewport),
      named("glScissor", glScissor),
      named("glDepthMask", glDepthMask),
      named("glDepthFunc", glDepthFunc),
      named("glCullFace", glCullFace),
      named("glBlendEquation", glBlendEquation),
      named("glBlendFunc", glBlendFunc),
      named("glClearColor", glClearColor),
      named("glClear", glClear),
      named("glFinish", finish),
      named("glReadBuffer", glReadBuffer),
      named("glReadPixels", glReadPixels),
      named("glGetIntegerv", get_integer),
      named("glGetInteger64v", get_integer_64),
      named("glGetString", get_string),
      named("glGetStringi", get_string_at),
      named("glGetError", glGetError),
      named("glGetQueryiv", get_query),
      named("glGenQueries", glGenQueries),
      named("glDeleteQueries", glDeleteQueries),
      named("glBeginQuery", glBeginQuery),
      named("glEndQuery", glEndQuery),
      named("glGetQueryObjectuiv", get_query_object),
      named("glDebugMessageCallback", debug_callback),
  };
  for (const Procedure known :
       {fallback_procedure(name), object_procedure(name), program_procedure(name), found(all, name)})
    if (known != nullptr) return known;
  return nullptr;
}

}  // namespace gnomon::web
