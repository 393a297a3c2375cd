// A shared library opened at run time: the graphics backends are optional parts of a system, so nothing links
// to them.
#pragma once

#include <span>
#include <string>

#include "scene/base/expected.h"

namespace gnomon::raster {

class DynamicLibrary {
 public:
  /// Opens the first of `names` that the loader finds. Error: one line with the loader's own words for each.
  static Expected<DynamicLibrary> open(std::span<const char* const> names);
  DynamicLibrary(DynamicLibrary&& other) noexcept;
  DynamicLibrary& operator=(DynamicLibrary&& other) noexcept;
  ~DynamicLibrary();

  /// Sets `function` to the symbol; false when the library has none of that name.
  template <class Function>
  bool find(const char* name, Function*& function) const {
    function = reinterpret_cast<Function*>(symbol(name));
    return function != nullptr;
  }

 private:
  explicit DynamicLibrary(void* handle) : handle_(handle) {}
  void* symbol(const char* name) const;
  void* handle_ = nullptr;
};

}  // namespace gnomon::raster
