// Memory that is to be filled at once, paged in by all threads: the pages of a large array are otherwise
// cleared one by one, by the one thread that first writes to it, which takes longer than many a pass over a
// picture does.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "scene/image.h"

namespace gnomon {

/// Pages in what is writable memory of this process. Where the system cannot, nothing is lost but time.
void page_in(void* data, std::size_t bytes);

template <class T>
std::vector<T> paged_vector(std::size_t count) {
  std::vector<T> out;
  out.reserve(count);
  page_in(out.data(), count * sizeof(T));
  out.resize(count);
  return out;
}

/// Appends the value so many times.
template <class T>
void extend_paged(std::vector<T>& values, std::size_t count, const T& value = {}) {
  const std::size_t before = values.size();
  if (values.capacity() < before + count) values.reserve(std::max(before + count, 2 * before));
  page_in(values.data() + before, count * sizeof(T));
  values.resize(before + count, value);
}

/// Filled with Pixel{}.
template <class Pixel>
Image<Pixel> paged_image(const ImageSize& size) {
  Image<Pixel> out;
  out.size = size, out.data = paged_vector<Pixel>(size.pixels());
  return out;
}

}  // namespace gnomon
