#include "scene/files/write_file.h"

#include "scene/files/path_status.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <optional>

namespace gnomon {
namespace {

namespace fs = std::filesystem;

// A write past RLIMIT_FSIZE raises SIGXFSZ, whose default is to end the process. It is raised for the writing
// thread, so blocking it there and discarding what is pending turns it into EFBIG and touches nobody else.
class FileSizeSignalBlock {
 public:
  FileSizeSignalBlock() {
    sigemptyset(&set_);
    sigaddset(&set_, SIGXFSZ);
    pthread_sigmask(SIG_BLOCK, &set_, &old_);
  }
  ~FileSizeSignalBlock() {
    const timespec no_wait{};
    while (sigtimedwait(&set_, nullptr, &no_wait) == SIGXFSZ) {
    }
    pthread_sigmask(SIG_SETMASK, &old_, nullptr);
  }
  FileSizeSignalBlock(const FileSizeSignalBlock&) = delete;
  FileSizeSignalBlock& operator=(const FileSizeSignalBlock&) = delete;

 private:
  sigset_t set_{}, old_{};
};

// 0, or the errno of the failing write.
int write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

Expected<void> write_directly(const std::string& path, std::string_view bytes) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (file.number() < 0) return failed_call(ErrorKind::cannot_write, path, "cannot open it", errno);
  if (const int error = write_all(file.number(), bytes))
    return failed_call(ErrorKind::cannot_write, path, "cannot write", error);
  if (!file.close()) return failed_call(ErrorKind::cannot_write, path, "cannot close it", errno);
  return {};
}

// Of the original name, of 255 bytes that a file system takes.
constexpr std::size_t longest_kept_name = 100;

/// Beside the path, with so much of its name as a file system takes (255 bytes).
std::string temporary_name(const std::string& path) {
  static std::atomic<unsigned> counter{0};
  const fs::path file(path);
  const std::string name = file.filename().string().substr(0, longest_kept_name);
  return (file.parent_path() / fmt::format("{}.{}-{}.part", name, ::getpid(), counter++)).string();
}

/// Goes unless it was renamed, whatever is thrown.
struct TemporaryFile {
  explicit TemporaryFile(const std::string& target) : path(temporary_name(target)) {}
  ~TemporaryFile() { ::unlink(path.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::string path;
};

// Writes, flushes and closes the temporary file.
Expected<void> fill_temporary(const std::string& path, const std::string& temporary, std::string_view bytes,
                              std::optional<mode_t> old_mode) {
  Descriptor file(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (file.number() < 0)
    return failed_call(ErrorKind::cannot_write, path, "cannot create a file beside it", errno);
  if (old_mode && ::fchmod(file.number(), *old_mode & 07777) != 0)
    return failed_call(ErrorKind::cannot_write, path, "cannot keep its permissions", errno);
  if (const int error = write_all(file.number(), bytes))
    return failed_call(ErrorKind::cannot_write, path, "cannot write", error);
  if (::fsync(file.number()) != 0)
    return failed_call(ErrorKind::cannot_write, path, "cannot flush it to the disk", errno);
  if (!file.close()) return failed_call(ErrorKind::cannot_write, path, "cannot close it", errno);
  return {};
}

// A symbolic link stays a link: what it points to is replaced. One that leads nowhere is replaced itself.
Expected<std::string> follow_link(const std::string& path) {
  const auto there = is_there(path, ErrorKind::cannot_write);
  if (!there) return fail(there.error());
  if (!*there) return path;
  std::error_code error;
  const fs::path target = fs::canonical(path, error);
  if (error) return failed_call(ErrorKind::cannot_write, path, "cannot follow it", error.value());
  return target.string();
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

Expected<void> write_file(const std::string& path, std::string_view bytes) {
  const FileSizeSignalBlock block;
  const auto followed = follow_link(path);
  if (!followed) return fail(followed.error());
  const std::string& target = *followed;
  struct stat status {};
  std::optional<mode_t> old_mode;
  if (::stat(target.c_str(), &status) == 0) {
    if (S_ISDIR(status.st_mode)) return failed_call(ErrorKind::cannot_write, path, "it is a folder", EISDIR);
    if (!S_ISREG(status.st_mode)) return write_directly(path, bytes);
    old_mode = status.st_mode;
  }
  const TemporaryFile temporary(target);
  if (auto filled = fill_temporary(path, temporary.path, bytes, old_mode); !filled) return filled;
  if (::rename(temporary.path.c_str(), target.c_str()) != 0)
    return failed_call(ErrorKind::cannot_write, path, "cannot rename the finished file", errno);
  return {};
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

Expected<PartFile> PartFile::create(const std::string& path) {
  PartFile file;
  auto target = follow_link(path);
  if (!target) return fail(target.error());
  file.target_ = std::move(*target);
  struct stat status {};
  if (::stat(file.target_.c_str(), &status) == 0 && !S_ISREG(status.st_mode))
    return failed_call(ErrorKind::cannot_write, path, "a picture made in bands needs a plain file", EINVAL);
  const fs::path folder = fs::path(file.target_).parent_path();
  file.descriptor_ = ::open(folder.empty() ? "." : folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
  if (file.descriptor_ >= 0) return file;
  const std::string part = temporary_name(file.target_);
  file.descriptor_ = ::open(part.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file.descriptor_ < 0)
    return failed_call(ErrorKind::cannot_write, path, "cannot create a file beside it", errno);
  file.part_ = part;
  return file;
}

PartFile& PartFile::operator=(PartFile&& other) noexcept {
  std::swap(target_, other.target_);
  std::swap(part_, other.part_);
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

PartFile::~PartFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!part_.empty()) ::unlink(part_.c_str());
}

Expected<void> PartFile::append(std::string_view bytes) {
  return write_from(SEEK_END, bytes);
}

Expected<void> PartFile::write_over_begin(std::string_view bytes) {
  return write_from(SEEK_SET, bytes);
}

Expected<void> PartFile::write_from(int whence, std::string_view bytes) {
  const FileSizeSignalBlock block;
  if (::lseek(descriptor_, 0, whence) < 0)
    return failed_call(ErrorKind::cannot_write, target_, "cannot write", errno);
  if (const int error = write_all(descriptor_, bytes))
    return failed_call(ErrorKind::cannot_write, target_, "cannot write", error);
  return {};
}

Expected<void> PartFile::publish() {
  struct stat old {};
  if (::stat(target_.c_str(), &old) == 0 && ::fchmod(descriptor_, old.st_mode & 07777) != 0)
    return failed_call(ErrorKind::cannot_write, target_, "cannot keep its permissions", errno);
  if (::fsync(descriptor_) != 0)
    return failed_call(ErrorKind::cannot_write, target_, "cannot flush it to the disk", errno);
  if (part_.empty()) {  // gets a name first, for a file that is there already can only be renamed over
    const std::string part = temporary_name(target_);
    const std::string here = fmt::format("/proc/self/fd/{}", descriptor_);
    if (::linkat(AT_FDCWD, here.c_str(), AT_FDCWD, part.c_str(), AT_SYMLINK_FOLLOW) != 0)
      return failed_call(ErrorKind::cannot_write, target_, "cannot name the finished file", errno);
    part_ = part;
  }
  if (::rename(part_.c_str(), target_.c_str()) != 0)
    return failed_call(ErrorKind::cannot_write, target_, "cannot rename the finished file", errno);
  part_.clear();
  return {};
}

Expected<void> write_over_end(const std::string& path, std::string_view end) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (file.number() < 0) return failed_call(ErrorKind::cannot_write, path, "cannot open it", errno);
  if (::lseek(file.number(), -static_cast<off_t>(end.size()), SEEK_END) < 0)
    return failed_call(ErrorKind::cannot_write, path, "cannot write over its end", errno);
  if (const int error = write_all(file.number(), end))
    return failed_call(ErrorKind::cannot_write, path, "cannot write", error);
  if (!file.close()) return failed_call(ErrorKind::cannot_write, path, "cannot close it", errno);
  return {};
}

bool is_same_file(const std::string& a, const std::string& b) {
  const auto kind = file_kind(a);
  if (kind && (*kind == FileKind::folder || *kind == FileKind::other)) return false;
  if (const auto same = are_one_path(a, b); same && *same) return true;
  std::error_code error;
  const auto whole = [&](const std::string& path) {
    return fs::weakly_canonical(fs::absolute(path, error), error);
  };
  return whole(a) == whole(b) && !error;
}

Expected<void> make_output_folder(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) return failed_call(ErrorKind::cannot_write, path, "cannot create the folder", error.value());
  return check_takes_files(path);
}

Expected<void> make_folder_for(const std::string& path) {
  const std::string folder = fs::path(path).parent_path().string();
  return folder.empty() ? Expected<void>{} : make_output_folder(folder);
}

Expected<void> check_takes_files(const std::string& folder) {
  const auto there = is_folder(folder, ErrorKind::cannot_write);
  if (!there) return fail(there.error());
  if (!*there) return failed_call(ErrorKind::cannot_write, folder, "cannot write here", ENOTDIR);
  const Descriptor nameless(::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600));
  if (nameless.number() >= 0) return {};
  const std::string probe = temporary_name((fs::path(folder) / probe_name).string());
  const Descriptor file(::open(probe.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
  if (file.number() < 0)
    return failed_call(ErrorKind::cannot_write, folder, "cannot create files in the folder", errno);
  return remove_path(probe);
}

}  // namespace gnomon
