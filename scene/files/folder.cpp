#include "scene/files/folder.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <memory>
#include <thread>

#include "scene/base/interrupted.h"
#include "scene/files/links.h"
#include "scene/files/new_file.h"
#include "scene/files/path_status.h"

namespace gnomon {
namespace {

tl::unexpected<Error> failed_in(const std::string& path, std::string_view step, int error_number) {
  return failed_call(ErrorKind::cannot_write, path, step, error_number);
}

/// Opens for reading where that is allowed; else for what needs no more than the right to search.
int open_folder(int from, const char* path, int flags) {
  const auto opened = [&](int access) {
    return uninterrupted([&] { return ::openat(from, path, access | flags | O_DIRECTORY | O_CLOEXEC); });
  };
  const int readable = opened(O_RDONLY);
  return readable >= 0 || errno != EACCES ? readable : opened(O_PATH);
}

int open_for_reading(const Folder& folder) {
  return uninterrupted(
      [&] { return ::openat(folder.descriptor(), ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC); });
}

Expected<void> refuse_link(const Folder& folder, const std::string& name) {
  const auto found = folder.find(name);
  if (!found) return fail(found.error());
  if (!*found || !S_ISLNK((*found)->st_mode)) return {};
  return fail(Error{ErrorKind::cannot_write,
                    "is a link, and nothing inside an output folder is written through a link: remove it, or "
                    "choose another folder",
                    folder.path_of(name)});
}

Expected<void> remove_in(const Folder& folder, const std::string& name, uid_t owner, dev_t device);

/// Removes what can be; the error is that of the first that cannot.
Expected<void> empty(const Folder& folder, uid_t owner, dev_t device) {
  const auto names = folder.names();
  if (!names) return fail(names.error());
  Expected<void> all;
  for (const std::string& name : *names)
    if (auto removed = remove_in(folder, name, owner, device); !removed && all) all = removed;
  return all;
}

Expected<void> unlink_in(const Folder& folder, const std::string& name, int flags) {
  if (::unlinkat(folder.descriptor(), name.c_str(), flags) == 0 || errno == ENOENT) return {};
  return failed_in(folder.path_of(name), "cannot be removed", errno);
}

Expected<void> remove_in(const Folder& folder, const std::string& name, uid_t owner, dev_t device) {
  const auto found = folder.find(name);
  if (!found) return fail(found.error());
  if (!*found) return {};
  if ((*found)->st_uid != owner)
    return fail(Error{ErrorKind::cannot_write, "belongs to another user", folder.path_of(name)});
  if (!S_ISDIR((*found)->st_mode)) return unlink_in(folder, name, 0);
  if ((*found)->st_dev != device)
    return fail(Error{ErrorKind::cannot_write, "lies on another file system", folder.path_of(name)});
  if (const auto inside = folder.below(name)) {
    if (auto emptied = empty(*inside, owner, device); !emptied) return emptied;
  }
  return unlink_in(folder, name, AT_REMOVEDIR);  // also where it cannot be opened, but is empty
}

}  // namespace

Folder& Folder::operator=(Folder&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

Folder::~Folder() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Expected<Folder> Folder::at(const std::string& path) {
  const std::string& shown = path.empty() ? "." : path;
  const int descriptor = open_folder(AT_FDCWD, shown.c_str(), 0);
  if (descriptor < 0) return failed_in(shown, "cannot open the folder", errno);
  return Folder(shown, descriptor);
}

Expected<Folder> Folder::entered(const std::string& name) const {
  const int descriptor = open_folder(descriptor_, name.c_str(), O_NOFOLLOW);
  if (descriptor >= 0) return Folder(path_of(name), descriptor);
  const int why = errno;
  if (auto plain = refuse_link(*this, name); !plain) return fail(plain.error());
  return failed_in(path_of(name), "cannot open the folder", why);
}

Expected<Folder> Folder::below(const std::string& names) const {
  auto folder = entered(".");
  if (!folder) {
    folder.error().file = path_;
    return folder;
  }
  folder->path_ = path_;
  for (std::size_t at = 0; at < names.size();) {
    const std::size_t end = std::min(names.find('/', at), names.size());
    auto next = folder->entered(names.substr(at, end - at));
    if (!next) return next;
    *folder = std::move(*next);
    at = end + 1;
  }
  return folder;
}

Expected<void> refuse_links(const std::string& folder, const std::vector<std::string>& names) {
  const auto opened = Folder::at(folder);
  if (!opened) return fail(opened.error());
  for (const std::string& name : names)
    if (auto plain = refuse_link(*opened, name); !plain) return plain;
  return {};
}

Expected<std::optional<struct stat>> Folder::find(const std::string& name) const {
  struct stat found = {};
  if (::fstatat(descriptor_, name.c_str(), &found, AT_SYMLINK_NOFOLLOW) == 0) return found;
  if (errno == ENOENT) return std::nullopt;
  return failed_in(path_of(name), "cannot be looked at", errno);
}

Expected<struct stat> Folder::itself() const {
  struct stat found = {};
  if (::fstat(descriptor_, &found) == 0) return found;
  return failed_in(path_, "cannot be looked at", errno);
}

Expected<std::vector<std::string>> Folder::names() const {
  const int descriptor = open_for_reading(*this);
  if (descriptor < 0) return failed_in(path_, "cannot be listed", errno);
  return names_in_open(descriptor, path_, ErrorKind::cannot_write);
}

Expected<void> Folder::flush() const {
  const int descriptor = open_for_reading(*this);
  if (descriptor < 0) return failed_in(path_, "cannot open the folder", errno);
  const int flushed = uninterrupted([&] { return ::fsync(descriptor); }), why = errno;
  ::close(descriptor);
  if (flushed == 0 || why == EINVAL || why == ENOTSUP) return {};  // not every system can
  return failed_in(path_, "cannot flush it to the disk", why);
}

std::string folder_part(const std::string& name) {
  const std::size_t slash = name.rfind('/');
  return slash == std::string::npos ? std::string() : name.substr(0, slash);
}

std::string last_part(const std::string& name) {
  return name.substr(name.rfind('/') + 1);
}

Expected<bool> make_folder_in(const Folder& folder, const std::string& name) {
  const auto place = folder.below(folder_part(name));
  if (!place) return fail(place.error());
  if (::mkdirat(place->descriptor(), last_part(name).c_str(), 0777) == 0) return true;
  const int why = errno;
  if (why != EEXIST) return failed_in(folder.path_of(name), "cannot create the folder", why);
  const auto there = place->below(last_part(name));
  if (!there) return fail(there.error());
  return false;
}

Expected<void> remove_tree(const Folder& folder, const std::string& name, uid_t owner) {
  const auto around = folder.itself();
  if (!around) return fail(around.error());
  return remove_in(folder, name, owner, around->st_dev);
}

Expected<void> check_umask_leaves(mode_t needed, mode_t got, const std::string& path) {
  if ((got & needed) == needed) return {};
  return fail(Error{ErrorKind::cannot_write,
                    "the umask takes away your own rights to what is written (`umask 022` gives them back)",
                    path});
}

Expected<struct stat> try_new_file(const Folder& folder) {
  constexpr mode_t needed = 0600;
  auto again = folder.below("");
  if (!again) return fail(again.error());
  auto file =
      NewFile::make(std::move(*again), std::string(probe_name), NewFile::Name::none_if_possible, needed);
  if (!file) return failed_in(folder.path(), "cannot create files in the folder", errno);
  struct stat made = {};
  if (::fstat(file->descriptor(), &made) != 0) return failed_in(folder.path(), "cannot be looked at", errno);
  if (auto gone = file->remove(); !gone) return fail(gone.error());
  if (auto fine = check_umask_leaves(needed, made.st_mode, folder.path()); !fine) return fail(fine.error());
  return made;
}

FolderLock FolderLock::of(const Folder& folder) {
  FolderLock lock;
  lock.descriptor_ = open_for_reading(folder);
  if (lock.descriptor_ < 0) return lock;
  if (uninterrupted([&] { return ::flock(lock.descriptor_, LOCK_EX | LOCK_NB); }) == 0) return lock;
  const int why = errno;
  ::close(std::exchange(lock.descriptor_, -1));
  errno = why;
  return lock;
}

Expected<FolderLock> FolderLock::waited_for(const Folder& folder) {
  using std::chrono::steady_clock;
  constexpr std::chrono::seconds longest(30);
  constexpr std::chrono::milliseconds between(5);
  const auto until = steady_clock::now() + longest;
  for (;;) {
    FolderLock lock = of(folder);
    if (lock.held() || errno != EWOULDBLOCK) return lock;
    if (steady_clock::now() > until)
      return fail(Error{ErrorKind::cannot_write,
                        fmt::format("another process has held its lock for {} seconds", longest.count()),
                        folder.path()});
    std::this_thread::sleep_for(between);
  }
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace gnomon
