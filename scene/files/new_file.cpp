#include "scene/files/new_file.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <signal.h>
#include <stdio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "scene/base/interrupted.h"
#include "scene/files/flushing.h"
#include "scene/files/path_status.h"
#include "scene/files/unfinished_files.h"

namespace gnomon {
namespace {

/// Of the file's own name, of 255 bytes that a file system takes.
constexpr std::size_t longest_kept_name = 100;

std::string temporary_name(const std::string& name) {
  static std::atomic<unsigned> counter{0};
  return fmt::format("{}.{}-{}.part", name.substr(0, longest_kept_name), ::getpid(), counter++);
}

/// The names of all files in the making, each with the descriptor of its folder. No two of a process have one name.
struct Unfinished {
  std::mutex mutex;
  std::map<std::string, int> folders;
};
Unfinished& unfinished() {
  static Unfinished files;
  return files;
}

void remember(const std::string& temporary, int folder) {
  const std::lock_guard lock(unfinished().mutex);
  unfinished().folders.emplace(temporary, folder);
}

void forget(const std::string& temporary) {
  const std::lock_guard lock(unfinished().mutex);
  unfinished().folders.erase(temporary);
}

/// Reads a process's number, which has decimal digits alone, without a leading zero.
std::optional<pid_t> process_number(std::string_view text) {
  pid_t number = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (status != std::errc() || end != text.data() + text.size() || number <= 0 || text.front() == '0')
    return std::nullopt;
  return number;
}

}  // namespace

template <class Use>
int NewFile::with_temporary_name(const Use& use) {
  constexpr int most = 1000;  // names that somebody has taken before
  for (int taken = 0;; ++taken) {
    std::string name = temporary_name(name_);
    remember(name, folder_.descriptor());
    const int result = use(name.c_str());
    if (result < 0) forget(name);
    if (result >= 0) temporary_ = std::move(name);  // needs no memory: the file is there already
    if (result >= 0 || errno != EEXIST || taken == most) return result;
  }
}

tl::unexpected<Error> NewFile::failed(std::string_view step) const {
  return failed_call(ErrorKind::cannot_write, folder_.path() == "." ? name_ : folder_.path_of(name_), step,
                     errno);
}

Expected<NewFile> NewFile::make(Folder folder, std::string name, Name has, mode_t mode) {
  NewFile file(std::move(folder), std::move(name));
  const auto opened = [&](const char* at, int flags) {
    return uninterrupted(
        [&] { return ::openat(file.folder_.descriptor(), at, flags | O_RDWR | O_CLOEXEC, mode); });
  };
  if (has == Name::none_if_possible) file.descriptor_ = opened(".", O_TMPFILE);
  if (file.descriptor_ < 0)
    file.descriptor_ =
        file.with_temporary_name([&](const char* at) { return opened(at, O_CREAT | O_EXCL | O_NOFOLLOW); });
  if (file.descriptor_ < 0) return file.failed("cannot create a file beside it");
  return file;
}

NewFile::NewFile(NewFile&& other) noexcept
    : folder_(std::move(other.folder_)),
      name_(std::move(other.name_)),
      temporary_(std::exchange(other.temporary_, {})),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

NewFile& NewFile::operator=(NewFile&& other) noexcept {
  std::swap(folder_, other.folder_);
  std::swap(name_, other.name_);
  std::swap(temporary_, other.temporary_);
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

NewFile::~NewFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (temporary_.empty()) return;
  ::unlinkat(folder_.descriptor(), temporary_.c_str(), 0);
  forget(temporary_);
}

Expected<void> NewFile::flush() {
  if (is_flushing() && uninterrupted([&] { return ::fsync(descriptor_); }) != 0)
    return failed("cannot flush it to the disk");
  if (temporary_.empty()) return {};
  // A descriptor is gone, whatever closing it answers; only where a signal came nothing is wrong with the file.
  if (::close(std::exchange(descriptor_, -1)) != 0 && errno != EINTR) return failed("cannot close it");
  return {};
}

Expected<void> NewFile::publish(const Folder& folder, const std::string& name) {
  if (temporary_.empty()) {  // gets a name first, for a file that is there already can only be renamed over
    const std::string here = fmt::format("/proc/self/fd/{}", descriptor_);
    const int named = with_temporary_name([&](const char* at) {
      return ::linkat(AT_FDCWD, here.c_str(), folder_.descriptor(), at, AT_SYMLINK_FOLLOW);
    });
    if (named < 0) return failed("cannot name the finished file");
  }
  if (::renameat(folder_.descriptor(), temporary_.c_str(), folder.descriptor(), name.c_str()) != 0)
    return failed("cannot rename the finished file");
  forget(temporary_);
  temporary_.clear();
  return {};
}

Expected<void> NewFile::remove() {
  if (temporary_.empty()) return {};
  const std::string name = std::exchange(temporary_, {});
  const bool removed = ::unlinkat(folder_.descriptor(), name.c_str(), 0) == 0;
  forget(name);
  if (removed) return {};
  return failed("cannot be removed");
}

void remove_unfinished_files() {
  unfinished().mutex.lock();
  for (const auto& [name, folder] : unfinished().folders) ::unlinkat(folder, name.c_str(), 0);
}

std::string abandoned_part_of(std::string_view name) {
  constexpr std::string_view end = ".part";
  if (!name.ends_with(end)) return {};
  name.remove_suffix(end.size());
  const std::size_t dot = name.rfind('.'), dash = name.rfind('-');
  if (dot == std::string_view::npos || dash == std::string_view::npos || dash < dot ||
      dot > longest_kept_name)
    return {};
  const std::string_view count = name.substr(dash + 1);
  const auto process = process_number(name.substr(dot + 1, dash - dot - 1));
  if (!process || count.empty() || count.find_first_not_of("0123456789") != std::string_view::npos) return {};
  const bool lives = *process != ::getpid() && (::kill(*process, 0) == 0 || errno != ESRCH);
  return lives ? std::string() : std::string(name.substr(0, dot));
}

}  // namespace gnomon
