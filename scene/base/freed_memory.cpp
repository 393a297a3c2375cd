#include "scene/base/freed_memory.h"

#include <algorithm>
#include <limits>
#include <thread>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace gnomon {

void keep_freed_memory() {
#if defined(__GLIBC__)
  mallopt(M_MMAP_THRESHOLD, std::numeric_limits<int>::max());
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  constexpr unsigned threads_per_arena = 4;
  mallopt(M_ARENA_MAX,
          static_cast<int>(std::max(1U, std::thread::hardware_concurrency() / threads_per_arena)));
#endif
}

void return_freed_memory() {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

}  // namespace gnomon
