#include "scene/files/row_file.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <stdlib.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "scene/base/interrupted.h"
#include "scene/files/path_status.h"

namespace gnomon {
namespace {

tl::unexpected<Error> trouble(const std::string& folder, std::string_view step, int error_number) {
  return failed_call(ErrorKind::cannot_write, folder, fmt::format("rows of a large picture: {}", step),
                     error_number);
}

}  // namespace

Expected<RowFile> RowFile::open(const std::string& folder) {
  std::filesystem::path place = std::filesystem::absolute(folder.empty() ? "." : folder);
  for (;;) {
    const auto there = is_folder(place.string(), ErrorKind::cannot_write);
    if (!there) return fail(there.error());
    if (*there || !place.has_relative_path()) break;
    place = place.parent_path();
  }
  RowFile file;
  file.folder_ = place.string();
  file.descriptor_ =
      uninterrupted([&] { return ::open(file.folder_.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600); });
  if (file.descriptor_ >= 0) return file;
  std::string name = file.folder_ + "/gnomon-rows-XXXXXX";  // the file system has no files without a name
  file.descriptor_ = uninterrupted([&] { return ::mkostemp(name.data(), O_CLOEXEC); });
  if (file.descriptor_ < 0) return trouble(file.folder_, "cannot create a file", errno);
  ::unlink(name.c_str());
  return file;
}

RowFile& RowFile::operator=(RowFile&& other) noexcept {
  if (descriptor_ >= 0) ::close(descriptor_);
  folder_ = std::move(other.folder_);
  bytes_ = other.bytes_;
  descriptor_ = other.release();
  return *this;
}

RowFile::~RowFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

int RowFile::release() {
  bytes_ = 0;
  return std::exchange(descriptor_, -1);
}

Expected<void> RowFile::append_bytes(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(bytes_));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return trouble(folder_, "cannot write", errno);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
    bytes_ += static_cast<std::uint64_t>(written);
  }
  return {};
}

Expected<void> RowFile::read_bytes(std::uint64_t offset, std::span<std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t got = ::pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return trouble(folder_, "cannot read", got < 0 ? errno : EIO);
    bytes = bytes.subspan(static_cast<std::size_t>(got));
    offset += static_cast<std::uint64_t>(got);
  }
  return {};
}

}  // namespace gnomon
