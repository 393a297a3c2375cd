#include "raster/programs/shader_folder.h"

#include <embedded/shaders.h>
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "raster/programs/programs.h"
#include "scene/files/encodings.h"
#include "scene/files/json/json_reader.h"
#include "scene/files/read_file.h"

namespace gnomon::raster {
namespace {

namespace fs = std::filesystem;

bool is_own(std::string_view name) {
  const std::vector<ShaderFile> own = own_shaders();
  return std::any_of(own.begin(), own.end(), [&](const ShaderFile& file) { return file.name == name; });
}

// "; did you mean technique/hard.glsl?": one of the same file name in another folder, or else of a like name.
std::string right_path(const std::string& name) {
  std::vector<std::string_view> names;
  for (const ShaderFile& file : own_shaders()) {
    if (fs::path(file.name).filename() == fs::path(name).filename())
      return fmt::format("; did you mean {}?", file.name);
    names.push_back(file.name);
  }
  const std::string near = suggestion(name, names);
  return near.empty() ? suggestion("technique/" + name, names) : near;
}

Error error_in(const std::string& file, std::string reason) {
  return {ErrorKind::bad_input, std::move(reason), file};
}

/// Empty where it is text. Every other byte of UTF-16 is zero, for a shader's words are ASCII.
std::string why_no_text(const std::string& bytes) {
  const auto zeros = static_cast<std::size_t>(std::count(bytes.begin(), bytes.end(), '\0'));
  if (zeros == 0) return {};
  return 3 * zeros >= bytes.size() ? "is not UTF-8 text, but seems to be UTF-16 (save it as UTF-8)"
                                   : "is not text (save it as UTF-8)";
}

}  // namespace

bool is_shader(const fs::path& path) {
  const std::string extension = path.extension().string();
  return extension == ".glsl" || extension == ".vert" || extension == ".frag" || extension == ".h";
}

std::vector<ShaderFile> own_shaders() {
  std::vector<ShaderFile> files;
  for (const embedded::Entry& entry : embedded::shaders_entries()) files.push_back({entry.name, entry.bytes});
  return files;
}

std::string technique_file(const MapOptions& map, const Light& light) {
  return "technique/" + technique_shader(map, light).name + ".glsl";
}

std::string ShaderFolder::path_of(std::string_view name) const {
  return (fs::path(path_) / name).string();
}

Expected<ShaderFolder> ShaderFolder::read(const std::string& folder) {
  ShaderFolder out;
  out.path_ = folder;
  if (folder.empty()) return out;
  std::string texts;  // of all files, to see what they include
  std::size_t shaders = 0;
  std::error_code error;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (!is_shader(entry->path()) || entry->is_directory()) continue;
    ++shaders;
    const auto bytes = read_file(entry->path().string());
    if (!bytes) return fail(bytes.error());
    if (const std::string why_not = why_no_text(*bytes); !why_not.empty())
      return fail(error_in(entry->path().string(), why_not));
    const std::string text(without_byte_order_mark(*bytes));
    texts += text + "\n";
    const std::string name = entry->path().lexically_relative(folder).generic_string();
    if (!is_own(name) || embedded::shaders(name) != text) out.files_[name] = {text, sha256_hex(*bytes)};
  }
  if (error) return fail(error_in(folder, fmt::format("cannot be read: {}", error.message())));
  if (shaders == 0) return fail(error_in(folder, "holds no shader (names end in .glsl, .vert, .frag or .h)"));
  for (const auto& [name, file] : out.files_)
    if (!is_own(name) && texts.find(fmt::format("#include \"{}\"", name)) == std::string::npos)
      return fail(error_in(
          out.path_of(name),
          fmt::format("replaces no shader of the program{} (gnomon shaders lists them)", right_path(name))));
  return out;
}

const std::string* ShaderFolder::find(const std::string& name) const {
  const auto found = files_.find(name);
  return found == files_.end() ? nullptr : &found->second.text;
}

std::vector<ReplacedShader> ShaderFolder::replaced() const {
  std::vector<ReplacedShader> list;
  for (const auto& [name, file] : files_) list.push_back({name, file.sha256});
  return list;
}

std::vector<ReplacedShader> ShaderFolder::used() const {
  std::vector<ReplacedShader> list;
  for (const std::string& name : used_) list.push_back({name, files_.at(name).sha256});
  return list;
}

namespace {

std::string why_no_visibility(float v, int x, int y) {
  const std::string where = fmt::format("at pixel ({}, {}), counted from the top left", x, y);
  if (v == unwritten_visibility) return fmt::format("writes nothing {}: is there a discard?", where);
  return fmt::format("technique_visibility() gives no visibility {} (got {}, allowed 0 to 1)", where, v);
}

/// To blame for what is drawn.
std::string drawing_file(const ShaderFolder& folder, const std::string& technique_file) {
  return folder.find(technique_file) != nullptr ? folder.path_of(technique_file) : folder.path();
}

}  // namespace

Error draws_differently(const ShaderFolder& folder, const std::string& technique_file) {
  return error_in(
      drawing_file(folder, technique_file),
      "draws differently when it is timed: the same drawing was made several times, and not every "
      "time alike");
}

Expected<void> check_visibility(const Image<float>& visibility, const ShaderFolder& folder,
                                const std::string& technique_file) {
  // A mean of up to 256 tests, each rounded once, leaves [0, 1] by at most 256 * 2^-24.
  constexpr float rounding = 1.6e-5f;
  for (int y = 0; y < visibility.size.height; ++y) {
    for (int x = 0; x < visibility.size.width; ++x) {
      const float v = visibility.at(x, y);
      if (v >= -rounding && v <= 1.0f + rounding) continue;
      return fail(error_in(drawing_file(folder, technique_file), why_no_visibility(v, x, y)));
    }
  }
  return {};
}

}  // namespace gnomon::raster
