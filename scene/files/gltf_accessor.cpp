#include "scene/files/gltf_accessor.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cstring>

#include "scene/files/gltf_data.h"

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

void convert(int type, const char* bytes, std::size_t stride, std::size_t count, std::size_t components,
             bool normalized, double* out) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return convert<std::int8_t>(bytes, stride, count, components, normalized, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return convert<std::uint8_t>(bytes, stride, count, components, normalized, out);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return convert<std::int16_t>(bytes, stride, count, components, normalized, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return convert<std::uint16_t>(bytes, stride, count, components, normalized, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return convert<std::uint32_t>(bytes, stride, count, components, false, out);
    default:
      return convert<float>(bytes, stride, count, components, false, out);
  }
}

std::size_t size_of(int type) {
  return static_cast<std::size_t>(tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type)));
}

}  // namespace

GltfAccessor::GltfAccessor(const tinygltf::Model& model, const GltfData& data, int accessor) {
  const tinygltf::Accessor& from = model.accessors[static_cast<std::size_t>(accessor)];
  count_ = from.count;
  components_ =
      static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(from.type)));
  component_size_ = size_of(from.componentType);
  type_ = from.componentType;
  normalized_ = from.normalized;
  if (from.bufferView >= 0) {
    const auto view = static_cast<std::size_t>(from.bufferView);
    plain_ = elements(data.view(view), from.byteOffset, model.bufferViews[view].byteStride);
  }
  if (from.sparse.isSparse) read_sparse(model, data, accessor);
}

GltfAccessor::Elements GltfAccessor::elements(std::string_view view, std::size_t offset,
                                              std::size_t stride) const {
  const std::size_t size = component_size_ * components_;
  Elements out{view.data() + std::min(offset, view.size()), std::max(stride, size), 0};
  if (view.size() >= size && view.size() - size >= offset)
    out.count = (view.size() - size - offset) / out.stride + 1;
  return out;
}

void GltfAccessor::read_sparse(const tinygltf::Model& model, const GltfData& data, int accessor) {
  const auto& sparse = model.accessors[static_cast<std::size_t>(accessor)].sparse;
  sparse_ = elements(data.view(static_cast<std::size_t>(sparse.values.bufferView)),
                     static_cast<std::size_t>(sparse.values.byteOffset), 0);
  const std::string_view view = data.view(static_cast<std::size_t>(sparse.indices.bufferView));
  const auto offset = static_cast<std::size_t>(sparse.indices.byteOffset);
  const std::size_t size = size_of(sparse.indices.componentType);
  if (view.size() < offset) return;
  const std::size_t count =
      std::min({static_cast<std::size_t>(sparse.count), sparse_.count, (view.size() - offset) / size});
  for (std::size_t i = 0; i < count; ++i) {
    double target = 0.0;
    convert(sparse.indices.componentType, view.data() + offset + i * size, size, 1, 1, false, &target);
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
