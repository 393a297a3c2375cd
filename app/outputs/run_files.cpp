#include "app/outputs/run_files.h"

#include <fmt/core.h>
#include <sys/stat.h>

#include <filesystem>

#include "raster/programs/shader_folder.h"
#include "scene/base/option_text.h"
#include "scene/files/path_status.h"
#include "scene/files/read_file.h"
#include "scene/files/write_file.h"

namespace gnomon::app {

std::vector<std::string> SceneArgument::plain_words() const {
  std::vector<std::string> words{name};
  if (allow_outside) words.emplace_back("--allow-outside");
  if (instances != InstanceChoice::automatic) {
    words.emplace_back("--instances");
    words.emplace_back(instances == InstanceChoice::keep ? "keep" : "flatten");
  }
  if (time) {
    words.emplace_back("--time");
    words.push_back((time->path.empty() ? "" : time->path + ":") + number_text(time->seconds));
  }
  return words;
}

SceneArgument SceneArgument::named(const std::string& other) const {
  SceneArgument scene = *this;
  scene.name = other;
  return scene;
}

std::string SceneArgument::words() const {
  std::string text;
  for (const std::string& word : plain_words()) text += (text.empty() ? "" : " ") + shell_quoted(word);
  return text;
}

void RunFiles::reads(const std::string& path) {
  if (!path.empty()) inputs_.push_back(path);
}

// A name without an extension is a built-in scene's (scene/load.h).
void RunFiles::reads(const SceneArgument& scene) {
  if (!lower_extension(scene.name).empty()) reads(scene.name);
}

void RunFiles::reads_shaders(const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code stop;
  fs::recursive_directory_iterator file(folder, fs::directory_options::skip_permission_denied, stop);
  for (; !stop && file != fs::recursive_directory_iterator(); file.increment(stop))
    if (raster::is_shader(file->path())) reads(file->path().string());
}

void RunFiles::writes(std::string option, const std::string& path) {
  if (!path.empty() && path != "-") outputs_.push_back({std::move(option), path});
}

void RunFiles::writes_folder(const std::string& option, const std::string& folder,
                             std::span<const std::string_view> names) {
  if (folder.empty()) return;
  folders_.push_back(folder);
  for (const std::string_view name : names)
    outputs_.push_back({option, (std::filesystem::path(folder) / name).string(), folder});
}

namespace {

/// Says of two outputs that are one file whether they have one name or a link leads from one to the other.
std::string how_they_meet(const std::string& a, const std::string& b) {
  std::error_code error;
  const auto written = [&](const std::string& path) {
    return std::filesystem::absolute(path, error).lexically_normal();
  };
  if (written(a) == written(b)) return fmt::format("two outputs of one name (got {})", b);
  return fmt::format("two outputs that a link makes one file (got {} and {})", a, b);
}

}  // namespace

Expected<void> RunFiles::check_collisions() const {
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    const Output& output = outputs_[i];
    for (const std::string& input : inputs_)
      if (is_same_file(output.path, input))
        return fail(ErrorKind::usage,
                    fmt::format("{}: this file is also an input, which would be lost (got {})", output.option,
                                output.path));
    for (std::size_t j = 0; j < i; ++j) {
      const Output& other = outputs_[j];
      // A folder's files take the places of whatever has their names, links too.
      const bool both_replaced = !output.folder.empty() && output.folder == other.folder;
      if (!both_replaced && is_same_file(output.path, other.path))
        return fail(ErrorKind::usage, fmt::format("{} and {}: {}", other.option, output.option,
                                                  how_they_meet(other.path, output.path)));
    }
  }
  return {};
}

Expected<void> RunFiles::check() const {
  if (auto apart = check_collisions(); !apart) return apart;
  for (const Output& output : outputs_) {
    if (!output.folder.empty()) continue;
    if (auto writable = check_output_file(output.path); !writable) return writable;
  }
  for (const std::string& folder : folders_)
    if (auto writable = check_output_folder(folder); !writable) return writable;
  return {};
}

Expected<void> RunFiles::also_reads(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) reads(path);
  return check_collisions();
}

namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> cannot_write(const fs::path& path, const std::string& reason) {
  return fail(Error{ErrorKind::cannot_write, "cannot write here: " + reason, path.string()});
}

/// Tells whether a path at which nothing is found is a link.
bool leads_nowhere(const fs::path& path) {
  struct stat link = {};
  return lstat(path.c_str(), &link) == 0;
}

/// Walks up to what exists already.
Expected<void> check_folder(fs::path folder) {
  if (folder.empty()) folder = ".";
  for (;;) {
    const auto kind = file_kind(folder.string(), ErrorKind::cannot_write);
    if (!kind) return fail(kind.error());
    if (*kind == FileKind::folder) return check_takes_files(folder.string());
    if (*kind != FileKind::none || !folder.has_relative_path())
      return cannot_write(folder, "it is not a folder");
    if (leads_nowhere(folder)) return cannot_write(folder, "it is a link that leads nowhere");
    const fs::path parent = folder.parent_path();
    folder = parent.empty() ? fs::path(".") : parent;
  }
}

}  // namespace

Expected<void> check_output_folder(const std::string& path) {
  return check_folder(fs::path(path).lexically_normal());
}

Expected<void> check_output_file(const std::string& path) {
  if (path.empty() || path == "-") return {};
  const auto folder = is_folder(path, ErrorKind::cannot_write);
  if (!folder) return fail(folder.error());
  if (*folder) return cannot_write(path, "it is a folder");
  return check_folder(fs::path(path).lexically_normal().parent_path());
}

Expected<void> check_extension(std::string_view option, const std::string& path,
                               std::string_view extensions) {
  const std::string extension = lower_extension(path);
  const bool known =
      !extension.empty() &&
      fmt::format(" {} ", extensions).find(fmt::format(" {} ", extension)) != std::string::npos;
  if (known) return {};
  return fail(ErrorKind::usage,
              fmt::format("{}: unknown kind of file (got {}, allowed {})", option, path, extensions));
}

}  // namespace gnomon::app
