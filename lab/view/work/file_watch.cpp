#include "lab/view/work/file_watch.h"

#include "scene/files/path_status.h"

namespace gnomon::lab {

namespace fs = std::filesystem;

FileWatch::FileWatch(std::vector<std::string> paths) : paths_(std::move(paths)), seen_(look()) {}

void FileWatch::watch(std::vector<std::string> paths) {
  if (paths != paths_) *this = FileWatch(std::move(paths));
}

bool FileWatch::changed() {
  std::map<std::string, Stamp> now = look();
  if (now == seen_) return false;
  seen_ = std::move(now);
  return true;
}

std::map<std::string, FileWatch::Stamp> FileWatch::look() const {
  std::map<std::string, Stamp> stamps;
  std::error_code none;  // what cannot be looked at does not change
  const auto add = [&](const fs::path& path) {
    if (file_kind_or_none(path.string()) != FileKind::file) return;
    const auto time = fs::last_write_time(path, none);
    const auto size = fs::file_size(path, none);
    if (!none) stamps[path.string()] = {time, size};
  };
  for (const std::string& path : paths_) {
    add(path);
    if (file_kind_or_none(path) != FileKind::folder) continue;
    for (fs::recursive_directory_iterator it(path, fs::directory_options::skip_permission_denied, none), end;
         it != end; it.increment(none)) {
      if (none) break;
      add(it->path());
    }
  }
  return stamps;
}

}  // namespace gnomon::lab
