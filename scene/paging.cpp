#include "scene/paging.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>

#if defined(__linux__)
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace gnomon {

void page_in([[maybe_unused]] void* data, [[maybe_unused]] std::size_t bytes) {
#if defined(MADV_POPULATE_WRITE)
  constexpr std::size_t share = std::size_t{4} << 20;
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const auto address = reinterpret_cast<std::uintptr_t>(data);
  const std::size_t before = (page - address % page) % page;  // whole pages of it alone
  if (bytes < before + 2 * share) return;
  const std::size_t whole = (bytes - before) / page * page;
  tbb::parallel_for(std::size_t{0}, (whole + share - 1) / share, [&](std::size_t i) {
    char* first = static_cast<char*>(data) + before + i * share;
    madvise(first, std::min(share, whole - i * share), MADV_POPULATE_WRITE);  // an error is no loss
  });
#endif
}

}  // namespace gnomon
