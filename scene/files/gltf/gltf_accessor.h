// Reading glTF accessors (glTF 2.0, section 3.6.2): any component type, normalized or not, interleaved,
// sparse.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/base/parallel.h"
#include "scene/files/gltf/gltf_model.h"
#include "scene/math.h"

namespace gnomon {

class GltfData;

/// An accessor of a file that parse_gltf has read. Elements that no data stands behind are zero.
class GltfAccessor {
 public:
  GltfAccessor(const gltf::Model& model, const GltfData& data, int accessor);

  std::size_t count() const { return count_; }
  std::size_t components() const { return components_; }

  /// Elements first ... last - 1 into out[(last - first) * components].
  void read(std::size_t first, std::size_t last, double* out) const;

  /// visit(index, values): once for each element, on several threads at a time.
  template <class Visit>
  void for_each(const Visit& visit) const {
    constexpr std::size_t at_a_time = 1024;
    parallel_ranges(count_, at_a_time, [&](std::size_t first, std::size_t last) {
      std::array<double, at_a_time * 16> values;  // the largest element is a matrix of 4 x 4
      for (std::size_t from = first; from < last; from += at_a_time) {
        const std::size_t to = std::min(from + at_a_time, last);
        read(from, to, values.data());
        for (std::size_t i = from; i < to; ++i) visit(i, &values[(i - from) * components_]);
      }
    });
  }

 private:
  /// Elements `stride` bytes apart; `count` of them are whole.
  struct Elements {
    const char* bytes = nullptr;
    std::size_t stride = 0, count = 0;
  };
  Elements elements(std::string_view view, std::size_t offset, std::size_t stride) const;
  void decode(const Elements& from, std::size_t first, std::size_t last, double* out) const;
  void read_sparse(const gltf::Sparse& sparse, const GltfData& data);

  std::size_t count_ = 0, components_ = 0;
  gltf::ComponentType type_ = gltf::float_32;
  bool normalized_ = false;
  Elements plain_, sparse_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>>
      replaced_;  // element, and its place in sparse_; sorted
};

}  // namespace gnomon
