#include "scene/files/mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "scene/base/interrupted.h"
#include "scene/files/read_file.h"

namespace gnomon {
namespace {

constexpr std::int64_t worth_mapping = 1 << 16;  // bytes

/// Nothing where the file is small, is no plain file, or cannot be mapped: then it is read.
const char* map(const std::string& path, std::size_t& size) {
  const int file = uninterrupted(  // a pipe must not make us wait
      [&] { return ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK); });
  if (file < 0) return nullptr;
  struct stat status {};
  void* bytes = MAP_FAILED;
  if (fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_size >= worth_mapping) {
    size = static_cast<std::size_t>(status.st_size);
    bytes = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file, 0);
  }
  close(file);
  if (bytes == MAP_FAILED) return nullptr;
  madvise(bytes, size, MADV_WILLNEED);
  return static_cast<const char*>(bytes);
}

}  // namespace

Expected<MappedFile> MappedFile::open(const std::string& path) {
  MappedFile out;
  out.mapped_ = map(path, out.size_);
  if (out.mapped_ != nullptr) return out;
  auto bytes = read_file(path);
  if (!bytes) return fail(std::move(bytes.error()));
  out.read_ = std::move(*bytes);
  return out;
}

MappedFile::~MappedFile() {
  if (mapped_ != nullptr) munmap(const_cast<char*>(mapped_), size_);
}

}  // namespace gnomon
