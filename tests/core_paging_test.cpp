// Memory that is paged in beforehand holds what memory always holds.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "scene/paging.h"

namespace gnomon {
namespace {

TEST(Paging, AnImageIsThatOfItsConstructor) {
  for (const ImageSize size : {ImageSize{0, 0}, {3, 5}, {1920, 1200}}) {
    const Image<Vec3f> paged = paged_image<Vec3f>(size), plain(size);
    EXPECT_EQ(paged.size, plain.size);
    EXPECT_EQ(paged.data, plain.data);
  }
}

TEST(Paging, NothingIsChangedAnywhere) {
  std::vector<std::uint32_t> numbers(5'000'000);
  std::iota(numbers.begin(), numbers.end(), 0u);
  for (const std::size_t skipped : {std::size_t{0}, std::size_t{1}, std::size_t{1025}})
    page_in(numbers.data() + skipped, (numbers.size() - 2 * skipped) * sizeof numbers[0]);
  std::uint32_t expected = 0;
  EXPECT_TRUE(std::all_of(numbers.begin(), numbers.end(), [&](std::uint32_t n) { return n == expected++; }));
  page_in(nullptr, 0);
}

}  // namespace
}  // namespace gnomon
