#include "raster/gl/dynamic_library.h"

#include <dlfcn.h>

#include <utility>

namespace gnomon::raster {
namespace {

/// A driver stays loaded: unloading one asks the system's loader for memory, and hangs where there is none. A sanitizer names its
/// leaks only while it is loaded (tests/platforms/leak_sanitizer.supp).
constexpr int open_flags = RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE;

}  // namespace

Expected<DynamicLibrary> DynamicLibrary::open(std::span<const char* const> names) {
  std::string why;
  for (const char* name : names) {
    if (void* handle = dlopen(name, open_flags)) return DynamicLibrary(handle);
    if (!why.empty()) why += "; ";
    why += dlerror();
  }
  return fail(ErrorKind::graphics, why);
}

DynamicLibrary::DynamicLibrary(DynamicLibrary&& other) noexcept
    : handle_(std::exchange(other.handle_, nullptr)) {}

DynamicLibrary& DynamicLibrary::operator=(DynamicLibrary&& other) noexcept {
  std::swap(handle_, other.handle_);
  return *this;
}

DynamicLibrary::~DynamicLibrary() {
  if (handle_ != nullptr) dlclose(handle_);
}

void* DynamicLibrary::symbol(const char* name) const {
  return dlsym(handle_, name);
}

}  // namespace gnomon::raster
