#include "scene/files/path_status.h"

#include <dirent.h>
#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

#include "scene/base/interrupted.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> path_error(ErrorKind kind, const std::string& path, std::string_view what,
                                 const std::error_code& why) {
  return failed_call(kind, path, what, why.value());
}

constexpr std::string_view cannot_look = "cannot be looked at", cannot_list = "cannot be listed",
                           cannot_remove = "cannot be removed";

/// What is wrong with a path that is to be a plain file.
const char* no_file_words(fs::file_type type) {
  switch (type) {
    case fs::file_type::not_found:
      return "no such file";
    case fs::file_type::directory:
      return "is a folder, not a file";
    case fs::file_type::fifo:
      return "is a pipe, not a file";
    case fs::file_type::socket:
      return "is a socket, not a file";
    case fs::file_type::block:
    case fs::file_type::character:
      return "is a device, not a file";
    default:
      return "is not a plain file";
  }
}

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
  std::error_code why;
  const fs::file_type type = fs::status(path, why).type();
  if (type == fs::file_type::none) return path_error(error, path, cannot_look, why);
  if (type != fs::file_type::regular) return fail(Error{error, no_file_words(type), path});
  const std::uint64_t size = fs::file_size(path, why);
  if (why) return path_error(error, path, cannot_look, why);
  return size;
}

FileKind file_kind_or_none(const std::string& path) {
  return file_kind(path).value_or(FileKind::none);
}

// Not by std::filesystem's iterators: they end the program where they get no memory.
Expected<std::vector<std::string>> names_in_open(int descriptor, const std::string& folder, ErrorKind error) {
  DIR* const opened = ::fdopendir(descriptor);
  if (opened == nullptr) {
    const int why = errno;
    ::close(descriptor);
    return failed_call(error, folder, cannot_list, why);
  }
  const std::unique_ptr<DIR, int (*)(DIR*)> list(opened, ::closedir);
  std::vector<std::string> names;
  for (;;) {
    errno = 0;
    const dirent* const entry = ::readdir(list.get());
    if (entry == nullptr) break;
    const std::string_view name = entry->d_name;
    if (name != "." && name != "..") names.emplace_back(name);
  }
  if (errno != 0) return failed_call(error, folder, cannot_list, errno);
  std::sort(names.begin(), names.end());
  return names;
}

Expected<std::vector<std::string>> names_in(const std::string& folder, ErrorKind error) {
  const int descriptor =
      uninterrupted([&] { return ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); });
  if (descriptor < 0) return failed_call(error, folder, cannot_list, errno);
  return names_in_open(descriptor, folder, error);
}

Expected<std::vector<std::string>> names_if_there(const std::string& folder, ErrorKind error) {
  const auto there = is_there(folder, error);
  if (!there) return fail(there.error());
  return *there ? names_in(folder, error) : std::vector<std::string>{};
}

Expected<std::vector<std::string>> files_below(const std::string& folder, ErrorKind error) {
  const auto names = names_in(folder, error);
  if (!names) return names;
  std::vector<std::string> files;
  for (const std::string& name : *names) {
    const std::string path = fmt::format("{}/{}", folder, name);
    std::error_code why;
    const bool deeper = fs::symlink_status(path, why).type() == fs::file_type::directory;
    if (why) return path_error(error, path, cannot_look, why);
    if (!deeper) {
      files.push_back(name);
      continue;
    }
    const auto below = files_below(path, error);
    if (!below) return below;
    for (const std::string& file : *below) files.push_back(fmt::format("{}/{}", name, file));
  }
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
