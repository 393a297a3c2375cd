// The calls of the C library that the injector stands before. Each asks it first, and then does what it always did.
#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <new>

#include "tests/faults/injector.h"

using namespace gnomon::faults;

#define CALLER __builtin_return_address(0)
#define NEXT(name) auto* const next = reinterpret_cast<decltype(&name)>(Next<#name>::found())

namespace {

template <std::size_t size>
struct Name {
  constexpr Name(const char (&from)[size]) { std::copy_n(from, size, text); }
  char text[size];
};

/// The call of that name that this one stands before, found while the library starts: dlsym() waits for whoever loads or unloads
/// another, who may wait for a thread that makes its first call (a driver that is unloaded, for what it writes into its cache).
template <Name name>
struct Next {
  static void* found() {
    static_cast<void>(&early);
    if (kept == nullptr) kept = dlsym(RTLD_NEXT, name.text);
    return kept;
  }
  static inline std::atomic<void*> kept;
  static inline void* const early = found();
};

bool opening_fails(int folder, const char* path, const void* caller) {
  return fails_at(open_, folder, path, caller) || fails_at(descriptor, folder, path, caller);
}

bool reading_fails(int file, const void* caller) {
  return fails_on(read_, file, caller);
}

/// Half of the bytes where a shorter answer is asked for.
std::size_t shortened(int kind, int file, std::size_t size, const void* caller) {
  return size > 1 && fails_on(kind, file, caller) ? size / 2 : size;
}

constexpr int error_seen = 0x20;  // _IO_ERR_SEEN of glibc's <stdio.h>: what ferror() tells

bool stream_fails(FILE* file, const void* caller) {
  if (!fails_on(write_, fileno(file), caller)) return false;
  file->_flags |= error_seen;
  return true;
}

}  // namespace

extern "C" {

// -- Files: their bytes.

ssize_t write(int file, const void* bytes, size_t size) {
  NEXT(write);
  if (fails_on(write_, file, CALLER)) return -1;
  return next(file, bytes, shortened(short_write, file, size, CALLER));
}
ssize_t pwrite(int file, const void* bytes, size_t size, off_t at) {
  NEXT(pwrite);
  if (fails_on(write_, file, CALLER)) return -1;
  return next(file, bytes, shortened(short_write, file, size, CALLER), at);
}
ssize_t pwrite64(int file, const void* bytes, size_t size, off64_t at) {
  NEXT(pwrite64);
  if (fails_on(write_, file, CALLER)) return -1;
  return next(file, bytes, shortened(short_write, file, size, CALLER), at);
}
ssize_t writev(int file, const iovec* parts, int count) {
  NEXT(writev);
  return fails_on(write_, file, CALLER) ? -1 : next(file, parts, count);
}
size_t fwrite(const void* bytes, size_t size, size_t count, FILE* file) {
  NEXT(fwrite);
  return stream_fails(file, CALLER) ? 0 : next(bytes, size, count, file);
}
int fputs(const char* text, FILE* file) {
  NEXT(fputs);
  return stream_fails(file, CALLER) ? EOF : next(text, file);
}
int fflush(FILE* file) {
  NEXT(fflush);
  return file != nullptr && stream_fails(file, CALLER) ? EOF : next(file);
}
ssize_t read(int file, void* bytes, size_t size) {
  NEXT(read);
  if (reading_fails(file, CALLER)) return -1;
  return next(file, bytes, shortened(short_read, file, size, CALLER));
}
ssize_t pread(int file, void* bytes, size_t size, off_t at) {
  NEXT(pread);
  if (reading_fails(file, CALLER)) return -1;
  return next(file, bytes, shortened(short_read, file, size, CALLER), at);
}
ssize_t pread64(int file, void* bytes, size_t size, off64_t at) {
  NEXT(pread64);
  if (reading_fails(file, CALLER)) return -1;
  return next(file, bytes, shortened(short_read, file, size, CALLER), at);
}
size_t fread(void* bytes, size_t size, size_t count, FILE* file) {
  NEXT(fread);
  if (reading_fails(fileno(file), CALLER)) {
    file->_flags |= error_seen;
    return 0;
  }
  return next(bytes, size, count, file);
}
int fsync(int file) {
  NEXT(fsync);
  return fails_on(fsync_, file, CALLER) ? -1 : next(file);
}
int fdatasync(int file) {
  NEXT(fdatasync);
  return fails_on(fsync_, file, CALLER) ? -1 : next(file);
}
int ftruncate(int file, off_t size) {
  NEXT(ftruncate);
  return fails_on(truncate_, file, CALLER) ? -1 : next(file, size);
}
int ftruncate64(int file, off64_t size) {
  NEXT(ftruncate64);
  return fails_on(truncate_, file, CALLER) ? -1 : next(file, size);
}
int fallocate(int file, int mode, off_t at, off_t size) {
  NEXT(fallocate);
  return fails_on(truncate_, file, CALLER) ? -1 : next(file, mode, at, size);
}
int posix_fallocate(int file, off_t at, off_t size) {
  NEXT(posix_fallocate);
  return fails_on(truncate_, file, CALLER) ? errno : next(file, at, size);
}

// A descriptor is gone, whatever closing it answers.
int close(int file) {
  NEXT(close);
  const bool failing = fails_on(close_, file, CALLER);
  const int error = errno, result = next(file);
  if (failing) errno = error;
  return failing ? -1 : result;
}
int fclose(FILE* file) {
  NEXT(fclose);
  const bool failing = fails_on(close_, fileno(file), CALLER);
  const int error = errno, result = next(file);
  if (failing) errno = error;
  return failing ? EOF : result;
}

// -- Files: opened and listed.

int open(const char* path, int flags, ...) {
  NEXT(open);
  va_list more;
  va_start(more, flags);
  const mode_t mode = va_arg(more, mode_t);
  va_end(more);
  return opening_fails(AT_FDCWD, path, CALLER) ? -1 : next(path, flags, mode);
}
int open64(const char* path, int flags, ...) {
  NEXT(open64);
  va_list more;
  va_start(more, flags);
  const mode_t mode = va_arg(more, mode_t);
  va_end(more);
  return opening_fails(AT_FDCWD, path, CALLER) ? -1 : next(path, flags, mode);
}
int openat(int folder, const char* path, int flags, ...) {
  NEXT(openat);
  va_list more;
  va_start(more, flags);
  const mode_t mode = va_arg(more, mode_t);
  va_end(more);
  return opening_fails(folder, path, CALLER) ? -1 : next(folder, path, flags, mode);
}
FILE* fopen(const char* path, const char* mode) {
  NEXT(fopen);
  return opening_fails(AT_FDCWD, path, CALLER) ? nullptr : next(path, mode);
}
FILE* fopen64(const char* path, const char* mode) {
  NEXT(fopen64);
  return opening_fails(AT_FDCWD, path, CALLER) ? nullptr : next(path, mode);
}
int mkstemp(char* path) {
  NEXT(mkstemp);
  return opening_fails(AT_FDCWD, path, CALLER) ? -1 : next(path);
}
DIR* opendir(const char* path) {
  NEXT(opendir);
  const bool failing =
      fails_at(list_, AT_FDCWD, path, CALLER) || fails_at(descriptor, AT_FDCWD, path, CALLER);
  return failing ? nullptr : next(path);
}
DIR* fdopendir(int folder) {
  NEXT(fdopendir);
  return fails_on(list_, folder, CALLER) ? nullptr : next(folder);
}
dirent* readdir(DIR* folder) {
  NEXT(readdir);
  return fails_on(list_, dirfd(folder), CALLER) ? nullptr : next(folder);
}
dirent64* readdir64(DIR* folder) {
  NEXT(readdir64);
  return fails_on(list_, dirfd(folder), CALLER) ? nullptr : next(folder);
}

// -- Files: what is known of them.

int stat(const char* path, struct stat* into) {
  NEXT(stat);
  return fails_at(stat_, AT_FDCWD, path, CALLER) ? -1 : next(path, into);
}
int lstat(const char* path, struct stat* into) {
  NEXT(lstat);
  return fails_at(stat_, AT_FDCWD, path, CALLER) ? -1 : next(path, into);
}
int fstat(int file, struct stat* into) {
  NEXT(fstat);
  return fails_on(stat_, file, CALLER) ? -1 : next(file, into);
}
int fstat64(int file, struct stat64* into) {
  NEXT(fstat64);
  return fails_on(stat_, file, CALLER) ? -1 : next(file, into);
}
int fstatat(int folder, const char* path, struct stat* into, int flags) {
  NEXT(fstatat);
  return fails_at(stat_, folder, path, CALLER) ? -1 : next(folder, path, into, flags);
}

// -- Files: their names.

int rename(const char* from, const char* to) {
  NEXT(rename);
  return fails_at(rename_, AT_FDCWD, to, CALLER) ? -1 : next(from, to);
}
int renameat(int from_folder, const char* from, int folder, const char* to) {
  NEXT(renameat);
  return fails_at(rename_, folder, to, CALLER) ? -1 : next(from_folder, from, folder, to);
}
int renameat2(int from_folder, const char* from, int folder, const char* to, unsigned flags) {
  NEXT(renameat2);
  return fails_at(rename_, folder, to, CALLER) ? -1 : next(from_folder, from, folder, to, flags);
}
int link(const char* from, const char* to) {
  NEXT(link);
  return fails_at(link_, AT_FDCWD, to, CALLER) ? -1 : next(from, to);
}
int linkat(int from_folder, const char* from, int folder, const char* to, int flags) {
  NEXT(linkat);
  return fails_at(link_, folder, to, CALLER) ? -1 : next(from_folder, from, folder, to, flags);
}
int symlink(const char* from, const char* to) {
  NEXT(symlink);
  return fails_at(link_, AT_FDCWD, to, CALLER) ? -1 : next(from, to);
}
int mkdir(const char* path, mode_t mode) {
  NEXT(mkdir);
  return fails_at(mkdir_, AT_FDCWD, path, CALLER) ? -1 : next(path, mode);
}
int mkdirat(int folder, const char* path, mode_t mode) {
  NEXT(mkdirat);
  return fails_at(mkdir_, folder, path, CALLER) ? -1 : next(folder, path, mode);
}
char* mkdtemp(char* path) {
  NEXT(mkdtemp);
  return fails_at(mkdir_, AT_FDCWD, path, CALLER) ? nullptr : next(path);
}
int unlink(const char* path) {
  NEXT(unlink);
  return fails_at(unlink_, AT_FDCWD, path, CALLER) ? -1 : next(path);
}
int unlinkat(int folder, const char* path, int flags) {
  NEXT(unlinkat);
  return fails_at(unlink_, folder, path, CALLER) ? -1 : next(folder, path, flags);
}
int rmdir(const char* path) {
  NEXT(rmdir);
  return fails_at(unlink_, AT_FDCWD, path, CALLER) ? -1 : next(path);
}
int remove(const char* path) {
  NEXT(remove);
  return fails_at(unlink_, AT_FDCWD, path, CALLER) ? -1 : next(path);
}

// -- Memory, threads, processes.

void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
void* __libc_memalign(size_t, size_t);

void* malloc(size_t size) {
  return allocation_fails(size, CALLER) ? nullptr : __libc_malloc(size);
}
void* calloc(size_t count, size_t size) {
  return allocation_fails(count * size, CALLER) ? nullptr : __libc_calloc(count, size);
}
void* realloc(void* old, size_t size) {
  return allocation_fails(size, CALLER) ? nullptr : __libc_realloc(old, size);
}
void* aligned_alloc(size_t alignment, size_t size) {
  return allocation_fails(size, CALLER) ? nullptr : __libc_memalign(alignment, size);
}
void* memalign(size_t alignment, size_t size) {
  return allocation_fails(size, CALLER) ? nullptr : __libc_memalign(alignment, size);
}
int posix_memalign(void** into, size_t alignment, size_t size) {
  if (allocation_fails(size, CALLER)) return ENOMEM;
  *into = __libc_memalign(alignment, size);
  return *into == nullptr ? ENOMEM : 0;
}
void* mmap(void* address, size_t size, int protection, int flags, int file, off_t at) {
  NEXT(mmap);
  return fails(mmap_, CALLER) ? MAP_FAILED : next(address, size, protection, flags, file, at);
}
void* mmap64(void* address, size_t size, int protection, int flags, int file, off64_t at) {
  NEXT(mmap64);
  return fails(mmap_, CALLER) ? MAP_FAILED : next(address, size, protection, flags, file, at);
}
int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*run)(void*), void* with) {
  NEXT(pthread_create);
  return fails(thread_, CALLER) ? errno : next(thread, attributes, run, with);
}
pid_t fork() {
  NEXT(fork);
  return fails(process_, CALLER) ? -1 : next();
}
int posix_spawn(pid_t* child, const char* path, const posix_spawn_file_actions_t* actions,
                const posix_spawnattr_t* attributes, char* const* arguments, char* const* environment) {
  NEXT(posix_spawn);
  return fails(process_, CALLER) ? errno : next(child, path, actions, attributes, arguments, environment);
}
int posix_spawnp(pid_t* child, const char* path, const posix_spawn_file_actions_t* actions,
                 const posix_spawnattr_t* attributes, char* const* arguments, char* const* environment) {
  NEXT(posix_spawnp);
  return fails(process_, CALLER) ? errno : next(child, path, actions, attributes, arguments, environment);
}
int pipe(int* ends) {
  NEXT(pipe);
  return fails(pipe_, CALLER) ? -1 : next(ends);
}
int pipe2(int* ends, int flags) {
  NEXT(pipe2);
  return fails(pipe_, CALLER) ? -1 : next(ends, flags);
}

}  // extern "C"

// Those of the C++ library would be its own calls of malloc().
namespace {

void* allocated(std::size_t size, std::size_t alignment, const void* caller) {
  if (allocation_fails(size, caller)) return nullptr;
  return alignment == 0 ? __libc_malloc(size == 0 ? 1 : size) : __libc_memalign(alignment, size);
}

void* or_throw(void* memory) {
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t size) {
  return or_throw(allocated(size, 0, CALLER));
}
void* operator new[](std::size_t size) {
  return or_throw(allocated(size, 0, CALLER));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return allocated(size, 0, CALLER);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
  return allocated(size, 0, CALLER);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return or_throw(allocated(size, static_cast<std::size_t>(alignment), CALLER));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return or_throw(allocated(size, static_cast<std::size_t>(alignment), CALLER));
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
