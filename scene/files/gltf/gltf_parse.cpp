#include <algorithm>
#include <array>

#include "scene/files/gltf/gltf_data.h"
#include "scene/files/gltf/gltf_members.h"
#include "scene/files/json/json_generate.h"
#include "scene/files/read_file.h"

namespace gnomon {
namespace gltf {
namespace {

constexpr NumberRange buffer_range{1.0, largest_integer, false, false, true};
constexpr NumberRange count_range{1.0, 4294967295.0, false, false, true};
constexpr NumberRange stride_range{1.0, 252.0, false, false, true};

constexpr std::array<std::string_view, 7> type_names{"SCALAR", "VEC2", "VEC3", "VEC4",
                                                     "MAT2",   "MAT3", "MAT4"};

constexpr std::array<std::string_view, 17> used_extensions{"KHR_lights_punctual",
                                                           "KHR_materials_transmission",
                                                           "KHR_materials_ior",
                                                           "KHR_materials_volume",
                                                           "KHR_materials_emissive_strength",
                                                           "KHR_materials_specular",
                                                           "KHR_materials_unlit",
                                                           "KHR_texture_transform",
                                                           "KHR_mesh_quantization",
                                                           "KHR_texture_basisu",
                                                           "KHR_draco_mesh_compression",
                                                           "EXT_meshopt_compression",
                                                           "KHR_meshopt_compression",
                                                           "KHR_node_visibility",
                                                           "EXT_mesh_gpu_instancing",
                                                           "EXT_texture_webp",
                                                           "KHR_materials_pbrSpecularGlossiness"};

/// They change looks alone, or nothing that is seen: a file that insists on one is shown without, and that is said.
constexpr std::array<std::string_view, 11> extensions_without_note{
    "KHR_materials_clearcoat",   "KHR_materials_sheen",      "KHR_materials_anisotropy",
    "KHR_materials_iridescence", "KHR_materials_dispersion", "KHR_materials_diffuse_transmission",
    "KHR_materials_variants",    "KHR_animation_pointer",    "KHR_xmp_json_ld",
    "KHR_node_hoverability",     "KHR_node_selectability"};

template <class Names>
bool is_one_of(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

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
  ModelReader(const JsonNode& root, GltfDocument& out) : root_(root), out_(out) {}

  void run() {
    check_object(root_);
    check_asset();
    check_extensions();
    each("buffers",
         [&](const JsonNode& n) { required_number(n, "byteLength", 1.0, buffer_range), string(n, "uri"); });
    each("bufferViews", [&](const JsonNode& n) { check_view(n); });
    each("accessors", [&](const JsonNode& n) { out_.model.accessors.push_back(read_accessor(n)); });
    each("images",
         [&](const JsonNode& n) { string(n, "uri"), index(n, "bufferView", count("bufferViews")); });
    each("samplers", [&](const JsonNode& n) {
      for (const std::string_view key : {"magFilter", "minFilter", "wrapS", "wrapT"}) size(n, key);
    });
    each("textures", [&](const JsonNode& n) { size(n, "source"), index(n, "sampler", count("samplers")); });
    each("materials", [&](const JsonNode& n) { check_material(n); });
    if (!failed(root_)) read_nodes(root_, out_.model);
  }

 private:
  template <class Visit>
  void each(std::string_view list, const Visit& visit) const {
    gltf::each(root_, list, visit);
  }

  std::size_t count(std::string_view list) const { return gltf_list(root_.value(), list).size(); }
  const JsonValue& item(std::string_view list, int at) const {
    return gltf_list(root_.value(), list)[static_cast<std::size_t>(at)];
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
            !is_one_of(used_extensions, name) && !is_one_of(extensions_without_note, name))
          node.error(fmt::format("the file needs an extension that is not supported (got \"{}\", allowed {})",
                                 printable(name),
                                 list_names({used_extensions.begin(), used_extensions.end()})));
    if (const auto list = root_.child("extensionsUsed"))
      for (const JsonNode& node : list->as_array())
        if (const std::string name = node.as_string(); !is_one_of(used_extensions, name))
          out_.notes.push_back(
              fmt::format("The extension {} is not supported and was not used.", printable(name)));
  }

  // ---- views and accessors ----

  void check_view(const JsonNode& node) const {
    const int buffer = required_index(node, "buffer", count("buffers"));
    const double length = required_number(node, "byteLength", 0.0, size_range);
    const double offset = size(node, "byteOffset");
    const double stride = number(node, "byteStride", 4.0, stride_range);
    if (std::fmod(stride, 4.0) != 0.0) node.child("byteStride")->wrong("not a multiple of 4", "4 to 252");
    if (failed(root_)) return;
    const double available = number_of(&item("buffers", buffer), "byteLength", 0.0);
    if (offset + length > available)
      node.error(fmt::format("reaches past its buffer (got bytes up to {:.0f}, allowed up to {:.0f})",
                             offset + length, available));
  }

  void check_extent(const JsonNode& node, int view, double offset, double count, std::size_t size) const {
    if (failed(root_) || view < 0) return;
    const JsonValue& value = item("bufferViews", view);
    const auto each = static_cast<double>(size);
    const double stride = std::max(each, number_of(&value, "byteStride", each));
    const double length = number_of(&value, "byteLength", 0.0), end = offset + (count - 1.0) * stride + each;
    if (end > length)
      node.error(fmt::format("reaches past its bufferView (got bytes up to {:.0f}, allowed up to {:.0f})",
                             end, length));
  }

  Accessor read_accessor(const JsonNode& node) const {
    Accessor out;
    out.view = index(node, "bufferView", count("bufferViews"));
    const double component = required_number(node, "componentType", float_32, size_range);
    const double count = required_number(node, "count", 1.0, count_range);
    const double offset = size(node, "byteOffset");
    const auto type = node.child("type");
    if (!type) return node.error("type is missing"), out;
    const std::string type_name = type->as_string();
    if (!is_one_of({signed_byte, unsigned_byte, signed_short, unsigned_short, unsigned_int, float_32},
                   component))
      node.child("componentType")->wrong("unknown component type", "5120 to 5123, 5125, 5126");
    const auto* const found = std::find(type_names.begin(), type_names.end(), type_name);
    if (found == type_names.end()) type->wrong("unknown type", "SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3, MAT4");
    if (const auto normalized = node.child("normalized")) out.normalized = normalized->as_boolean();
    if (failed(root_)) return out;
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
    const double count = required_number(node, "count", 1.0, {1.0, accessor_count, false, false, true});
    out.count = static_cast<std::size_t>(count);
    const auto indices = node.child("indices");
    const auto values = node.child("values");
    if (!indices || !values) return node.error("indices or values are missing"), out;
    const double component = required_number(*indices, "componentType", unsigned_int, size_range);
    if (!is_one_of({unsigned_byte, unsigned_short, unsigned_int}, component))
      indices->error(fmt::format("componentType (got {:.0f}, allowed 5121, 5123, 5125)", component));
    if (failed(root_)) return out;
    out.index_type = static_cast<ComponentType>(component);
    out.indices = read_part(*indices, count, bytes_of(out.index_type));
    out.values = read_part(*values, count, size);
    return out;
  }

  SparsePart read_part(const JsonNode& node, double elements, std::size_t size_of_each) const {
    const int view = required_index(node, "bufferView", count("bufferViews"));
    const double offset = size(node, "byteOffset");
    check_extent(node, view, offset, elements, size_of_each);
    return {static_cast<std::size_t>(std::max(view, 0)), static_cast<std::size_t>(offset)};
  }

  // ---- materials ----

  void check_texture_info(const JsonNode& owner, std::string_view key) const {
    const auto info = owner.child(key);
    if (!info) return;
    check_object(*info);
    if (failed(root_)) return;
    required_index(*info, "index", count("textures"));
    number(*info, "texCoord", 0.0, {0.0, 15.0, false, false, true});
    object(*info, "extensions");
  }

  void check_material(const JsonNode& node) const {
    string(node, "name"), string(node, "alphaMode");
    object(node, "extensions");
    number(node, "alphaCutoff", 0.5, non_negative_number);
    numbers(node, "emissiveFactor", 3);
    for (const std::string_view key : {"normalTexture", "occlusionTexture", "emissiveTexture"})
      check_texture_info(node, key);
    const auto extensions = node.child("extensions");
    const auto gloss = extensions ? extensions->child("KHR_materials_pbrSpecularGlossiness") : std::nullopt;
    if (gloss) check_texture_info(*gloss, "diffuseTexture");
    const auto pbr = node.child("pbrMetallicRoughness");
    if (!pbr) return;
    check_object(*pbr);
    numbers(*pbr, "baseColorFactor", 4);
    number(*pbr, "metallicFactor", 1.0, unit_interval);
    number(*pbr, "roughnessFactor", 1.0, unit_interval);
    for (const std::string_view key : {"baseColorTexture", "metallicRoughnessTexture"})
      check_texture_info(*pbr, key);
  }

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
  const JsonNode root(errors, out.json.root, "");
  gltf::ModelReader(root, out).run();
  if (errors.first) return fail(std::move(*errors.first));
  return out;
}

}  // namespace gnomon
