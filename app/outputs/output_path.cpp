#include "app/outputs/output_path.h"

#include <fmt/core.h>
#include <sys/stat.h>

#include <filesystem>

#include "scene/files/path_status.h"
#include "scene/files/read_file.h"
#include "scene/files/write_file.h"

namespace gnomon::app {

namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> cannot_write(const fs::path& path, const std::string& reason) {
  return fail(Error{ErrorKind::cannot_write, "cannot write here: " + reason, path.string()});
}

/// Of a place where nothing is.
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
