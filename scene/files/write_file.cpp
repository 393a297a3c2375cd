#include "scene/files/write_file.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <ctime>
#include <filesystem>
#include <optional>
#include <vector>

#include "scene/base/interrupted.h"
#include "scene/files/folder.h"
#include "scene/files/new_file.h"
#include "scene/files/path_status.h"

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
  Descriptor file(uninterrupted([&] { return ::open(path.c_str(), O_WRONLY | O_CLOEXEC); }));
  if (file.number() < 0) return failed_call(ErrorKind::cannot_write, path, "cannot open it", errno);
  if (const int error = write_all(file.number(), bytes))
    return failed_call(ErrorKind::cannot_write, path, "cannot write", error);
  if (!file.close()) return failed_call(ErrorKind::cannot_write, path, "cannot close it", errno);
  return {};
}

/// `path`: the file's name in messages.
Expected<void> keep_permissions(const NewFile& file, mode_t older, const std::string& path) {
  if (::fchmod(file.descriptor(), older & 07777) == 0) return {};
  return failed_call(ErrorKind::cannot_write, path, "cannot keep its permissions", errno);
}

Expected<void> replace_file(Folder folder, const std::string& name, std::string_view bytes,
                            std::optional<mode_t> older, const std::string& path) {
  const auto named = [&path](Error error) {
    error.file = path;
    return fail(std::move(error));
  };
  auto file = NewFile::make(std::move(folder), name, NewFile::Name::temporary);
  if (!file) return named(file.error());
  if (older)
    if (auto kept = keep_permissions(*file, *older, path); !kept) return kept;
  if (const int error = write_all(file->descriptor(), bytes))
    return failed_call(ErrorKind::cannot_write, path, "cannot write", error);
  if (auto flushed = file->flush(); !flushed) return named(flushed.error());
  if (auto there = file->publish(); !there) return named(there.error());
  return {};
}

/// Makes a folder and those above it that are missing, and adds those that it made to `made`.
Expected<void> make_folders(const std::string& path, std::vector<std::string>& made) {
  const auto there = is_there(path, ErrorKind::cannot_write);
  if (!there) return fail(there.error());
  if (*there || path.empty()) return {};
  const fs::path folder(path);
  if (folder.has_relative_path() && folder.parent_path() != folder)
    if (auto above = make_folders(folder.parent_path().string(), made); !above) return above;
  if (!folder.has_filename()) return {};  // "a/", after "a"
  if (::mkdir(path.c_str(), 0777) == 0)
    made.push_back(path);
  else if (errno != EEXIST)
    return failed_call(ErrorKind::cannot_write, path, "cannot create the folder", errno);
  struct stat status = {};
  if (::stat(path.c_str(), &status) != 0)
    return failed_call(ErrorKind::cannot_write, path, "cannot be looked at", errno);
  return made.empty() ? Expected<void>{} : check_umask_leaves(0700, status.st_mode, path);
}

}  // namespace

// A symbolic link stays a link: what it points to is replaced. One that leads nowhere is replaced itself.
Expected<std::string> follow_link(const std::string& path) {
  const auto there = is_there(path, ErrorKind::cannot_write);
  if (!there) return fail(there.error());
  if (!*there) return path;
  constexpr int most_links = 40;  // as the system has it
  std::string at = path;
  for (int links = 0; links <= most_links; ++links) {
    const std::string around = fs::path(at).parent_path().string(), name = fs::path(at).filename().string();
    if (name.empty() || name == "." || name == "..") return at;  // a folder
    const auto folder = Folder::at(around);
    if (!folder) return fail(folder.error());
    if (auto fine = refuse_planted(*folder, name); !fine) return fail(fine.error());
    const auto target = folder->link_target(name);
    if (!target) return fail(target.error());
    if (!*target) return at;
    at = (fs::path(around) / **target).string();
  }
  return failed_call(ErrorKind::cannot_write, path, "cannot follow it", ELOOP);
}

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
  auto folder = Folder::at(fs::path(target).parent_path().string());
  if (!folder) return fail(folder.error());
  return replace_file(std::move(*folder), last_part(target), bytes, old_mode, path);
}

Expected<void> write_file_in(const std::string& folder, const std::string& name, std::string_view bytes) {
  const FileSizeSignalBlock block;
  const auto opened = Folder::at(folder);
  if (!opened) return fail(opened.error());
  auto place = opened->below(folder_part(name));
  if (!place) return fail(place.error());
  const auto there = place->find(last_part(name));
  if (!there) return fail(there.error());
  std::optional<mode_t> old_mode;
  if (*there && S_ISDIR((*there)->st_mode))
    return failed_call(ErrorKind::cannot_write, opened->path_of(name), "it is a folder", EISDIR);
  if (*there && S_ISREG((*there)->st_mode)) old_mode = (*there)->st_mode;
  return replace_file(std::move(*place), last_part(name), bytes, old_mode, opened->path_of(name));
}

Expected<void> make_output_subfolder(const std::string& folder, const std::string& name) {
  const auto opened = Folder::at(folder);
  if (!opened) return fail(opened.error());
  if (auto made = make_folder_in(*opened, name); !made) return fail(made.error());
  const auto inside = opened->below(name);
  if (!inside) return fail(inside.error());
  const auto takes = try_new_file(*inside);
  return takes ? Expected<void>{} : fail(takes.error());
}

Expected<PartFile> PartFile::create(const std::string& path) {
  auto target = follow_link(path);
  if (!target) return fail(target.error());
  struct stat status {};
  if (::stat(target->c_str(), &status) == 0 && !S_ISREG(status.st_mode))
    return failed_call(ErrorKind::cannot_write, path, "a picture made in bands needs a plain file", EINVAL);
  auto folder = Folder::at(fs::path(*target).parent_path().string());
  if (!folder) return fail(folder.error());
  auto file = NewFile::make(std::move(*folder), last_part(*target), NewFile::Name::none_if_possible);
  if (!file) return fail(file.error());
  return PartFile(std::move(*target), std::move(*file));
}

Expected<void> PartFile::append(std::string_view bytes) {
  return write_from(SEEK_END, bytes);
}

Expected<void> PartFile::write_over_begin(std::string_view bytes) {
  return write_from(SEEK_SET, bytes);
}

Expected<void> PartFile::write_from(int whence, std::string_view bytes) {
  const FileSizeSignalBlock block;
  if (::lseek(file_.descriptor(), 0, whence) < 0)
    return failed_call(ErrorKind::cannot_write, target_, "cannot write", errno);
  if (const int error = write_all(file_.descriptor(), bytes))
    return failed_call(ErrorKind::cannot_write, target_, "cannot write", error);
  return {};
}

Expected<void> PartFile::finish() {
  struct stat old {};
  if (::stat(target_.c_str(), &old) == 0)
    if (auto kept = keep_permissions(file_, old.st_mode, target_); !kept) return kept;
  return file_.flush();
}

Expected<void> PartFile::publish() {
  if (auto finished = finish(); !finished) return finished;
  return file_.publish();
}

Expected<void> PartFile::publish_at(const std::string& place) {
  if (auto finished = finish(); !finished) return finished;
  const auto folder = Folder::at(folder_part(place));
  if (!folder) return fail(folder.error());
  return file_.publish(*folder, last_part(place));
}

Expected<void> write_over_end(const std::string& path, std::string_view end) {
  Descriptor file(uninterrupted([&] { return ::open(path.c_str(), O_WRONLY | O_CLOEXEC); }));
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

Expected<void> make_output_folder(const std::string& path, std::vector<std::string>* made) {
  std::vector<std::string> own;
  auto fine = make_folders(path, own);
  if (fine) fine = check_takes_files(path);
  if (!fine)
    for (auto folder = own.rbegin(); folder != own.rend(); ++folder) ::rmdir(folder->c_str());
  else if (made != nullptr)
    made->insert(made->end(), own.begin(), own.end());
  return fine;
}

Expected<void> make_folder_for(const std::string& path) {
  const std::string folder = fs::path(path).parent_path().string();
  return folder.empty() ? Expected<void>{} : make_output_folder(folder);
}

Expected<void> check_takes_files(const std::string& folder) {
  const auto there = is_folder(folder, ErrorKind::cannot_write);
  if (!there) return fail(there.error());
  if (!*there) return failed_call(ErrorKind::cannot_write, folder, "cannot write here", ENOTDIR);
  const auto opened = Folder::at(folder);
  if (!opened) return fail(opened.error());
  const auto taken = try_new_file(*opened);
  return taken ? Expected<void>{} : fail(taken.error());
}

}  // namespace gnomon
