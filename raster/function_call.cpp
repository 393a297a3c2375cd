// One case is one pixel of a picture of floats; the cases' numbers stand in a buffer.
#include "raster/function_call.h"

#include <fmt/core.h>

#include <cstring>

#include "raster/programs/gl_program.h"
#include "raster/programs/shader_folder.h"

namespace gnomon::raster {
namespace {

constexpr int row_length = 128;  // pixels; call.frag counts alike

/// Draws the cases. The context is current.
Expected<std::vector<Answer>> draw_cases(const Gl& gl, const Program& program, const FunctionCall& call) {
  const std::size_t cases = call.inputs.size() / call.numbers;
  const ImageSize size{row_length, static_cast<int>((cases + row_length - 1) / row_length)};
  Buffer numbers(gl);
  numbers.write(call.inputs);
  BufferTexture inputs(gl);
  inputs.attach(numbers, GL_R32F);
  const Texture2D answers(gl, GL_RGBA32F, size);
  Framebuffer target(gl);
  target.attach(GL_COLOR_ATTACHMENT0, answers);
  target.draw_to(1);
  if (auto complete = target.check_complete(); !complete) return fail(complete.error());
  const VertexArray none(gl);
  gl->BindFramebuffer(GL_FRAMEBUFFER, target.id());
  const GLfloat nothing[] = {unwritten_answer, unwritten_answer, unwritten_answer, unwritten_answer};
  gl->ClearNamedFramebufferfv(target.id(), GL_COLOR, 0, nothing);
  gl->Viewport(0, 0, size.width, size.height);
  gl->BindVertexArray(none.id());
  inputs.bind(0);
  program.use();
  gl->DrawArrays(GL_TRIANGLES, 0, 3);
  std::vector<Answer> out(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
  answers.read(GL_RGBA, GL_FLOAT, std::as_writable_bytes(std::span(out)));
  out.resize(cases);
  return out;
}

}  // namespace

Expected<std::vector<Answer>> call_function(Backend backend, const std::string& shader_folder,
                                            const FunctionCall& call) {
  auto folder = ShaderFolder::read(shader_folder);
  if (!folder) return fail(folder.error());
  const auto context = create_context(backend);
  if (!context) return fail(context.error());
  const auto gl = Gl::load(**context);
  if (!gl) return fail(gl.error());
  (*gl)->shader_folder() = std::move(*folder);
  const std::string name = "FUNCTION " + call.name, text = "CALL_FUNCTION " + call.text,
                    numbers = fmt::format("NUMBERS {}", call.numbers),
                    own = fmt::format("CALLS_{} 1", call.name);
  const std::string_view defines[] = {name, text, numbers, own};
  const auto program = Program::link(**gl, "fullscreen.vert", "function/call.frag", defines);
  if (!program) return fail(program.error());
  auto answers = draw_cases(**gl, *program, call);
  if (auto fine = (*gl)->check("calling " + call.name); !fine) return fail(fine.error());
  return answers;
}

}  // namespace gnomon::raster
