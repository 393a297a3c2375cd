#include "app/output_path.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "scene/files/read_file.h"
#include "scene/files/write_file.h"

namespace gnomon::app {

namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> cannot_write(const fs::path& path, const std::string& reason) {
  return fail(Error{ErrorKind::cannot_write, "cannot write here: " + reason, path.string()});
}

/// Makes a file in the folder and removes it again: permissions alone do not tell.
Expected<void> try_to_write_in(const fs::path& folder) {
  std::string name = (folder / ".gnomon-XXXXXX").string();
  const int file = mkstemp(name.data());
  if (file < 0) return cannot_write(folder, std::generic_category().message(errno));
  close(file);
  unlink(name.c_str());
  return {};
}

/// Walks up to what exists already.
Expected<void> check_folder(fs::path folder) {
  std::error_code error;
  if (folder.empty()) folder = ".";
  while (!fs::exists(folder, error) && folder.has_relative_path()) {
    if (error && error != std::errc::not_a_directory) return cannot_write(folder, error.message());
    const fs::path parent = folder.parent_path();
    folder = parent.empty() ? fs::path(".") : parent;
  }
  if (!fs::is_directory(folder, error)) return cannot_write(folder, "it is not a folder");
  return try_to_write_in(folder);
}

}  // namespace

Expected<void> check_output_folder(const std::string& path) {
  return check_folder(fs::path(path).lexically_normal());
}

Expected<void> check_output_file(const std::string& path) {
  if (path.empty() || path == "-") return {};
  std::error_code error;
  if (fs::is_directory(path, error)) return cannot_write(path, "it is a folder");
  return check_folder(fs::path(path).lexically_normal().parent_path());
}

Expected<void> make_folder_for(const std::string& path) {
  const std::string folder = fs::path(path).parent_path().string();
  return folder.empty() ? Expected<void>{} : make_output_folder(folder);
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
