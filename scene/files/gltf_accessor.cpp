#include "scene/files/gltf_accessor.h"

#include <tiny_gltf.h>

#include <cstring>

namespace gnomon {
namespace {

template <class Value>
double raw(const unsigned char* bytes) {
  Value value;
  std::memcpy(&value, bytes, sizeof(Value));
  return static_cast<double>(value);
}

// glTF 2.0, section 3.6.2.2 for the normalized ones.
double component(int type, bool normalized, const unsigned char* bytes) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return normalized ? std::max(raw<std::int8_t>(bytes) / 127.0, -1.0) : raw<std::int8_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return raw<std::uint8_t>(bytes) / (normalized ? 255.0 : 1.0);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return normalized ? std::max(raw<std::int16_t>(bytes) / 32767.0, -1.0) : raw<std::int16_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return raw<std::uint16_t>(bytes) / (normalized ? 65535.0 : 1.0);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return raw<std::uint32_t>(bytes);
    default:
      return raw<float>(bytes);
  }
}

// The bytes of a bufferView from an offset on; nothing where the loaded buffer is shorter than the file said.
struct Bytes {
  const unsigned char* data = nullptr;
  std::size_t size = 0;
};

Bytes view_bytes(const tinygltf::Model& model, int view_index, std::size_t offset) {
  const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(view_index)];
  const auto& data = model.buffers[static_cast<std::size_t>(view.buffer)].data;
  const std::size_t begin = view.byteOffset + offset;
  const std::size_t end = std::min(view.byteOffset + view.byteLength, data.size());
  if (begin >= end) return {};
  return {data.data() + begin, end - begin};
}

class AccessorReader {
 public:
  AccessorReader(const tinygltf::Model& model, const tinygltf::Accessor& accessor)
      : model_(model),
        accessor_(accessor),
        components_(static_cast<std::size_t>(
            tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)))),
        size_(static_cast<std::size_t>(
            tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType)))) {}

  AccessorData read() {
    AccessorData out{accessor_.count, components_, std::vector<double>(accessor_.count * components_, 0.0)};
    if (accessor_.bufferView >= 0) {
      const std::size_t stride =
          model_.bufferViews[static_cast<std::size_t>(accessor_.bufferView)].byteStride;
      const Bytes bytes = view_bytes(model_, accessor_.bufferView, accessor_.byteOffset);
      for (std::size_t i = 0; i < out.count; ++i)
        read_element(bytes, i, std::max(stride, size_ * components_), &out.values[i * components_]);
    }
    if (accessor_.sparse.isSparse) read_sparse(out);
    return out;
  }

 private:
  void read_element(const Bytes& bytes, std::size_t i, std::size_t stride, double* out) const {
    if (i * stride + size_ * components_ > bytes.size) return;
    for (std::size_t c = 0; c < components_; ++c)
      out[c] = component(accessor_.componentType, accessor_.normalized, bytes.data + i * stride + c * size_);
  }

  void read_sparse(AccessorData& out) const {
    const auto& sparse = accessor_.sparse;
    const auto index_size = static_cast<std::size_t>(
        tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(sparse.indices.componentType)));
    const Bytes indices =
        view_bytes(model_, sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset));
    const Bytes values =
        view_bytes(model_, sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset));
    for (std::size_t i = 0; i < static_cast<std::size_t>(sparse.count); ++i) {
      if ((i + 1) * index_size > indices.size) return;
      const auto target = static_cast<std::size_t>(
          component(sparse.indices.componentType, false, indices.data + i * index_size));
      if (target < out.count) read_element(values, i, size_ * components_, &out.values[target * components_]);
    }
  }

  const tinygltf::Model& model_;
  const tinygltf::Accessor& accessor_;
  std::size_t components_, size_;
};

}  // namespace

AccessorData read_accessor(const tinygltf::Model& model, int accessor) {
  return AccessorReader(model, model.accessors[static_cast<std::size_t>(accessor)]).read();
}

}  // namespace gnomon
