#include "scene/files/write_file.h"

#include "scene/files/descriptor.h"
#include "scene/files/part_file.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <optional>

namespace gnomon {
namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> cannot_write(const std::string& path, std::string_view step, int error_number) {
  Error error{ErrorKind::cannot_write, fmt::format("{}: {}", step, std::strerror(error_number))};
  error.file = path;
  return fail(std::move(error));
}

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
  if (file.number() < 0) return cannot_write(path, "cannot open it", errno);
  if (const int error = write_all(file.number(), bytes)) return cannot_write(path, "cannot write", error);
  if (!file.close()) return cannot_write(path, "cannot close it", errno);
  return {};
}

/// Beside the path, with so much of its name as a file system takes (255 bytes).
std::string temporary_name(const std::string& path) {
  static std::atomic<unsigned> counter{0};
  constexpr std::size_t longest = 100;
  const fs::path file(path);
  const std::string name = file.filename().string().substr(0, longest);
  return (file.parent_path() / fmt::format("{}.{}-{}.part", name, ::getpid(), counter++)).string();
}

// Writes, flushes and closes the temporary file; the caller removes it on failure.
Expected<void> fill_temporary(const std::string& path, const std::string& temporary, std::string_view bytes,
                              std::optional<mode_t> old_mode) {
  Descriptor file(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (file.number() < 0) return cannot_write(path, "cannot create a file beside it", errno);
  if (old_mode && ::fchmod(file.number(), *old_mode & 07777) != 0)
    return cannot_write(path, "cannot keep its permissions", errno);
  if (const int error = write_all(file.number(), bytes)) return cannot_write(path, "cannot write", error);
  if (::fsync(file.number()) != 0) return cannot_write(path, "cannot flush it to the disk", errno);
  if (!file.close()) return cannot_write(path, "cannot close it", errno);
  return {};
}

// A symbolic link stays a link: what it points to is replaced.
std::string follow_link(const std::string& path) {
  std::error_code ignored;
  if (!fs::is_symlink(path, ignored)) return path;
  const fs::path target = fs::canonical(path, ignored);
  return target.empty() ? path : target.string();
}

}  // namespace

Expected<void> write_file(const std::string& path, std::string_view bytes) {
  const FileSizeSignalBlock block;
  const std::string target = follow_link(path);
  struct stat status {};
  std::optional<mode_t> old_mode;
  if (::stat(target.c_str(), &status) == 0) {
    if (S_ISDIR(status.st_mode)) return cannot_write(path, "it is a folder", EISDIR);
    if (!S_ISREG(status.st_mode)) return write_directly(path, bytes);
    old_mode = status.st_mode;
  }
  const std::string temporary = temporary_name(target);
  Expected<void> filled = fill_temporary(path, temporary, bytes, old_mode);
  if (filled && ::rename(temporary.c_str(), target.c_str()) != 0)
    filled = cannot_write(path, "cannot rename the finished file", errno);
  if (!filled) ::unlink(temporary.c_str());
  return filled;
}

Expected<PartFile> PartFile::create(const std::string& path) {
  PartFile file;
  file.target_ = follow_link(path);
  struct stat status {};
  if (::stat(file.target_.c_str(), &status) == 0 && !S_ISREG(status.st_mode))
    return cannot_write(path, "a picture made in bands needs a plain file", EINVAL);
  const fs::path folder = fs::path(file.target_).parent_path();
  file.descriptor_ = ::open(folder.empty() ? "." : folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
  if (file.descriptor_ >= 0) return file;
  const std::string part = temporary_name(file.target_);
  file.descriptor_ = ::open(part.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file.descriptor_ < 0) return cannot_write(path, "cannot create a file beside it", errno);
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

std::string PartFile::path() const {
  return part_.empty() ? fmt::format("/proc/self/fd/{}", descriptor_) : part_;
}

Expected<void> PartFile::publish() {
  struct stat old {};
  if (::stat(target_.c_str(), &old) == 0 && ::fchmod(descriptor_, old.st_mode & 07777) != 0)
    return cannot_write(target_, "cannot keep its permissions", errno);
  if (::fsync(descriptor_) != 0) return cannot_write(target_, "cannot flush it to the disk", errno);
  if (part_.empty()) {  // gets a name first, for a file that is there already can only be renamed over
    const std::string part = temporary_name(target_);
    if (::linkat(AT_FDCWD, path().c_str(), AT_FDCWD, part.c_str(), AT_SYMLINK_FOLLOW) != 0)
      return cannot_write(target_, "cannot name the finished file", errno);
    part_ = part;
  }
  if (::rename(part_.c_str(), target_.c_str()) != 0)
    return cannot_write(target_, "cannot rename the finished file", errno);
  part_.clear();
  return {};
}

Expected<void> write_over_end(const std::string& path, std::string_view end) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (file.number() < 0) return cannot_write(path, "cannot open it", errno);
  if (::lseek(file.number(), -static_cast<off_t>(end.size()), SEEK_END) < 0)
    return cannot_write(path, "cannot write over its end", errno);
  if (const int error = write_all(file.number(), end)) return cannot_write(path, "cannot write", error);
  if (!file.close()) return cannot_write(path, "cannot close it", errno);
  return {};
}

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  const fs::file_status status = fs::status(a, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) return false;
  if (fs::equivalent(a, b, error) && !error) return true;
  const auto whole = [&](const std::string& path) {
    return fs::weakly_canonical(fs::absolute(path, error), error);
  };
  return whole(a) == whole(b) && !error;
}

Expected<void> make_output_folder(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) return cannot_write(path, "cannot create the folder", error.value());
  if (!fs::is_directory(path, error)) return cannot_write(path, "cannot create the folder", ENOTDIR);
  const std::string probe = temporary_name((fs::path(path) / "probe").string());
  const Descriptor file(::open(probe.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
  if (file.number() < 0) return cannot_write(path, "cannot create files in the folder", errno);
  ::unlink(probe.c_str());
  return {};
}

}  // namespace gnomon
