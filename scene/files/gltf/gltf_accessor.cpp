#include "scene/files/gltf/gltf_accessor.h"

#include <algorithm>
#include <cstring>

#include "scene/files/gltf/gltf_data.h"

namespace gnomon {
namespace {

// glTF 2.0, section 3.6.2.2: what a normalized component is divided by.
template <class Value>
constexpr double largest() {
  if constexpr (std::is_same_v<Value, float> || sizeof(Value) == 4) return 1.0;
  return static_cast<double>(std::numeric_limits<Value>::max());
}

template <class Value>
void convert(const char* bytes, std::size_t stride, std::size_t count, std::size_t components,
             bool normalized, double* out) {
  const double divisor = normalized ? largest<Value>() : 1.0;
  for (std::size_t i = 0; i < count; ++i, bytes += stride)
    for (std::size_t c = 0; c < components; ++c) {
      Value value;
      std::memcpy(&value, bytes + c * sizeof(Value), sizeof(Value));
      double number = static_cast<double>(value);
      if (normalized) number = std::max(number / divisor, -1.0);
      *out++ = number;
    }
}

void convert(gltf::ComponentType type, const char* bytes, std::size_t stride, std::size_t count,
             std::size_t components, bool normalized, double* out) {
  switch (type) {
    case gltf::signed_byte:
      return convert<std::int8_t>(bytes, stride, count, components, normalized, out);
    case gltf::unsigned_byte:
      return convert<std::uint8_t>(bytes, stride, count, components, normalized, out);
    case gltf::signed_short:
      return convert<std::int16_t>(bytes, stride, count, components, normalized, out);
    case gltf::unsigned_short:
      return convert<std::uint16_t>(bytes, stride, count, components, normalized, out);
    case gltf::unsigned_int:
      return convert<std::uint32_t>(bytes, stride, count, components, false, out);
    default:
      return convert<float>(bytes, stride, count, components, false, out);
  }
}

}  // namespace

GltfAccessor::GltfAccessor(const gltf::Model& model, const GltfData& data, int accessor) {
  const gltf::Accessor& from = model.accessors[static_cast<std::size_t>(accessor)];
  count_ = from.count;
  components_ = gltf::components_of(from.type);
  type_ = from.component;
  normalized_ = from.normalized;
  if (from.view >= 0) {
    const auto view = static_cast<std::size_t>(from.view);
    plain_ = elements(data.view(view), from.offset, data.stride(view));
  }
  if (from.sparse) read_sparse(*from.sparse, data);
}

GltfAccessor::Elements GltfAccessor::elements(std::string_view view, std::size_t offset,
                                              std::size_t stride) const {
  const std::size_t size = gltf::bytes_of(type_) * components_;
  Elements out{view.data() + std::min(offset, view.size()), std::max(stride, size), 0};
  if (view.size() >= size && view.size() - size >= offset)
    out.count = (view.size() - size - offset) / out.stride + 1;
  return out;
}

void GltfAccessor::read_sparse(const gltf::Sparse& sparse, const GltfData& data) {
  sparse_ = elements(data.view(sparse.values.view), sparse.values.offset, 0);
  const std::string_view view = data.view(sparse.indices.view);
  const std::size_t offset = sparse.indices.offset, size = gltf::bytes_of(sparse.index_type);
  if (view.size() < offset) return;
  const std::size_t count = std::min({sparse.count, sparse_.count, (view.size() - offset) / size});
  for (std::size_t i = 0; i < count; ++i) {
    double target = 0.0;
    convert(sparse.index_type, view.data() + offset + i * size, size, 1, 1, false, &target);
    if (target < static_cast<double>(count_))
      replaced_.emplace_back(static_cast<std::uint32_t>(target), static_cast<std::uint32_t>(i));
  }
  std::sort(replaced_.begin(), replaced_.end());
}

void GltfAccessor::decode(const Elements& from, std::size_t first, std::size_t last, double* out) const {
  const std::size_t end = std::min(last, std::max(first, from.count));
  convert(type_, from.bytes + first * from.stride, from.stride, end - first, components_, normalized_, out);
  std::fill(out + (end - first) * components_, out + (last - first) * components_, 0.0);
}

void GltfAccessor::read(std::size_t first, std::size_t last, double* out) const {
  if (first < plain_.count)
    decode(plain_, first, last, out);
  else
    std::fill(out, out + (last - first) * components_, 0.0);
  const auto at =
      std::lower_bound(replaced_.begin(), replaced_.end(),
                       std::pair<std::uint32_t, std::uint32_t>(static_cast<std::uint32_t>(first), 0));
  for (auto i = at; i != replaced_.end() && i->first < last; ++i)
    decode(sparse_, i->second, i->second + std::size_t{1}, out + (i->first - first) * components_);
}

}  // namespace gnomon
