#include "raster/programs/shader_text.h"

#include <embedded/shaders.h>
#include <fmt/core.h>

#include <algorithm>

namespace gnomon::raster {
namespace {

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

class Expander {
 public:
  Expander(std::span<const std::string_view> defines, const ShaderFolder& folder)
      : defines_(defines), folder_(&folder) {
    out_.text = "#version 450 core\n";
    for (const std::string_view define : defines) out_.text += fmt::format("#define {}\n", define);
  }

  // The text of a file: that of the shader folder where it has one of the name. False: there is none.
  bool file(const std::string& name) {
    const std::string* other = folder_->find(name);
    const std::string_view text = other != nullptr ? std::string_view(*other) : embedded::shaders(name);
    if (text.data() == nullptr) return false;
    source(text, {name, other != nullptr});
    return true;
  }

  // Appends a source, its includes in place. `#line` keeps the compiler's line numbers right.
  void source(std::string_view text, Expansion::File file_of_text) {
    const std::size_t self = out_.files.size();
    out_.files.push_back(std::move(file_of_text));
    out_.text += fmt::format("#line {}\n", lines_per_file * self + 1);
    std::size_t line_number = 0;
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      const std::string_view line = text.substr(0, end);
      text.remove_prefix(std::min(end + 1, text.size()));
      ++line_number;
      if (!line.starts_with(include)) {
        out_.text.append(line).push_back('\n');
        continue;
      }
      include_line(line, self, line_number);
      out_.text += fmt::format("#line {}\n", lines_per_file * self + line_number + 1);
    }
  }

  Expansion take() { return std::move(out_); }

 private:
  static constexpr std::string_view include = "#include \"";

  void include_line(std::string_view line, std::size_t in_file, std::size_t line_number) {
    const std::size_t close = std::max(line.rfind('"'), include.size());
    const std::string name = included_name(line.substr(include.size(), close - include.size()), defines_);
    if (out_.holds(name) || file(name) || !out_.complete) return;
    Error error{ErrorKind::bad_input,
                fmt::format("no such shader (got {}; gnomon shaders lists them)", name)};
    const Expansion::File& from = out_.files[in_file];
    error.file = from.replaced ? folder_->path_of(from.name) : from.name;
    error.line = static_cast<int>(line_number);
    if (!from.replaced) error.kind = ErrorKind::internal;
    out_.complete = fail(std::move(error));
  }

  std::span<const std::string_view> defines_;
  const ShaderFolder* folder_;
  Expansion out_;
};

}  // namespace

bool Expansion::holds(std::string_view name) const {
  return std::any_of(files.begin(), files.end(), [&](const File& file) { return file.name == name; });
}

std::vector<std::string> Expansion::replaced() const {
  std::vector<std::string> names;
  for (const File& file : files)
    if (file.replaced) names.push_back(file.name);
  return names;
}

Expansion expand_file(std::string_view file, std::span<const std::string_view> defines,
                      const ShaderFolder& folder) {
  Expander expander(defines, folder);
  expander.file(std::string(file));
  return expander.take();
}

Expansion expand_source(std::string_view source, std::string name, const ShaderFolder& folder) {
  Expander expander({}, folder);
  expander.source(source, {std::move(name)});
  return expander.take();
}

}  // namespace gnomon::raster
