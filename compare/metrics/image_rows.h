// Rows of images that come part by part from the top: put under those that are there, and dropped when they have been used.
#pragma once

#include "scene/image.h"

namespace gnomon::compare {

/// Rows that a window keeps beyond those that it needs, so that the others need not be moved for every one.
inline constexpr int most_spare_rows = 256;

/// Puts rows under those that are there. `kept`: how many are there at most.
template <class T>
void append_rows(Image<T>& rows, const Image<T>& more, int kept) {
  rows.data.reserve(ImageSize{more.size.width, kept + more.size.height}.pixels());
  rows.size = {more.size.width, rows.size.height + more.size.height};
  rows.data.insert(rows.data.end(), more.data.begin(), more.data.end());
}

template <class T>
void drop_rows(Image<T>& rows, int count) {
  if (rows.data.empty()) return;
  rows.data.erase(rows.data.begin(), rows.data.begin() + static_cast<std::ptrdiff_t>(rows.index(0, count)));
  rows.size.height -= count;
}

/// Returns the wanted rows alone.
template <class T>
Image<T> cut_rows(Image<T>&& rows, const PictureRows& wanted) {
  if (rows.data.empty() || wanted == PictureRows{0, rows.size.height}) return std::move(rows);
  Image<T> out;
  out.size = {rows.size.width, wanted.count};
  const auto first = rows.data.begin() + static_cast<std::ptrdiff_t>(rows.index(0, wanted.first));
  out.data.assign(first, first + static_cast<std::ptrdiff_t>(out.size.pixels()));
  return out;
}

}  // namespace gnomon::compare
