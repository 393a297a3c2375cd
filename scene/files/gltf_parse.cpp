#include <algorithm>
#include <array>

#include "scene/files/gltf_container.h"
#include "scene/files/gltf_extensions.h"
#include "scene/files/gltf_members.h"
#include "scene/files/json_generate.h"
#include "scene/files/read_file.h"

namespace gnomon {
namespace gltf {
namespace {

constexpr NumberRange buffer_range{1.0, largest_integer, false, false, true};
constexpr NumberRange count_range{1.0, 4294967295.0, false, false, true};
constexpr NumberRange stride_range{1.0, 252.0, false, false, true};

constexpr std::array<std::string_view, 7> type_names{"SCALAR", "VEC2", "VEC3", "VEC4",
                                                     "MAT2",   "MAT3", "MAT4"};

/// Bytes of an element; columns of small matrices are padded to four bytes (section 3.6.2.4).
std::size_t bytes_of(ElementType type, ComponentType component) {
  const std::size_t size = bytes_of(component);
  if (type < ElementType::mat2) return components_of(type) * size;
  const std::size_t rows = type == ElementType::mat2 ? 2 : type == ElementType::mat3 ? 3 : 4;
  return rows * ((rows * size + 3) / 4 * 4);
}

bool is_one_of(std::initializer_list<ComponentType> types, double value) {
  return std::any_of(types.begin(), types.end(),
                     [&](ComponentType t) { return static_cast<int>(t) == value; });
}

/// Reads the lists of a file, in the order of what refers to what.
class ModelReader {
 public:
  ModelReader(const JsonNode& root, GltfDocument& out) : members_(root), root_(members_.root()), out_(out) {}

  void run() {
    Members::check_object(root_);
    check_asset();
    check_extensions();
    each("buffers", [&](const JsonNode& n) {
      members_.required_number(n, "byteLength", 1.0, buffer_range), Members::string(n, "uri");
    });
    each("bufferViews", [&](const JsonNode& n) { check_view(n); });
    each("accessors", [&](const JsonNode& n) { out_.model.accessors.push_back(read_accessor(n)); });
    each("images", [&](const JsonNode& n) {
      Members::string(n, "uri"), members_.index(n, "bufferView", members_.count("bufferViews"));
    });
    each("samplers", [&](const JsonNode& n) {
      for (const std::string_view key : {"magFilter", "minFilter", "wrapS", "wrapT"}) members_.size(n, key);
    });
    each("textures", [&](const JsonNode& n) {
      members_.size(n, "source"), members_.index(n, "sampler", members_.count("samplers"));
    });
    each("materials", [&](const JsonNode& n) { check_material(n); });
    if (!members_.failed()) read_nodes(members_, out_.model);
  }

 private:
  template <class Visit>
  void each(std::string_view list, const Visit& visit) const {
    members_.each(root_, list, visit);
  }

  void check_asset() const {
    const auto asset = root_.child("asset");
    if (!asset) return root_.error("asset is missing");
    const auto version = asset->child("version");
    if (!version) return asset->error("version is missing");
    if (!version->as_string().starts_with("2.")) version->wrong("unknown version", "2.x");
  }

  void check_extensions() {
    if (const auto list = root_.child("extensionsRequired"))
      for (const JsonNode& node : list->as_array())
        if (const std::string name = node.as_string();
            !is_supported_extension(name) && !is_spared_extension(name))
          node.error(fmt::format("the file needs an extension that is not supported (got \"{}\", allowed {})",
                                 printable(name), list_names(supported_extensions())));
    if (const auto list = root_.child("extensionsUsed"))
      for (const JsonNode& node : list->as_array())
        if (const std::string name = node.as_string(); !is_supported_extension(name))
          out_.notes.push_back(
              fmt::format("The extension {} is not supported and was not used.", printable(name)));
  }

  // ---- views and accessors ----

  void check_view(const JsonNode& node) const {
    const int buffer = members_.required_index(node, "buffer", members_.count("buffers"));
    const double length = members_.required_number(node, "byteLength", 0.0, size_range);
    const double offset = members_.number(node, "byteOffset", 0.0, size_range);
    const double stride = members_.number(node, "byteStride", 4.0, stride_range);
    if (std::fmod(stride, 4.0) != 0.0) node.child("byteStride")->wrong("not a multiple of 4", "4 to 252");
    if (members_.failed()) return;
    const double available =
        number_of(&members_.item("buffers", static_cast<std::size_t>(buffer)), "byteLength", 0.0);
    if (offset + length > available)
      node.error(fmt::format("reaches past its buffer (got bytes up to {:.0f}, allowed up to {:.0f})",
                             offset + length, available));
  }

  void check_extent(const JsonNode& node, int view, double offset, double count, std::size_t size) const {
    if (members_.failed() || view < 0) return;
    const JsonValue& value = members_.item("bufferViews", static_cast<std::size_t>(view));
    const auto each = static_cast<double>(size);
    const double stride = std::max(each, number_of(&value, "byteStride", each));
    const double length = number_of(&value, "byteLength", 0.0), end = offset + (count - 1.0) * stride + each;
    if (end > length)
      node.error(fmt::format("reaches past its bufferView (got bytes up to {:.0f}, allowed up to {:.0f})",
                             end, length));
  }

  Accessor read_accessor(const JsonNode& node) const {
    Accessor out;
    out.view = members_.index(node, "bufferView", members_.count("bufferViews"));
    const double component = members_.required_number(node, "componentType", float_32, size_range);
    const double count = members_.required_number(node, "count", 1.0, count_range);
    const double offset = members_.number(node, "byteOffset", 0.0, size_range);
    const auto type = node.child("type");
    if (!type) return node.error("type is missing"), out;
    const std::string type_name = type->as_string();
    if (!is_one_of({signed_byte, unsigned_byte, signed_short, unsigned_short, unsigned_int, float_32},
                   component))
      node.child("componentType")->wrong("unknown component type", "5120 to 5123, 5125, 5126");
    const auto* const found = std::find(type_names.begin(), type_names.end(), type_name);
    if (found == type_names.end()) type->wrong("unknown type", "SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3, MAT4");
    if (const auto normalized = node.child("normalized")) out.normalized = normalized->as_boolean();
    if (members_.failed()) return out;
    out.type = static_cast<ElementType>(found - type_names.begin());
    out.component = static_cast<ComponentType>(component);
    out.count = static_cast<std::size_t>(count), out.offset = static_cast<std::size_t>(offset);
    const std::size_t size = bytes_of(out.type, out.component);
    check_extent(node, out.view, offset, count, size);
    if (const auto sparse = node.child("sparse")) out.sparse = read_sparse(*sparse, count, size);
    return out;
  }

  Sparse read_sparse(const JsonNode& node, double accessor_count, std::size_t size) const {
    Sparse out;
    const double count =
        members_.required_number(node, "count", 1.0, {1.0, accessor_count, false, false, true});
    out.count = static_cast<std::size_t>(count);
    const auto indices = node.child("indices");
    const auto values = node.child("values");
    if (!indices || !values) return node.error("indices or values are missing"), out;
    const double component = members_.required_number(*indices, "componentType", unsigned_int, size_range);
    if (!is_one_of({unsigned_byte, unsigned_short, unsigned_int}, component))
      indices->error(fmt::format("componentType (got {:.0f}, allowed 5121, 5123, 5125)", component));
    if (members_.failed()) return out;
    out.index_type = static_cast<ComponentType>(component);
    out.indices = read_part(*indices, count, bytes_of(out.index_type));
    out.values = read_part(*values, count, size);
    return out;
  }

  SparsePart read_part(const JsonNode& node, double count, std::size_t size) const {
    const int view = members_.required_index(node, "bufferView", members_.count("bufferViews"));
    const double offset = members_.number(node, "byteOffset", 0.0, size_range);
    check_extent(node, view, offset, count, size);
    return {static_cast<std::size_t>(std::max(view, 0)), static_cast<std::size_t>(offset)};
  }

  // ---- materials ----

  void check_texture_info(const JsonNode& owner, std::string_view key) const {
    const auto info = owner.child(key);
    if (!info) return;
    Members::check_object(*info);
    if (members_.failed()) return;
    members_.required_index(*info, "index", members_.count("textures"));
    members_.number(*info, "texCoord", 0.0, {0.0, 15.0, false, false, true});
    Members::object(*info, "extensions");
  }

  void check_material(const JsonNode& node) const {
    Members::string(node, "name"), Members::string(node, "alphaMode");
    Members::object(node, "extensions");
    members_.number(node, "alphaCutoff", 0.5, non_negative_number);
    Members::numbers(node, "emissiveFactor", 3);
    for (const std::string_view key : {"normalTexture", "occlusionTexture", "emissiveTexture"})
      check_texture_info(node, key);
    const auto extensions = node.child("extensions");
    const auto gloss = extensions ? extensions->child("KHR_materials_pbrSpecularGlossiness") : std::nullopt;
    if (gloss) check_texture_info(*gloss, "diffuseTexture");
    const auto pbr = node.child("pbrMetallicRoughness");
    if (!pbr) return;
    Members::check_object(*pbr);
    Members::numbers(*pbr, "baseColorFactor", 4);
    members_.number(*pbr, "metallicFactor", 1.0, unit_interval);
    members_.number(*pbr, "roughnessFactor", 1.0, unit_interval);
    for (const std::string_view key : {"baseColorTexture", "metallicRoughnessTexture"})
      check_texture_info(*pbr, key);
  }

  Members members_;
  const JsonNode& root_;
  GltfDocument& out_;
};

}  // namespace

std::size_t components_of(ElementType type) {
  static constexpr std::array<std::size_t, 7> counts{1, 2, 3, 4, 4, 9, 16};
  return counts[static_cast<std::size_t>(type)];
}

std::size_t bytes_of(ComponentType type) {
  if (type == signed_byte || type == unsigned_byte) return 1;
  return type == signed_short || type == unsigned_short ? 2 : 4;
}

}  // namespace gltf

Expected<GltfDocument> parse_gltf(std::string_view bytes, const std::string& file) {
  std::string_view text = bytes;
  const bool binary = is_glb(bytes) || lower_extension(file) == ".glb";
  if (binary) {
    const auto chunks = read_glb(bytes, file);
    if (!chunks) return fail(chunks.error());
    text = chunks->json;
  }
  auto json = parse_json(text, file, !binary);
  if (!json) return fail(json.error());
  GltfDocument out{std::move(*json), {}, binary, {}};
  JsonErrors errors{out.json};
  gltf::ModelReader(JsonNode(errors, out.json.root, ""), out).run();
  if (errors.first) return fail(std::move(*errors.first));
  return out;
}

}  // namespace gnomon
