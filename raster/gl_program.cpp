#include "raster/gl_program.h"

#include <embedded/shaders.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

namespace gnomon::raster {
namespace {

using Names = std::vector<std::string>;

// The value of a define "NAME value"; empty without one.
std::string_view value_of(std::string_view name, std::span<const std::string_view> defines) {
  for (const std::string_view define : defines)
    if (define.starts_with(name) && define.substr(name.size()).starts_with(' '))
      return define.substr(name.size() + 1);
  return {};
}

// The file named by an include line's text: `$NAME` before a dot stands for that define's value.
std::string included_name(std::string_view text, std::span<const std::string_view> defines) {
  const std::size_t dollar = text.find('$');
  if (dollar == text.npos) return std::string(text);
  const std::size_t dot = text.find('.', dollar);
  return fmt::format("{}{}{}", text.substr(0, dollar),
                     value_of(text.substr(dollar + 1, dot - dollar - 1), defines), text.substr(dot));
}

// Appends a source, its includes in place. `#line L S` keeps the compiler's line numbers right: S is the
// place in `files`.
void expand(std::string_view source, Names& files, std::span<const std::string_view> defines,
            std::string& out) {
  const std::size_t self = files.size() - 1;
  int line_number = 0;
  while (!source.empty()) {
    const std::size_t end = std::min(source.find('\n'), source.size());
    const std::string_view line = source.substr(0, end);
    source.remove_prefix(std::min(end + 1, source.size()));
    ++line_number;
    constexpr std::string_view include = "#include \"";
    if (!line.starts_with(include)) {
      out.append(line).push_back('\n');
      continue;
    }
    const std::string name =
        included_name(line.substr(include.size(), line.rfind('"') - include.size()), defines);
    if (std::find(files.begin(), files.end(), name) == files.end()) {
      files.push_back(name);
      out += fmt::format("#line 1 {}\n", files.size() - 1);
      expand(embedded::shaders(name), files, defines, out);
    }
    out += fmt::format("#line {} {}\n", line_number + 1, self);
  }
}

std::string expand_source(std::string_view source, std::string_view file, Names& files,
                          std::span<const std::string_view> defines) {
  std::string out = "#version 450 core\n";
  for (const std::string_view define : defines) out += fmt::format("#define {}\n", define);
  files.emplace_back(file);
  out += "#line 1 0\n";
  expand(source, files, defines, out);
  return out;
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

  Expected<void> compile(std::string_view source, std::string_view file,
                         std::span<const std::string_view> defines) const {
    Names files;
    const std::string text = expand_source(source, file, files, defines);
    const GLchar* chars = text.c_str();
    gl->ShaderSource(id, 1, &chars, nullptr);
    gl->CompileShader(id);
    GLint ok = GL_FALSE;
    gl->GetShaderiv(id, GL_COMPILE_STATUS, &ok);
    if (ok == GL_TRUE) return {};
    GLint length = 0;
    gl->GetShaderiv(id, GL_INFO_LOG_LENGTH, &length);
    const std::string log =
        log_text(length, [&](GLint n, char* out) { gl->GetShaderInfoLog(id, n, nullptr, out); });
    std::string legend;
    for (std::size_t i = 0; i < files.size(); ++i) legend += fmt::format(" {}={}", i, files[i]);
    return fail(ErrorKind::internal,
                fmt::format("shader {} does not compile (sources:{}): {}", file, legend, log));
  }
};

Expected<void> link_stages(const Gl& gl, GLuint program, std::string_view name) {
  gl->LinkProgram(program);
  GLint ok = GL_FALSE;
  gl->GetProgramiv(program, GL_LINK_STATUS, &ok);
  if (ok == GL_TRUE) return {};
  GLint length = 0;
  gl->GetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
  const std::string log =
      log_text(length, [&](GLint n, char* out) { gl->GetProgramInfoLog(program, n, nullptr, out); });
  return fail(ErrorKind::internal, fmt::format("shader {} does not link: {}", name, log));
}

}  // namespace

std::string expand_shader(std::string_view file, std::span<const std::string_view> defines) {
  Names files;
  return expand_source(embedded::shaders(file), file, files, defines);
}

Expected<Program> Program::link(const Gl& gl, std::string_view vertex, std::string_view fragment,
                                std::span<const std::string_view> defines) {
  Program program(gl, gl->CreateProgram());
  const Stage vertex_stage(gl, GL_VERTEX_SHADER);
  const Stage fragment_stage(gl, GL_FRAGMENT_SHADER);
  if (auto ok = vertex_stage.compile(embedded::shaders(vertex), vertex, defines); !ok)
    return fail(ok.error());
  gl->AttachShader(program.id(), vertex_stage.id);
  if (!fragment.empty()) {
    if (auto ok = fragment_stage.compile(embedded::shaders(fragment), fragment, defines); !ok)
      return fail(ok.error());
    gl->AttachShader(program.id(), fragment_stage.id);
  }
  if (auto ok = link_stages(gl, program.id(), fragment.empty() ? vertex : fragment); !ok)
    return fail(ok.error());
  return program;
}

Expected<Program> Program::link_compute(const Gl& gl, std::string_view source) {
  Program program(gl, gl->CreateProgram());
  const Stage stage(gl, GL_COMPUTE_SHADER);
  if (auto ok = stage.compile(source, "compute", {}); !ok) return fail(ok.error());
  gl->AttachShader(program.id(), stage.id);
  if (auto ok = link_stages(gl, program.id(), "compute"); !ok) return fail(ok.error());
  return program;
}

void Program::use() const {
  gl()->UseProgram(id());
}

}  // namespace gnomon::raster
