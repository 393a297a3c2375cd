// Freed memory is there for the next one who asks. What the system has to give costs page faults, which the kernel counts.
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "scene/base/freed_memory.h"
#include "tests/support/places.h"

#if defined(__GLIBC__)
#include <sys/resource.h>

namespace gnomon {
namespace {

long page_faults() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return used.ru_minflt;
}

/// Takes, writes and frees blocks of a size that does not fit into a thread's own arena: 160 of the largest pages.
void use_blocks() {
  std::vector<std::vector<char>> blocks(4);
  for (std::vector<char>& block : blocks) block.assign(std::size_t{80} << 20, 'a');
}

/// Allows for faults of a thread's stack and the like.
constexpr long few_faults = 40;

class FreedMemory : public testing::Test {
 protected:
  void SetUp() override {
    if (test::address_sanitizer) GTEST_SKIP() << "the sanitizer has an allocator of its own";
    keep_freed_memory();
  }
};

TEST_F(FreedMemory, IsTakenByTheSameThread) {
  use_blocks();
  const long first = page_faults();
  use_blocks();
  EXPECT_LT(page_faults() - first, few_faults);
}

TEST_F(FreedMemory, IsTakenByAnotherThread) {
  if (std::thread::hardware_concurrency() >= 8) GTEST_SKIP() << "so many threads have more than one arena";
  use_blocks();
  const long first = page_faults();
  std::thread(use_blocks).join();
  EXPECT_LT(page_faults() - first, few_faults);
}

}  // namespace
}  // namespace gnomon
#endif
