#include "scene/files/gltf_draco.h"

#include <draco/compression/decode.h>
#include <draco/compression/point_cloud/point_cloud_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>
#include <fmt/core.h>
#include <tiny_gltf.h>

#include <cstring>
#include <set>

#include "scene/parallel.h"

namespace gnomon {
namespace {

constexpr const char* extension_name = "KHR_draco_mesh_compression";

struct Attribute {
  std::string name;
  std::size_t accessor = 0;
  std::uint32_t draco_id = 0;
  std::vector<char> values{};  ///< floats
};

/// A primitive, and what comes out of it.
struct Task {
  tinygltf::Primitive* primitive = nullptr;
  std::string field, reason{};  ///< for messages; the reason is empty while all is well
  std::string_view packed{};
  std::vector<Attribute> attributes{};
  std::vector<char> indices{};
  std::size_t vertices = 0, corners = 0;
};

bool fits(std::uint64_t claimed, std::size_t bytes) {
  constexpr std::uint64_t few = 65536, most_per_byte = 64;  // the best case known takes a bit each
  return claimed <= few + most_per_byte * bytes;
}

/// Before anything is allocated: the numbers of triangles and vertices that the header claims.
std::string header_defect(std::string_view packed) {
  draco::DecoderBuffer buffer;
  buffer.Init(packed.data(), packed.size());
  draco::DracoHeader header;
  if (!draco::PointCloudDecoder::DecodeHeader(&buffer, &header).ok()) return "the Draco header is damaged";
  if (header.encoder_type != draco::TRIANGULAR_MESH) return "the Draco data is no mesh of triangles";
  if (header.version_major != 2 || header.version_minor != 2)
    return fmt::format("the version of the Draco data (got {}.{}, allowed 2.2)", header.version_major,
                       header.version_minor);
  buffer.set_bitstream_version(DRACO_BITSTREAM_VERSION(2, 2));
  draco::GeometryMetadata metadata;
  if ((header.flags & METADATA_FLAG_MASK) != 0 &&
      !draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &metadata))
    return "the Draco metadata is damaged";
  std::uint8_t traversal = 0;
  std::uint32_t first = 0, second = 0;  // triangles and vertices, or the other way round
  if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING && !buffer.Decode(&traversal))
    return "the Draco header is cut off";
  if (!draco::DecodeVarint(&first, &buffer) || !draco::DecodeVarint(&second, &buffer))
    return "the Draco header is cut off";
  if (fits(first, packed.size()) && fits(second, packed.size())) return {};
  return fmt::format("{} bytes of Draco data cannot hold {} triangles and vertices", packed.size(),
                     std::uint64_t{first} + second);
}

double normalizer(const tinygltf::Accessor& accessor) {
  if (!accessor.normalized) return 1.0;
  switch (accessor.componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return 127.0;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 255.0;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return 32767.0;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 65535.0;
    default:
      return 1.0;
  }
}

/// Integers as they are, as floats.
std::array<float, 16> value_of(const draco::PointAttribute& from, draco::AttributeValueIndex index,
                               std::size_t components) {
  std::array<float, 16> out{};
  const auto count = static_cast<std::int8_t>(components);
  if (from.data_type() == draco::DT_FLOAT32 || from.data_type() == draco::DT_FLOAT64) {
    from.ConvertValue(index, count, out.data());
  } else {
    std::array<std::int32_t, 16> whole{};
    from.ConvertValue(index, count, whole.data());
    for (std::size_t c = 0; c < components; ++c) out[c] = static_cast<float>(whole[c]);
  }
  return out;
}

void copy_attribute(const draco::Mesh& mesh, const tinygltf::Model& model, Task& task, Attribute& attribute) {
  const tinygltf::Accessor& accessor = model.accessors[attribute.accessor];
  const draco::PointAttribute* from = mesh.GetAttributeByUniqueId(attribute.draco_id);
  if (from == nullptr) {
    task.reason =
        fmt::format("the Draco data has no attribute {} for {}", attribute.draco_id, attribute.name);
    return;
  }
  const auto components =
      static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)));
  const auto divisor = static_cast<float>(normalizer(accessor));
  attribute.values.resize(mesh.num_points() * components * sizeof(float));
  char* out = attribute.values.data();
  for (std::uint32_t i = 0; i < mesh.num_points(); ++i, out += components * sizeof(float)) {
    auto value = value_of(*from, from->mapped_index(draco::PointIndex(i)), components);
    if (divisor > 1.0f)
      for (float& v : value) v = std::max(v / divisor, -1.0f);
    std::memcpy(out, value.data(), components * sizeof(float));
  }
}

void copy_indices(const draco::Mesh& mesh, Task& task) {
  task.corners = std::size_t{3} * mesh.num_faces();
  task.indices.resize(task.corners * sizeof(std::uint32_t));
  char* out = task.indices.data();
  for (std::uint32_t i = 0; i < mesh.num_faces(); ++i)
    for (const draco::PointIndex& corner : mesh.face(draco::FaceIndex(i))) {
      const std::uint32_t index = corner.value();
      std::memcpy(out, &index, sizeof index);
      out += sizeof index;
    }
}

void unpack(const tinygltf::Model& model, Task& task) {
  task.reason = header_defect(task.packed);
  if (!task.reason.empty()) return;
  draco::DecoderBuffer buffer;
  buffer.Init(task.packed.data(), task.packed.size());
  const auto mesh = draco::Decoder().DecodeMeshFromBuffer(&buffer);
  if (!mesh.ok()) {
    task.reason = fmt::format("the Draco data is damaged: {}", mesh.status().error_msg_string());
    return;
  }
  task.vertices = mesh.value()->num_points();
  copy_indices(*mesh.value(), task);
  for (Attribute& attribute : task.attributes)
    if (task.reason.empty()) copy_attribute(*mesh.value(), model, task, attribute);
}

class Unpacker {
 public:
  Unpacker(tinygltf::Model& model, GltfData& data, const std::string& file)
      : model_(model), data_(data), file_(file) {}

  Expected<void> run() {
    for (std::size_t m = 0; m < model_.meshes.size(); ++m)
      for (std::size_t p = 0; p < model_.meshes[m].primitives.size(); ++p)
        if (const auto added =
                add_task(model_.meshes[m].primitives[p], fmt::format("meshes[{}].primitives[{}]", m, p));
            !added)
          return added;
    parallel_for(tasks_.size(), [&](std::size_t i) { unpack(model_, tasks_[i]); });
    for (Task& task : tasks_) {
      if (!task.reason.empty()) return error(task.field, task.reason);
      put(task);
    }
    return {};
  }

 private:
  tl::unexpected<Error> error(const std::string& field, std::string reason) const {
    return fail(Error{ErrorKind::bad_input, std::move(reason), file_, 0, 0,
                      fmt::format("{}.extensions.{}", field, extension_name)});
  }

  bool is_required() const {
    const auto& required = model_.extensionsRequired;
    return std::find(required.begin(), required.end(), extension_name) != required.end();
  }

  bool brings_it_unpacked(const tinygltf::Primitive& primitive) const {
    const auto position = primitive.attributes.find("POSITION");
    return position != primitive.attributes.end() &&
           model_.accessors[static_cast<std::size_t>(position->second)].bufferView >= 0;
  }

  Expected<void> add_task(tinygltf::Primitive& primitive, const std::string& field) {
    const auto found = primitive.extensions.find(extension_name);
    if (found == primitive.extensions.end() || (!is_required() && brings_it_unpacked(primitive))) return {};
    const tinygltf::Value& extension = found->second;
    if (!extension.Has("bufferView") || !extension.Has("attributes"))
      return error(field, "bufferView or attributes is missing");
    const tinygltf::Value& view = extension.Get("bufferView");
    if (!view.IsInt() || view.GetNumberAsInt() < 0 ||
        static_cast<std::size_t>(view.GetNumberAsInt()) >= model_.bufferViews.size())
      return error(field, "there is no such bufferView");
    Task task{&primitive, field};
    task.packed = data_.view(static_cast<std::size_t>(view.GetNumberAsInt()));
    const tinygltf::Value& ids = extension.Get("attributes");
    for (const std::string& name : ids.Keys()) {
      const auto accessor = primitive.attributes.find(name);
      const tinygltf::Value& id = ids.Get(name);
      if (accessor == primitive.attributes.end() || !id.IsInt() || id.GetNumberAsInt() < 0) continue;
      task.attributes.push_back({name, static_cast<std::size_t>(accessor->second),
                                 static_cast<std::uint32_t>(id.GetNumberAsInt())});
    }
    tasks_.push_back(std::move(task));
    return {};
  }

  /// The accessor's index: its own, or that of a copy where another primitive has taken it.
  int place(std::size_t accessor, std::vector<char> bytes, int component_type, std::size_t count) {
    if (!taken_.insert(accessor).second) {
      const tinygltf::Accessor copy = model_.accessors[accessor];
      accessor = model_.accessors.size();
      model_.accessors.push_back(copy);
    }
    tinygltf::BufferView view;
    view.byteLength = bytes.size();
    model_.bufferViews.push_back(view);
    tinygltf::Accessor& out = model_.accessors[accessor];
    out.bufferView = static_cast<int>(data_.add_view(std::move(bytes)));
    out.byteOffset = 0, out.componentType = component_type, out.normalized = false, out.count = count;
    out.sparse.isSparse = false;
    return static_cast<int>(accessor);
  }

  void put(Task& task) {
    tinygltf::Primitive& primitive = *task.primitive;
    for (Attribute& attribute : task.attributes)
      primitive.attributes[attribute.name] = place(attribute.accessor, std::move(attribute.values),
                                                   TINYGLTF_COMPONENT_TYPE_FLOAT, task.vertices);
    if (primitive.indices < 0) {
      tinygltf::Accessor indices;
      indices.type = TINYGLTF_TYPE_SCALAR;
      primitive.indices = static_cast<int>(model_.accessors.size());
      model_.accessors.push_back(indices);
    }
    primitive.indices = place(static_cast<std::size_t>(primitive.indices), std::move(task.indices),
                              TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, task.corners);
    primitive.mode = TINYGLTF_MODE_TRIANGLES;  // strips too are unpacked as triangles
  }

  tinygltf::Model& model_;
  GltfData& data_;
  const std::string& file_;
  std::vector<Task> tasks_;
  std::set<std::size_t> taken_;
};

}  // namespace

Expected<void> unpack_draco(tinygltf::Model& model, GltfData& data, const std::string& file) {
  return Unpacker(model, data, file).run();
}

}  // namespace gnomon
