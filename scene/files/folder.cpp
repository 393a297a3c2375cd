#include "scene/files/folder.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <limits.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <memory>
#include <thread>

#include "scene/base/interrupted.h"
#include "scene/files/flushing.h"
#include "scene/files/links.h"
#include "scene/files/new_file.h"
#include "scene/files/path_status.h"
#include "scene/files/write_file.h"

namespace gnomon {
namespace {

std::atomic<bool> flushing{true};

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

bool is_planted(const struct stat& folder, const struct stat& thing) {
  constexpr mode_t open_to_all = S_ISVTX | S_IWOTH;
  return (folder.st_mode & open_to_all) == open_to_all && thing.st_uid != ::geteuid() &&
         thing.st_uid != folder.st_uid;
}

namespace {

Expected<void> refuse_if_planted(const Folder& folder, const std::string& name, const struct stat& thing) {
  const auto around = folder.itself();
  if (!around) return fail(around.error());
  if (!is_planted(*around, thing)) return {};
  return fail(Error{ErrorKind::cannot_write,
                    "belongs to another user, in a folder where anybody may write: choose another name or "
                    "folder",
                    folder.path_of(name)});
}

}  // namespace

Expected<void> refuse_planted(const Folder& folder, const std::string& name) {
  const auto found = folder.find(name);
  if (!found) return fail(found.error());
  return *found ? refuse_if_planted(folder, name, **found) : Expected<void>{};
}

Expected<std::optional<std::string>> Folder::link_target(const std::string& name) const {
  const Descriptor link(
      uninterrupted([&] { return ::openat(descriptor_, name.c_str(), O_PATH | O_NOFOLLOW | O_CLOEXEC); }));
  struct stat status = {};
  if (link.number() < 0 || ::fstat(link.number(), &status) != 0 || !S_ISLNK(status.st_mode))
    return std::optional<std::string>();
  if (auto fine = refuse_if_planted(*this, name, status); !fine) return fail(fine.error());
  std::string target(PATH_MAX, '\0');
  const ssize_t length = ::readlinkat(link.number(), "", target.data(), target.size());
  if (length < 0) return failed_in(path_of(name), "cannot be looked at", errno);
  target.resize(static_cast<std::size_t>(length));
  return std::optional(std::move(target));
}

// By one name after another, so that nobody changes a link between the look at it and the step through it.
Expected<Folder> Folder::at(const std::string& path) {
  constexpr int most_links = 40;  // as the system has it
  const std::string shown = path.empty() ? "." : path;
  const auto opened = [&](const char* start) { return open_folder(AT_FDCWD, start, 0); };
  std::string rest = shown;
  Folder folder(shown, opened(rest.starts_with('/') ? "/" : "."));
  for (int links = 0; folder.descriptor_ >= 0 && !rest.empty();) {
    const std::size_t end = std::min(rest.find('/'), rest.size());
    const std::string name = rest.substr(0, end);
    rest.erase(0, end + 1);
    if (name.empty()) continue;
    const int next = open_folder(folder.descriptor_, name.c_str(), O_NOFOLLOW);
    if (next >= 0) {
      folder = Folder(shown, next);
      continue;
    }
    const int why = errno;
    const auto link = folder.link_target(name);
    if (!link) return fail(link.error());
    if (!*link) return failed_in(shown, "cannot open the folder", why);
    if (++links > most_links) return failed_in(shown, "cannot open the folder", ELOOP);
    rest.insert(0, **link + "/");
    if (rest.starts_with('/')) folder = Folder(shown, opened("/"));
  }
  if (folder.descriptor_ < 0) return failed_in(shown, "cannot open the folder", errno);
  return folder;
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

void leave_flushing_to_the_system() {
  flushing = false;
}

bool is_flushing() {
  return flushing;
}

Expected<void> Folder::flush() const {
  if (!is_flushing()) return {};
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
