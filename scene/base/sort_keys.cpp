#include <hwy/contrib/sort/vqsort.h>

#include "scene/base/parallel.h"

namespace gnomon {

void sort_numbers(std::span<std::uint64_t> values) {
  const hwy::Sorter sort;
  sort(values.data(), values.size(), hwy::SortAscending());
}

}  // namespace gnomon
