// Between the injector (injector.cpp), which decides what fails, and the calls that it stands before (calls.cpp).
#pragma once

#include <cstddef>

namespace gnomon::faults {

/// What can fail. `descriptor` is every call that makes a file descriptor, wherever the file lies; `large_malloc` are
/// allocations of `large` bytes and more.
constexpr std::size_t large = 65536;
enum Kind {
  write_,
  short_write,
  fsync_,
  close_,
  rename_,
  link_,
  open_,
  mkdir_,
  unlink_,
  truncate_,
  read_,
  short_read,
  list_,
  stat_,
  descriptor,
  mmap_,
  malloc_,
  large_malloc,
  thread_,
  process_,
  pipe_,
  kinds
};

/// Whether this call, made from the address `caller`, is to fail; errno is set then.
bool fails(int kind, const void* caller);
/// Tells whether an allocation of so many bytes is to fail.
bool allocation_fails(std::size_t size, const void* caller);
/// Tells whether a call about a file is to fail: a path seen from an open folder (or AT_FDCWD), or an open file.
bool fails_at(int kind, int folder, const char* path, const void* caller);
bool fails_on(int kind, int file, const void* caller);

}  // namespace gnomon::faults
