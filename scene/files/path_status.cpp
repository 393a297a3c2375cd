#include "scene/files/path_status.h"

#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

namespace gnomon {
namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> path_error(ErrorKind kind, const std::string& path, std::string_view what,
                                 const std::error_code& why) {
  return failed_call(kind, path, what, why.value());
}

constexpr std::string_view cannot_look = "cannot be looked at", cannot_list = "cannot be listed",
                           cannot_remove = "cannot be removed";

}  // namespace

Expected<FileKind> file_kind(const std::string& path, ErrorKind error) {
  std::error_code why;
  const fs::file_status status = fs::status(path, why);
  switch (status.type()) {
    case fs::file_type::none:
      return path_error(error, path, cannot_look, why);
    case fs::file_type::not_found:
      return FileKind::none;
    case fs::file_type::regular:
      return FileKind::file;
    case fs::file_type::directory:
      return FileKind::folder;
    default:
      return FileKind::other;
  }
}

Expected<bool> is_there(const std::string& path, ErrorKind error) {
  return file_kind(path, error).map([](FileKind kind) { return kind != FileKind::none; });
}

Expected<bool> is_folder(const std::string& path, ErrorKind error) {
  return file_kind(path, error).map([](FileKind kind) { return kind == FileKind::folder; });
}

Expected<bool> is_plain_file(const std::string& path, ErrorKind error) {
  return file_kind(path, error).map([](FileKind kind) { return kind == FileKind::file; });
}

Expected<std::uint64_t> size_of_file(const std::string& path, ErrorKind error) {
  const auto kind = file_kind(path, error);
  if (!kind) return fail(kind.error());
  if (*kind != FileKind::file) return fail(Error{error, "is not a plain file", path});
  std::error_code why;
  const std::uint64_t size = fs::file_size(path, why);
  if (why) return path_error(error, path, cannot_look, why);
  return size;
}

FileKind file_kind_or_none(const std::string& path) {
  return file_kind(path).value_or(FileKind::none);
}

Expected<std::vector<std::string>> names_in(const std::string& folder, ErrorKind error) {
  std::vector<std::string> names;
  std::error_code why;
  for (fs::directory_iterator entry(folder, why), end; !why && entry != end; entry.increment(why))
    names.push_back(entry->path().filename().string());
  if (why) return path_error(error, folder, cannot_list, why);
  std::sort(names.begin(), names.end());
  return names;
}

Expected<std::vector<std::string>> names_if_there(const std::string& folder, ErrorKind error) {
  const auto there = is_there(folder, error);
  if (!there) return fail(there.error());
  return *there ? names_in(folder, error) : std::vector<std::string>{};
}

Expected<std::vector<std::string>> files_below(const std::string& folder, ErrorKind error) {
  std::vector<std::string> files;
  std::error_code why;
  for (fs::recursive_directory_iterator entry(folder, why), end; !why && entry != end; entry.increment(why)) {
    const bool deeper = entry->symlink_status(why).type() == fs::file_type::directory;
    if (why) break;
    if (!deeper) files.push_back(entry->path().lexically_relative(folder).generic_string());
  }
  if (why) return path_error(error, folder, cannot_list, why);
  std::sort(files.begin(), files.end());
  return files;
}

Expected<void> remove_path(const std::string& path) {
  std::error_code why;
  fs::remove(path, why);
  if (why) return path_error(ErrorKind::cannot_write, path, cannot_remove, why);
  return {};
}

Expected<void> remove_all_of(const std::string& folder) {
  std::error_code why;
  fs::remove_all(folder, why);
  if (why) return path_error(ErrorKind::cannot_write, folder, cannot_remove, why);
  return {};
}

Expected<bool> are_one_path(const std::string& a, const std::string& b, ErrorKind error) {
  for (const std::string* path : {&a, &b}) {
    const auto there = is_there(*path, error);
    if (!there) return fail(there.error());
    if (!*there) return false;
  }
  std::error_code why;
  const bool same = fs::equivalent(a, b, why);
  if (why) return path_error(error, a, cannot_look, why);
  return same;
}

tl::unexpected<Error> failed_call(ErrorKind kind, std::string file, std::string_view step, int error_number) {
  const bool resource = error_number == EMFILE || error_number == ENFILE || error_number == ENOMEM;
  return fail(Error{resource ? ErrorKind::graphics : kind,
                    fmt::format("{}: {}", step, std::strerror(error_number)), std::move(file)});
}

}  // namespace gnomon
