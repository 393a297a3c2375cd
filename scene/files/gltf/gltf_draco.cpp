#include "scene/files/gltf/gltf_data.h"

#include <draco/compression/decode.h>
#include <draco/compression/point_cloud/point_cloud_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>
#include <fmt/core.h>

#include <cstring>
#include <limits>
#include <set>

#include "scene/base/parallel.h"
#include "scene/files/gltf/gltf_value.h"

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
  gltf::Primitive* primitive = nullptr;
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

double normalizer(const gltf::Accessor& accessor) {
  if (!accessor.normalized) return 1.0;
  switch (accessor.component) {
    case gltf::signed_byte:
      return 127.0;
    case gltf::unsigned_byte:
      return 255.0;
    case gltf::signed_short:
      return 32767.0;
    case gltf::unsigned_short:
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

void copy_attribute(const draco::Mesh& mesh, const gltf::Model& model, Task& task, Attribute& attribute) {
  const gltf::Accessor& accessor = model.accessors[attribute.accessor];
  const draco::PointAttribute* from = mesh.GetAttributeByUniqueId(attribute.draco_id);
  if (from == nullptr) {
    task.reason =
        fmt::format("the Draco data has no attribute {} for {}", attribute.draco_id, attribute.name);
    return;
  }
  const std::size_t components = gltf::components_of(accessor.type);
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

void unpack(const gltf::Model& model, Task& task) {
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
  Unpacker(GltfDocument& document, GltfData& data)
      : json_(document.json), model_(document.model), data_(data) {}

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
    return fail(Error{ErrorKind::bad_input, std::move(reason), json_.file, 0, 0,
                      fmt::format("{}.extensions.{}", field, extension_name)});
  }

  bool is_required() const {
    const auto& required = gltf_list(json_.root, "extensionsRequired");
    return std::any_of(required.begin(), required.end(),
                       [](const JsonValue& name) { return name.text == extension_name; });
  }

  bool brings_it_unpacked(const gltf::Primitive& primitive) const {
    const int position = gltf::attribute(primitive.attributes, "POSITION");
    return position >= 0 && model_.accessors[static_cast<std::size_t>(position)].view >= 0;
  }

  Expected<void> add_task(gltf::Primitive& primitive, const std::string& field) {
    const JsonValue* packed = extension(primitive.extensions, extension_name);
    if (packed == nullptr || (!is_required() && brings_it_unpacked(primitive))) return {};
    if (!has(packed, "bufferView") || !has(packed, "attributes"))
      return error(field, "bufferView or attributes is missing");
    const int view = index_of(packed, "bufferView", data_.view_count());
    if (view < 0) return error(field, "there is no such bufferView");
    Task task{&primitive, field};
    task.packed = data_.view(static_cast<std::size_t>(view));
    const JsonValue* ids = member(packed, "attributes");
    for (const auto& [name, accessor] : primitive.attributes)
      if (const int id = index_of(ids, name, std::numeric_limits<int>::max()); id >= 0)
        task.attributes.push_back({name, static_cast<std::size_t>(accessor), static_cast<std::uint32_t>(id)});
    tasks_.push_back(std::move(task));
    return {};
  }

  /// The accessor's index: its own, or that of a copy where another primitive has taken it.
  int place(std::size_t accessor, std::vector<char> bytes, gltf::ComponentType component, std::size_t count) {
    if (!taken_.insert(accessor).second) {
      const gltf::Accessor copy = model_.accessors[accessor];
      accessor = model_.accessors.size();
      model_.accessors.push_back(copy);
    }
    gltf::Accessor& out = model_.accessors[accessor];
    out.view = static_cast<int>(data_.add_view(std::move(bytes)));
    out.offset = 0, out.component = component, out.normalized = false, out.count = count;
    out.sparse.reset();
    return static_cast<int>(accessor);
  }

  void put(Task& task) {
    gltf::Primitive& primitive = *task.primitive;
    for (Attribute& attribute : task.attributes)
      primitive.attributes[attribute.name] =
          place(attribute.accessor, std::move(attribute.values), gltf::float_32, task.vertices);
    if (primitive.indices < 0) {
      primitive.indices = static_cast<int>(model_.accessors.size());
      model_.accessors.emplace_back();
    }
    primitive.indices = place(static_cast<std::size_t>(primitive.indices), std::move(task.indices),
                              gltf::unsigned_int, task.corners);
    primitive.mode = gltf::triangles;  // strips too are unpacked as triangles
  }

  const JsonDocument& json_;
  gltf::Model& model_;
  GltfData& data_;
  std::vector<Task> tasks_;
  std::set<std::size_t> taken_;
};

}  // namespace

Expected<void> unpack_draco(GltfDocument& document, GltfData& data) {
  return Unpacker(document, data).run();
}

}  // namespace gnomon
