#include "raytrace/huge_array.h"

#include <cstdlib>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace gnomon::raytrace {

void* allocate_huge(std::size_t bytes) {
  constexpr std::size_t page = std::size_t{1} << 21, line = 64;
  const bool large = bytes >= 2 * page;
  const std::size_t unit = large ? page : line, size = (bytes + unit - 1) / unit * unit;
  void* data = std::aligned_alloc(unit, size);
  if (data == nullptr) throw std::bad_alloc();
#if defined(__linux__)
  if (large) madvise(data, size, MADV_HUGEPAGE);  // advice: nothing is lost without
#endif
  return data;
}

void free_huge(void* data) {
  std::free(data);
}

}  // namespace gnomon::raytrace
