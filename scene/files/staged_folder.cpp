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
#include <mutex>
#include <new>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/files/path_status.h"
#include "scene/files/write_file.h"

namespace gnomon {
namespace {

namespace fs = std::filesystem;

/// A staged folder's name is this, the process's number and ".part". One in a folder that is there lies in it, one of a
/// folder that is not there yet beside it.
std::string prefix_in_it() {
  return ".gnomon.";
}
std::string prefix_beside(const fs::path& folder) {
  constexpr std::size_t longest = 100;  // of 255 bytes that a file system takes
  return folder.filename().string().substr(0, longest) + prefix_in_it();
}

fs::path parent_of(const fs::path& folder) {
  return folder.has_parent_path() ? folder.parent_path() : fs::path(".");
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

bool is_staged_name(std::string_view name, std::string_view prefix) {
  constexpr std::string_view end = ".part";
  if (!name.starts_with(prefix) || !name.ends_with(end) || name.size() <= prefix.size() + end.size())
    return false;
  const std::string_view number = name.substr(prefix.size(), name.size() - prefix.size() - end.size());
  return number.find_first_not_of("0123456789") == std::string_view::npos;
}

/// What a killed process left among the names in `place`: what it replaced goes back into `folder`, and the rest goes.
Expected<void> clear_abandoned(const fs::path& folder, const fs::path& place, const std::string& prefix) {
  const auto names = names_if_there(place.string());
  if (!names)
    return {};  // who may write into a folder may still not list it; then nothing is known to be abandoned
  for (const std::string& name : *names) {
    if (!is_staged_name(name, prefix)) continue;
    const fs::path staged = place / name;
    const FolderLock abandoned(staged, Wait::no);
    if (!abandoned.held()) continue;
    if (is_unfinished_publication(staged.string())) {
      const FolderLock others(folder, Wait::yes);
      if (auto undone = undo_publication(folder.string(), staged.string()); !undone) return undone;
    }
    (void)remove_all_of(staged.string());  // another user's may stay: it is in nobody's way
  }
  return {};
}

Expected<void> flush_folder(const std::string& folder) {
  const Descriptor descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (descriptor.number() < 0)
    return failed_call(ErrorKind::cannot_write, folder, "cannot open the folder", errno);
  if (::fsync(descriptor.number()) == 0 || errno == EINVAL || errno == ENOTSUP)
    return {};  // not every system can
  return failed_call(ErrorKind::cannot_write, folder, "cannot flush it to the disk", errno);
}

using FileId = std::pair<dev_t, ino_t>;

/// None where nothing is there: what is not there cannot be lost.
Expected<std::optional<FileId>> file_id(const std::string& path) {
  struct stat status = {};
  if (::stat(path.c_str(), &status) == 0) return FileId{status.st_dev, status.st_ino};
  if (errno == ENOENT || errno == ENOTDIR) return std::nullopt;
  return failed_call(ErrorKind::cannot_write, path, "cannot be looked at", errno);
}

Expected<std::set<FileId>> file_ids(std::span<const std::string> paths) {
  std::set<FileId> ids;
  for (const std::string& path : paths) {
    const auto id = file_id(path);
    if (!id) return fail(id.error());
    if (*id) ids.insert(**id);
  }
  return ids;
}

Expected<void> check_targets(const fs::path& folder, const std::vector<std::string>& files,
                             std::span<const std::string> inputs) {
  const auto ids = file_ids(inputs);
  if (!ids) return fail(ids.error());
  for (const std::string& file : files) {
    const std::string target = (folder / file).string();
    const auto kind = file_kind(target, ErrorKind::cannot_write);
    if (!kind) return fail(kind.error());
    if (*kind == FileKind::folder)
      return fail(Error{ErrorKind::cannot_write, "cannot write: it is a folder", target});
    const auto id = file_id(target);
    if (!id) return fail(id.error());
    if (*id && ids->contains(**id))
      return fail(ErrorKind::usage,
                  fmt::format("-o: this file is also an input, which would be lost (got {})", target));
  }
  return {};
}

/// The staged folders of this process.
struct LivingFolders {
  std::mutex mutex;
  std::set<std::string> paths;
};
LivingFolders& living_folders() {
  static LivingFolders folders;
  return folders;
}

void remove_staged(const std::string& path, bool published) {
  const auto remove = [&] {
    // What could not be put back stays in it for the next run into the folder.
    if (published || !is_unfinished_publication(path)) (void)remove_all_of(path);
  };
  try {
    remove();
  } catch (const std::bad_alloc&) {  // there may be memory again, now that the stack is unwound
    remove();
  }
}

}  // namespace

StagedFolder::StagedFolder(std::string folder, std::string path)
    : folder_(std::move(folder)), path_(std::move(path)) {
  const std::lock_guard lock(living_folders().mutex);
  living_folders().paths.insert(path_);
}

StagedFolder::StagedFolder(StagedFolder&& other) noexcept
    : folder_(std::move(other.folder_)),
      path_(std::exchange(other.path_, {})),
      files_(std::move(other.files_)),
      published_(other.published_),
      lock_(std::exchange(other.lock_, -1)) {}

StagedFolder::~StagedFolder() {
  if (!path_.empty()) remove_staged(path_, published_);
  forget();
  if (lock_ >= 0) ::close(lock_);
}

void StagedFolder::forget() {
  const std::lock_guard lock(living_folders().mutex);
  living_folders().paths.erase(std::exchange(path_, {}));
}

void StagedFolder::remove_all_at_the_end() {
  living_folders().mutex.lock();
  for (const std::string& path : living_folders().paths) remove_staged(path, false);
}

Expected<StagedFolder> StagedFolder::open(const std::string& folder) {
  fs::path target = fs::path(folder).lexically_normal();
  if (!target.has_filename() && target.has_relative_path()) target = target.parent_path();
  const auto exists = is_there(target.string(), ErrorKind::cannot_write);
  if (!exists) return fail(exists.error());
  const fs::path place = *exists ? target : parent_of(target);
  if (auto made = make_output_folder(place.string()); !made) return fail(made.error());
  for (const auto& [where, prefix] :
       {std::pair(parent_of(target), prefix_beside(target)), std::pair(target, prefix_in_it())})
    if (auto cleared = clear_abandoned(target, where, prefix); !cleared) return fail(cleared.error());
  const std::string prefix = *exists ? prefix_in_it() : prefix_beside(target);
  const std::string staged = (place / fmt::format("{}{}.part", prefix, ::getpid())).string();
  // Until it is locked, another process that starts may take the folder for an abandoned one.
  for (;;) {
    if (::mkdir(staged.c_str(), 0777) != 0)
      return failed_call(ErrorKind::cannot_write, staged, "cannot create the folder", errno);
    StagedFolder made(target.string(), staged);
    made.lock_ = FolderLock(staged, Wait::yes).release();
    if (made.lock_ >= 0) return made;
    const auto unlocked = is_there(staged, ErrorKind::cannot_write);
    if (!unlocked) return fail(unlocked.error());
    if (*unlocked) return made;
  }
}

Expected<void> StagedFolder::seal(std::span<const std::string> inputs) {
  auto files = files_below(path_, ErrorKind::cannot_write);
  if (!files) return fail(files.error());
  files_ = std::move(*files);
  if (auto fine = check_targets(folder_, files_, inputs); !fine) return fine;
  return flush_folder(path_);
}

Expected<void> StagedFolder::publish(const std::string& last) {
  // One rename where nothing, or an empty folder, is in the way.
  if (fs::path(path_).parent_path() != fs::path(folder_)) {
    if (::rename(path_.c_str(), folder_.c_str()) == 0) {
      forget();
      return {};
    }
    if (errno != EEXIST && errno != ENOTEMPTY)
      return failed_call(ErrorKind::cannot_write, folder_, "cannot rename the finished folder", errno);
  }
  const FolderLock others(folder_, Wait::yes);  // that put their files here at the same time
  if (auto moved = publish_into(folder_, path_, files_, last); !moved) return moved;
  published_ = true;
  auto gone = remove_all_of(path_);
  if (!gone) gone = remove_all_of(path_);  // a disk that stumbled once
  if (gone)
    forget();
  else
    gone.error().reason += "; the new files are all in their places";
  return gone;
}

}  // namespace gnomon
