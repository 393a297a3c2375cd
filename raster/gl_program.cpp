#include "raster/gl_program.h"

#include <embedded/shaders.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <vector>

namespace gnomon::raster {
namespace {

/// A stage's text, and the files that it was put together from. The compiler counts the lines of file k from
/// lines_per_file * k: GLSL's own numbers of sources are lost in some of Mesa's messages.
constexpr std::size_t lines_per_file = 100000;
struct Expansion {
  struct File {
    std::string name;
    bool replaced = false;  ///< from the shader folder
  };
  std::string text;
  std::vector<File> files;
  std::span<const std::string_view> defines;
  std::string_view folder;
  Expected<void> read{};  ///< the first failure to read a file

  bool holds(const std::string& name) const {
    return std::any_of(files.begin(), files.end(), [&](const File& file) { return file.name == name; });
  }
};

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

void expand(std::string_view source, Expansion& out);

// The text of a file: that of the shader folder where it has one of the name.
void expand_file(const std::string& name, Expansion& out) {
  out.files.push_back({name});
  const std::filesystem::path path = std::filesystem::path(out.folder) / name;
  std::error_code none;
  if (out.folder.empty() || !std::filesystem::exists(path, none)) {
    expand(embedded::shaders(name), out);
    return;
  }
  out.files.back().replaced = true;
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file && out.read) {
    Error error{ErrorKind::bad_input, "cannot be read"};
    error.file = path.string();
    out.read = fail(std::move(error));
  }
  expand(text, out);
}

// Appends a source, its includes in place. `#line` keeps the compiler's line numbers right.
void expand(std::string_view source, Expansion& out) {
  const std::size_t self = out.files.size() - 1;
  out.text += fmt::format("#line {}\n", lines_per_file * self + 1);
  std::size_t line_number = 0;
  while (!source.empty()) {
    const std::size_t end = std::min(source.find('\n'), source.size());
    const std::string_view line = source.substr(0, end);
    source.remove_prefix(std::min(end + 1, source.size()));
    ++line_number;
    constexpr std::string_view include = "#include \"";
    if (!line.starts_with(include)) {
      out.text.append(line).push_back('\n');
      continue;
    }
    const std::size_t close = std::max(line.rfind('"'), include.size());
    const std::string name = included_name(line.substr(include.size(), close - include.size()), out.defines);
    if (!out.holds(name)) expand_file(name, out);
    out.text += fmt::format("#line {}\n", lines_per_file * self + line_number + 1);
  }
}

Expansion begin_expansion(std::span<const std::string_view> defines, std::string_view folder) {
  Expansion out;
  out.defines = defines;
  out.folder = folder;
  out.text = "#version 450 core\n";
  for (const std::string_view define : defines) out.text += fmt::format("#define {}\n", define);
  return out;
}

/// The first complaint of a compiler's log, "S:L(C): error: words": Mesa's form; others begin alike.
struct Complaint {
  std::size_t file = 0;
  int line = 0;
  std::string words;
};

std::string first_line(std::string_view text) {
  return std::string(text.substr(0, text.find('\n')));
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

// The user's mistake where the complaint is about a file of the shader folder, else the program's.
Error compile_error(const Expansion& expansion, std::string_view stage_file, const std::string& log) {
  const auto complaint = first_complaint(log);
  if (complaint && complaint->file < expansion.files.size() && expansion.files[complaint->file].replaced) {
    Error error{ErrorKind::bad_input, fmt::format("the shader does not compile: {}", complaint->words)};
    error.file = (std::filesystem::path(expansion.folder) / expansion.files[complaint->file].name).string();
    error.line = complaint->line;
    return error;
  }
  const bool own = std::none_of(expansion.files.begin(), expansion.files.end(),
                                [](const Expansion::File& file) { return file.replaced; });
  std::string legend;
  for (std::size_t i = 0; i < expansion.files.size(); ++i)
    legend += fmt::format(" {}={}", i, expansion.files[i].name);
  return {own ? ErrorKind::internal : ErrorKind::bad_input,
          fmt::format("shader {} does not compile (sources:{}): {}", stage_file, legend,
                      own ? log : first_line(log))};
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
    if (!expansion.read) return expansion.read;
    const GLchar* chars = expansion.text.c_str();
    gl->ShaderSource(id, 1, &chars, nullptr);
    gl->CompileShader(id);
    GLint ok = GL_FALSE;
    gl->GetShaderiv(id, GL_COMPILE_STATUS, &ok);
    if (ok == GL_TRUE) return {};
    GLint length = 0;
    gl->GetShaderiv(id, GL_INFO_LOG_LENGTH, &length);
    return fail(compile_error(expansion, file, log_text(length, [&](GLint n, char* out) {
                                gl->GetShaderInfoLog(id, n, nullptr, out);
                              })));
  }
  Expected<void> compile_file(std::string_view file, std::span<const std::string_view> defines) const {
    Expansion expansion = begin_expansion(defines, gl.shader_folder());
    expand_file(std::string(file), expansion);
    return compile(expansion, file);
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
  return fail(gl.shader_folder().empty() ? ErrorKind::internal : ErrorKind::bad_input,
              fmt::format("shader {} does not link: {}", name, log));
}

}  // namespace

std::string expand_shader(std::string_view file, std::span<const std::string_view> defines) {
  Expansion expansion = begin_expansion(defines, {});
  expand_file(std::string(file), expansion);
  return expansion.text;
}

Expected<Program> Program::link(const Gl& gl, std::string_view vertex, std::string_view fragment,
                                std::span<const std::string_view> defines) {
  Program program(gl, gl->CreateProgram());
  const Stage vertex_stage(gl, GL_VERTEX_SHADER);
  const Stage fragment_stage(gl, GL_FRAGMENT_SHADER);
  if (auto ok = vertex_stage.compile_file(vertex, defines); !ok) return fail(ok.error());
  gl->AttachShader(program.id(), vertex_stage.id);
  if (!fragment.empty()) {
    if (auto ok = fragment_stage.compile_file(fragment, defines); !ok) return fail(ok.error());
    gl->AttachShader(program.id(), fragment_stage.id);
  }
  if (auto ok = link_stages(gl, program.id(), fragment.empty() ? vertex : fragment); !ok)
    return fail(ok.error());
  return program;
}

Expected<Program> Program::link_compute(const Gl& gl, std::string_view source) {
  Program program(gl, gl->CreateProgram());
  const Stage stage(gl, GL_COMPUTE_SHADER);
  Expansion expansion = begin_expansion({}, gl.shader_folder());
  expansion.files.push_back({"compute"});
  expand(source, expansion);
  if (auto ok = stage.compile(expansion, "compute"); !ok) return fail(ok.error());
  gl->AttachShader(program.id(), stage.id);
  if (auto ok = link_stages(gl, program.id(), "compute"); !ok) return fail(ok.error());
  return program;
}

void Program::use() const {
  gl()->UseProgram(id());
}

}  // namespace gnomon::raster
