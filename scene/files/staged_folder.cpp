#include "scene/files/staged_folder.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <utility>
#include <vector>

#include "scene/files/write_file.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> cannot_write(const std::string& path, std::string_view step, const std::string& why) {
  return fail(Error{ErrorKind::cannot_write, fmt::format("{}: {}", step, why), path});
}

/// The beginning of every staged folder's name; the process's number and ".part" follow.
std::string prefix_for(const fs::path& folder, bool exists) {
  constexpr std::size_t longest = 100;
  return exists ? ".gnomon." : folder.filename().string().substr(0, longest) + ".";
}

enum class Wait : std::uint8_t { no, yes };

/// A lock that the system takes back when its process ends. Holds none where there is no such folder (any more), where
/// its file system has no locks, and where somebody else holds it, unless that is waited for.
class FolderLock {
 public:
  FolderLock(const fs::path& folder, Wait wait)
      : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (descriptor_ < 0) return;
    int result = 0;
    do result = ::flock(descriptor_, LOCK_EX | (wait == Wait::no ? LOCK_NB : 0));
    while (result != 0 && errno == EINTR);
    // While it was opened or waited for, another process may have put a new folder in its place.
    if (result != 0 || !is_of(folder)) ::close(std::exchange(descriptor_, -1));
  }
  ~FolderLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  bool held() const { return descriptor_ >= 0; }
  /// The descriptor, which holds the lock until it is closed; -1 where none is held.
  int release() { return std::exchange(descriptor_, -1); }

 private:
  bool is_of(const fs::path& folder) const {
    struct stat locked = {}, there = {};
    return ::fstat(descriptor_, &locked) == 0 && ::stat(folder.c_str(), &there) == 0 &&
           locked.st_dev == there.st_dev && locked.st_ino == there.st_ino;
  }
  int descriptor_;
};

void remove_abandoned(const fs::path& parent, const std::string& prefix) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(parent, error)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(prefix) || !name.ends_with(".part") || !entry.is_directory(error)) continue;
    const std::string middle = name.substr(prefix.size(), name.size() - prefix.size() - 5);
    if (middle.empty() || middle.find_first_not_of("0123456789") != std::string::npos) continue;
    const FolderLock lock(entry.path(), Wait::no);
    if (lock.held()) fs::remove_all(entry.path(), error);
  }
}

void flush_folder(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

Expected<std::vector<std::string>> files_in(const fs::path& folder) {
  std::vector<std::string> files;
  std::error_code error;
  for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (!it->is_directory(error)) files.push_back(it->path().lexically_relative(folder).string());
  if (error) return cannot_write(folder.string(), "cannot list it", error.message());
  return files;
}

Expected<void> check_targets(const fs::path& folder, const std::vector<std::string>& files,
                             std::span<const std::string> inputs) {
  for (const std::string& file : files) {
    const fs::path target = folder / file;
    std::error_code error;
    if (fs::is_directory(target, error))
      return cannot_write(target.string(), "cannot write", "it is a folder");
    for (const std::string& input : inputs)
      if (is_same_file(target.string(), input))
        return fail(
            ErrorKind::usage,
            fmt::format("-o: this file is also an input, which would be lost (got {})", target.string()));
  }
  return {};
}

Expected<void> move_file(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::create_directories(to.parent_path(), error);
  if (!error) fs::rename(from, to, error);
  if (error) return cannot_write(to.string(), "cannot rename the finished file", error.message());
  return {};
}

}  // namespace

StagedFolder::StagedFolder(std::string folder, std::string path, int lock)
    : folder_(std::move(folder)), path_(std::move(path)), lock_(lock) {}

StagedFolder::StagedFolder(StagedFolder&& other) noexcept
    : folder_(std::move(other.folder_)),
      path_(std::exchange(other.path_, {})),
      files_(std::move(other.files_)),
      lock_(std::exchange(other.lock_, -1)) {}

StagedFolder::~StagedFolder() {
  std::error_code error;
  if (!path_.empty()) fs::remove_all(path_, error);
  if (lock_ >= 0) ::close(lock_);
}

Expected<StagedFolder> StagedFolder::open(const std::string& folder) {
  std::error_code error;
  fs::path target = fs::path(folder).lexically_normal();
  if (!target.has_filename() && target.has_relative_path()) target = target.parent_path();
  const bool exists = fs::exists(target, error);
  const fs::path parent = exists ? target : target.has_parent_path() ? target.parent_path() : fs::path(".");
  if (auto made = make_output_folder(parent.string()); !made) return fail(made.error());
  const std::string prefix = prefix_for(target, exists);
  remove_abandoned(parent, prefix);
  const fs::path staged = parent / fmt::format("{}{}.part", prefix, ::getpid());
  // Until it is locked, another process that starts may take the folder for an abandoned one.
  for (;;) {
    if (!fs::create_directory(staged, error))
      return cannot_write(staged.string(), "cannot create the folder",
                          error ? error.message() : std::string("it exists"));
    FolderLock lock(staged, Wait::yes);
    if (lock.held() || fs::exists(staged, error))
      return StagedFolder(target.string(), staged.string(), lock.release());
  }
}

Expected<void> StagedFolder::seal(std::span<const std::string> inputs) {
  auto files = files_in(path_);
  if (!files) return fail(files.error());
  files_ = std::move(*files);
  if (auto fine = check_targets(folder_, files_, inputs); !fine) return fine;
  flush_folder(path_);
  return {};
}

Expected<void> StagedFolder::publish(const std::string& last) {
  const fs::path folder(folder_), staged(path_);
  // One rename where nothing, or an empty folder, is in the way.
  if (staged.parent_path() != folder && ::rename(path_.c_str(), folder_.c_str()) == 0) {
    path_.clear();
    return {};
  }
  const FolderLock others(folder, Wait::yes);  // that put their files here at the same time
  std::error_code error;
  fs::remove(folder / last, error);
  for (const std::string& file : files_)
    if (file != last)
      if (auto moved = move_file(staged / file, folder / file); !moved) return moved;
  return move_file(staged / last, folder / last);
}

}  // namespace gnomon
