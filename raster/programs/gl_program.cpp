#include "raster/programs/gl_program.h"

#include <embedded/shaders.h>
#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "raster/programs/shader_text.h"
#include "scene/base/stages.h"

namespace gnomon::raster {
namespace {

/// The first complaint of a compiler's log, "S:L(C): error: words": Mesa's form; others begin alike.
struct Complaint {
  std::size_t file = 0;
  int line = 0;
  std::string words;
};

std::string first_line(std::string_view text) {
  return std::string(text.substr(0, text.find('\n')));
}

// A whole log as one line: "error: a; error: b".
std::string on_one_line(std::string_view log) {
  std::string out;
  while (!log.empty()) {
    const std::size_t end = std::min(log.find('\n'), log.size());
    std::string_view line = log.substr(0, end);
    log.remove_prefix(std::min(end + 1, log.size()));
    line = line.substr(0, line.find_last_not_of(" \t\r") + 1);
    if (!line.empty()) out += fmt::format("{}{}", out.empty() ? "" : "; ", line);
  }
  return out;
}

std::optional<Complaint> first_complaint(std::string_view log) {
  const std::string text = first_line(log);
  const std::size_t mark = text.find_first_of(":(");
  if (mark == text.npos) return std::nullopt;
  std::size_t place = 0;
  const auto [after, bad] = std::from_chars(text.data() + mark + 1, text.data() + text.size(), place);
  if (bad != std::errc{} || place < 1) return std::nullopt;
  const std::size_t words = text.find(": ");
  return Complaint{place / lines_per_file, static_cast<int>(place % lines_per_file),
                   words == text.npos ? text : text.substr(words + 2)};
}

// The name that a compiler or linker did not find, in Mesa's words and NVIDIA's.
std::string missing_name(std::string_view log) {
  constexpr std::string_view before[] = {
      "no function with name '", "unresolved reference to function `", "no matching function for call to `",
      "unable to find compatible overloaded function \"", "undefined variable \""};
  constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
  for (const std::string_view words : before) {
    if (const std::size_t at = log.find(words); at != log.npos) {
      const std::string_view name = log.substr(at + words.size());
      return std::string(name.substr(0, name.find_first_not_of(letters)));
    }
  }
  const std::size_t end = log.find("' undeclared");
  const std::size_t begin = end == log.npos ? log.npos : log.rfind('`', end);
  return begin == log.npos ? std::string() : std::string(log.substr(begin + 1, end - begin - 1));
}

// The line of the original that defines the name: "float technique_visibility(ShadowTest test, …)".
std::string definition(std::string_view original, const std::string& name) {
  for (std::size_t at = 0; (at = original.find(" " + name + "(", at)) != original.npos; ++at) {
    const std::size_t begin = original.rfind('\n', at) + 1;
    const std::size_t end = original.find(')', at);
    const bool is_call = original[begin] == ' ' || original[begin] == '#' || original[begin] == '/';
    if (!is_call && end != original.npos) return std::string(original.substr(begin, end + 1 - begin));
  }
  return {};
}

// A file of the folder that leaves out what the original defines and others call.
std::optional<Error> missing_function(const Expansion& expansion, const ShaderFolder& folder,
                                      std::string_view log) {
  const std::string name = missing_name(log);
  if (name.empty()) return std::nullopt;
  for (const std::string& file : expansion.replaced()) {
    const std::string line = definition(embedded::shaders(file), name);
    if (line.empty()) continue;
    Error error{
        ErrorKind::bad_input,
        fmt::format("the function {0} is missing: other shaders call it as the original defines it, {1}",
                    name, line)};
    error.file = folder.path_of(file);
    return error;
  }
  return std::nullopt;
}

// The user's mistake where the complaint is about a file of the shader folder, else the program's.
Error compile_error(const Expansion& expansion, const ShaderFolder& folder, std::string_view stage_file,
                    const std::string& log) {
  const auto complaint = first_complaint(log);
  if (complaint && complaint->file < expansion.files.size() && expansion.files[complaint->file].replaced) {
    Error error{ErrorKind::bad_input, fmt::format("the shader does not compile: {}", complaint->words)};
    error.file = folder.path_of(expansion.files[complaint->file].name);
    error.line = complaint->line;
    return error;
  }
  const bool own = expansion.replaced().empty();
  if (auto missing = missing_function(expansion, folder, log)) return *missing;
  std::string legend;
  for (std::size_t i = 0; i < expansion.files.size(); ++i)
    legend += fmt::format(" {}={}", i, expansion.files[i].name);
  return {own ? ErrorKind::internal : ErrorKind::bad_input,
          fmt::format("shader {} does not compile (sources:{}): {}", stage_file, legend,
                      own ? on_one_line(log) : first_line(log))};
}

template <class GetLog>
std::string log_text(GLint length, const GetLog& get_log) {
  std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
  get_log(length, log.data());
  log.resize(std::min(log.find('\0'), log.size()));
  return log;
}

/// A shader object for the time of linking.
struct Stage {
  const Gl& gl;
  GLuint id;
  Stage(const Gl& g, GLenum type) : gl(g), id(g->CreateShader(type)) {}
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;
  ~Stage() { gl->DeleteShader(id); }

  Expected<void> compile(const Expansion& expansion, std::string_view file) const {
    if (!expansion.complete) return expansion.complete;
    const GLchar* chars = expansion.text.c_str();
    gl->ShaderSource(id, 1, &chars, nullptr);
    gl->CompileShader(id);
    GLint ok = GL_FALSE;
    gl->GetShaderiv(id, GL_COMPILE_STATUS, &ok);
    if (ok == GL_TRUE) return {};
    GLint length = 0;
    gl->GetShaderiv(id, GL_INFO_LOG_LENGTH, &length);
    return fail(compile_error(expansion, gl.shader_folder(), file, log_text(length, [&](GLint n, char* out) {
                                gl->GetShaderInfoLog(id, n, nullptr, out);
                              })));
  }
};

Expected<void> link_stages(const Gl& gl, GLuint program, std::string_view name, const Expansion& last_stage) {
  gl->LinkProgram(program);
  GLint ok = GL_FALSE;
  gl->GetProgramiv(program, GL_LINK_STATUS, &ok);
  if (ok == GL_TRUE) return {};
  GLint length = 0;
  gl->GetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
  const std::string log =
      log_text(length, [&](GLint n, char* out) { gl->GetProgramInfoLog(program, n, nullptr, out); });
  if (auto missing = missing_function(last_stage, gl.shader_folder(), log)) return fail(*missing);
  return fail(last_stage.replaced().empty() ? ErrorKind::internal : ErrorKind::bad_input,
              fmt::format("shader {} does not link: {}", name, on_one_line(log)));
}

}  // namespace

std::string expand_shader(std::string_view file, std::span<const std::string_view> defines) {
  return expand_file(file, defines, {}).text;
}

Expected<Program> Program::link(const Gl& gl, std::string_view vertex, std::string_view fragment,
                                std::span<const std::string_view> defines) {
  const TimedStage timed("shader compile");
  Program program(gl, gl->CreateProgram());
  const Stage vertex_stage(gl, GL_VERTEX_SHADER);
  const Stage fragment_stage(gl, GL_FRAGMENT_SHADER);
  Expansion text = expand_file(vertex, defines, gl.shader_folder());
  if (auto ok = vertex_stage.compile(text, vertex); !ok) return fail(ok.error());
  gl->AttachShader(program.id(), vertex_stage.id);
  program.note_sources(text);
  if (!fragment.empty()) {
    text = expand_file(fragment, defines, gl.shader_folder());
    if (auto ok = fragment_stage.compile(text, fragment); !ok) return fail(ok.error());
    gl->AttachShader(program.id(), fragment_stage.id);
    program.note_sources(text);
  }
  if (auto ok = link_stages(gl, program.id(), fragment.empty() ? vertex : fragment, text); !ok)
    return fail(ok.error());
  return program;
}

Expected<Program> Program::link_compute(const Gl& gl, std::string_view source) {
  const TimedStage timed("shader compile");
  Program program(gl, gl->CreateProgram());
  const Stage stage(gl, GL_COMPUTE_SHADER);
  const Expansion text = expand_source(source, "compute", gl.shader_folder());
  if (auto ok = stage.compile(text, "compute"); !ok) return fail(ok.error());
  gl->AttachShader(program.id(), stage.id);
  if (auto ok = link_stages(gl, program.id(), "compute", text); !ok) return fail(ok.error());
  return program;
}

void Program::note_sources(const Expansion& text) {
  for (const Expansion::File& file : text.files) {
    sources_.push_back(file.name);
    if (file.replaced) replaced_.push_back(file.name);
  }
}

bool Program::reads(const std::set<std::string>& names) const {
  return std::any_of(sources_.begin(), sources_.end(),
                     [&](const std::string& name) { return names.contains(name); });
}

void Program::use() const {
  gl()->UseProgram(id());
  if (!replaced_.empty()) gl().shader_folder().note_use(replaced_);
}

}  // namespace gnomon::raster
