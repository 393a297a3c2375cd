#include "scene/files/gltf_check.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>

#include "scene/files/gltf_container.h"
#include "scene/files/gltf_extensions.h"
#include "scene/files/gltf_tree.h"
#include "scene/files/json_generate.h"
#include "scene/files/json_reader.h"
#include "scene/files/read_file.h"

namespace gnomon {
namespace {

constexpr double largest_integer = 9007199254740992.0;  // 2^53, as far as JSON numbers are exact
constexpr NumberRange size_range{0.0, largest_integer, false, false, true};
constexpr NumberRange buffer_range{1.0, largest_integer, false, false, true};
constexpr NumberRange count_range{1.0, 4294967295.0, false, false, true};

// Counts of the file's lists, for checking indices into them.
struct Counts {
  double buffers, views, accessors, images, samplers, textures, materials, meshes, cameras, nodes, scenes,
      lights, skins;
};

class GltfChecker {
 public:
  explicit GltfChecker(const JsonDocument& document) : errors_{document}, root_(errors_, document.root, "") {}

  std::optional<Error> run(std::vector<std::string>& notes) {
    if (!root_.is(JsonValue::Type::object)) root_.wrong("wrong type", "an object");
    check_asset();
    check_extensions(notes);
    counts_ = {count("buffers"),  count("bufferViews"), count("accessors"), count("images"),
               count("samplers"), count("textures"),    count("materials"), count("meshes"),
               count("cameras"),  count("nodes"),       count("scenes"),    count_lights(),
               count("skins")};
    each("buffers", [&](const JsonNode& n) {
      required_number(n, "byteLength", buffer_range), optional_string(n, "uri");
    });
    each("bufferViews", [&](const JsonNode& n) { check_view(n); });
    each("accessors", [&](const JsonNode& n) { check_accessor(n); });
    each("images",
         [&](const JsonNode& n) { optional_string(n, "uri"), index(n, "bufferView", counts_.views); });
    each("samplers", [&](const JsonNode& n) { check_sampler(n); });
    each("textures", [&](const JsonNode& n) {
      number(n, "source", 0.0, size_range), index(n, "sampler", counts_.samplers);
    });
    each("materials", [&](const JsonNode& n) { check_material(n); });
    each("meshes", [&](const JsonNode& n) { check_mesh(n); });
    each("skins", [&](const JsonNode& n) { check_skin(n); });
    each("cameras", [&](const JsonNode& n) { check_camera(n); });
    each("nodes", [&](const JsonNode& n) { check_node(n); });
    each("scenes", [&](const JsonNode& n) { indices(n, "nodes", counts_.nodes); });
    index(root_, "scene", counts_.scenes);
    if (const auto nodes = root_.child("nodes"); nodes && !errors_.first) check_gltf_tree(nodes->as_array());
    return errors_.first;
  }

 private:
  // ---- lists and typed members ----

  double count(std::string_view key) const {
    const auto list = root_.child(key);
    return list && list->is(JsonValue::Type::array) ? static_cast<double>(list->value().items.size()) : 0.0;
  }

  double count_lights() const {
    const auto lights = light_list();
    return lights ? static_cast<double>(lights->value().items.size()) : 0.0;
  }

  std::optional<JsonNode> light_list() const {
    const auto extensions = root_.child("extensions");
    const auto punctual = extensions ? extensions->child("KHR_lights_punctual") : std::nullopt;
    return punctual ? punctual->child("lights") : std::nullopt;
  }

  template <class Visit>
  void each(std::string_view key, const Visit& visit) {
    const auto list = root_.child(key);
    if (!list) return;
    for (const JsonNode& node : list->as_array()) {
      if (!node.is(JsonValue::Type::object)) node.wrong("wrong type", "an object");
      if (errors_.first) return;
      visit(node);
    }
  }

  std::optional<double> required_number(const JsonNode& node, std::string_view key,
                                        const NumberRange& range) {
    const auto child = node.child(key);
    if (child) return child->as_number(range);
    node.error(fmt::format("{} is missing", key));
    return std::nullopt;
  }
  double number(const JsonNode& node, std::string_view key, double otherwise,
                const NumberRange& range = any_number) {
    const auto child = node.child(key);
    return child ? child->as_number(range) : otherwise;
  }
  void optional_string(const JsonNode& node, std::string_view key) {
    if (const auto child = node.child(key)) child->as_string();
  }
  void optional_object(const JsonNode& node, std::string_view key) {
    const auto child = node.child(key);
    if (child && !child->is(JsonValue::Type::object)) child->wrong("wrong type", "an object");
  }
  void numbers(const JsonNode& node, std::string_view key, std::size_t size) {
    if (const auto child = node.child(key))
      for (const JsonNode& item : child->as_array(size)) item.as_number();
  }

  // -1 where there is none.
  double index_value(const JsonNode& node, double size) {
    if (size > 0.0) return node.as_number({0.0, size - 1.0, false, false, true});
    node.wrong("refers to a list that is empty or missing", "no index");
    return -1.0;
  }
  double index(const JsonNode& node, std::string_view key, double size) {
    const auto child = node.child(key);
    return child ? index_value(*child, size) : -1.0;
  }
  double required_index(const JsonNode& node, std::string_view key, double size) {
    if (!node.child(key)) node.error(fmt::format("{} is missing", key));
    return index(node, key, size);
  }
  void indices(const JsonNode& node, std::string_view key, double size) {
    if (const auto list = node.child(key))
      for (const JsonNode& item : list->as_array()) index_value(item, size);
  }

  const JsonValue& item_value(std::string_view key, double at) const {
    return root_.value().find(key)->value.items[static_cast<std::size_t>(at)];
  }
  static double plain_number(const JsonValue& object, std::string_view key, double otherwise) {
    const JsonMember* member = object.find(key);
    return member && member->value.type == JsonValue::Type::number ? member->value.number : otherwise;
  }

  // ---- parts ----

  void check_asset() {
    const auto asset = root_.child("asset");
    if (!asset) return root_.error("asset is missing");
    const auto version = asset->child("version");
    if (!version) return asset->error("version is missing");
    if (!version->as_string().starts_with("2.")) version->wrong("unknown version", "2.x");
  }

  void check_extensions(std::vector<std::string>& notes) {
    if (const auto list = root_.child("extensionsRequired"))
      for (const JsonNode& node : list->as_array())
        if (const std::string name = node.as_string();
            !is_supported_extension(name) && !is_spared_extension(name))
          node.error(fmt::format("the file needs an extension that is not supported (got \"{}\", allowed {})",
                                 printable(name), list_names(supported_extensions())));
    if (const auto list = root_.child("extensionsUsed"))
      for (const JsonNode& node : list->as_array())
        if (const std::string name = node.as_string(); !is_supported_extension(name))
          notes.push_back(
              fmt::format("The extension {} is not supported and was not used.", printable(name)));
  }

  void check_view(const JsonNode& node) {
    const double buffer = required_index(node, "buffer", counts_.buffers);
    const double length = required_number(node, "byteLength", size_range).value_or(0.0);
    const double offset = number(node, "byteOffset", 0.0, size_range);
    number(node, "byteStride", 0.0, {1.0, 252.0, false, false, true});
    if (errors_.first || buffer < 0.0) return;
    const double available = plain_number(item_value("buffers", buffer), "byteLength", 0.0);
    if (offset + length > available)
      node.error(fmt::format("reaches past its buffer (got bytes up to {:.0f}, allowed up to {:.0f})",
                             offset + length, available));
  }

  static double component_size(double type) {
    return type == 5120.0 || type == 5121.0 ? 1.0 : type == 5122.0 || type == 5123.0 ? 2.0 : 4.0;
  }

  // Bytes of an element; columns of small matrices are padded to four bytes (glTF 2.0, section 3.6.2.4).
  static double element_size(const std::string& type, double component) {
    if (type == "SCALAR") return component;
    if (type == "VEC2") return 2.0 * component;
    if (type == "VEC3") return 3.0 * component;
    if (type == "VEC4") return 4.0 * component;
    const double rows = type == "MAT2" ? 2.0 : type == "MAT3" ? 3.0 : 4.0;
    return rows * 4.0 * std::ceil(rows * component / 4.0);
  }

  void check_extent(const JsonNode& node, double view, double offset, double count, double size) {
    if (errors_.first || view < 0.0) return;
    const JsonValue& value = item_value("bufferViews", view);
    const double length = plain_number(value, "byteLength", 0.0);
    const double stride = std::max(size, plain_number(value, "byteStride", size));
    const double end = offset + (count - 1.0) * stride + size;
    if (end > length)
      node.error(fmt::format("reaches past its bufferView (got bytes up to {:.0f}, allowed up to {:.0f})",
                             end, length));
  }

  void check_accessor(const JsonNode& node) {
    const double view = index(node, "bufferView", counts_.views);
    const double component = required_number(node, "componentType", size_range).value_or(5126.0);
    const double count = required_number(node, "count", count_range).value_or(1.0);
    const double offset = number(node, "byteOffset", 0.0, size_range);
    const auto type = node.child("type");
    if (!type) return node.error("type is missing");
    const std::string type_name = type->as_string();
    static const std::array<double, 6> components{5120.0, 5121.0, 5122.0, 5123.0, 5125.0, 5126.0};
    static const std::array<std::string_view, 7> types{"SCALAR", "VEC2", "VEC3", "VEC4",
                                                       "MAT2",   "MAT3", "MAT4"};
    if (std::find(components.begin(), components.end(), component) == components.end())
      node.child("componentType")->wrong("unknown component type", "5120 to 5123, 5125, 5126");
    if (std::find(types.begin(), types.end(), type_name) == types.end())
      type->wrong("unknown type", "SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3, MAT4");
    if (const auto normalized = node.child("normalized")) normalized->as_boolean();
    check_extent(node, view, offset, count, element_size(type_name, component_size(component)));
    if (const auto sparse = node.child("sparse"))
      check_sparse(*sparse, count, element_size(type_name, component_size(component)));
  }

  void check_sparse(const JsonNode& node, double accessor_count, double size) {
    const double count =
        required_number(node, "count", {1.0, accessor_count, false, false, true}).value_or(1.0);
    const auto indices = node.child("indices");
    const auto values = node.child("values");
    if (!indices || !values) return node.error("indices or values are missing");
    const double component = required_number(*indices, "componentType", size_range).value_or(5125.0);
    if (component != 5121.0 && component != 5123.0 && component != 5125.0)
      indices->error(fmt::format("componentType (got {:.0f}, allowed 5121, 5123, 5125)", component));
    for (const auto& [part, each] : {std::pair{*indices, component_size(component)}, {*values, size}})
      check_extent(part, required_index(part, "bufferView", counts_.views),
                   number(part, "byteOffset", 0.0, size_range), count, each);
  }

  void check_sampler(const JsonNode& node) {
    for (const std::string_view key : {"magFilter", "minFilter", "wrapS", "wrapT"})
      number(node, key, 0.0, size_range);
  }

  void check_texture_info(const JsonNode& owner, std::string_view key) {
    const auto info = owner.child(key);
    if (!info) return;
    if (!info->is(JsonValue::Type::object)) return info->wrong("wrong type", "an object");
    required_index(*info, "index", counts_.textures);
    number(*info, "texCoord", 0.0, {0.0, 15.0, false, false, true});
    optional_object(*info, "extensions");
  }

  void check_material(const JsonNode& node) {
    optional_string(node, "name");
    optional_string(node, "alphaMode");
    optional_object(node, "extensions");
    number(node, "alphaCutoff", 0.5, non_negative_number);
    numbers(node, "emissiveFactor", 3);
    for (const std::string_view key : {"normalTexture", "occlusionTexture", "emissiveTexture"})
      check_texture_info(node, key);
    const auto extensions = node.child("extensions");
    const auto gloss = extensions ? extensions->child("KHR_materials_pbrSpecularGlossiness") : std::nullopt;
    if (gloss) check_texture_info(*gloss, "diffuseTexture");
    const auto pbr = node.child("pbrMetallicRoughness");
    if (!pbr) return;
    if (!pbr->is(JsonValue::Type::object)) return pbr->wrong("wrong type", "an object");
    numbers(*pbr, "baseColorFactor", 4);
    number(*pbr, "metallicFactor", 1.0, unit_interval);
    number(*pbr, "roughnessFactor", 1.0, unit_interval);
    for (const std::string_view key : {"baseColorTexture", "metallicRoughnessTexture"})
      check_texture_info(*pbr, key);
  }

  void check_attribute(const JsonNode& attributes, std::string_view key,
                       const std::set<std::string_view>& types) {
    const double accessor = index(attributes, key, counts_.accessors);
    if (errors_.first || accessor < 0.0) return;
    const std::string& type = item_value("accessors", accessor).find("type")->value.text;
    if (!types.contains(type))
      attributes.child(key)->error(fmt::format("the accessor's type does not fit (got {}, allowed {})", type,
                                               list_names({types.begin(), types.end()})));
  }

  void check_primitive(const JsonNode& node) {
    if (!node.is(JsonValue::Type::object)) return node.wrong("wrong type", "an object");
    number(node, "mode", 4.0, {0.0, 6.0, false, false, true});
    index(node, "material", counts_.materials);
    check_attribute(node, "indices", {"SCALAR"});
    const auto attributes = node.child("attributes");
    if (!attributes) return node.error("attributes is missing");
    if (!attributes->is(JsonValue::Type::object)) return attributes->wrong("wrong type", "an object");
    for (const JsonMember& member : attributes->value().members)
      index(*attributes, member.key, counts_.accessors);
    check_attribute(*attributes, "POSITION", {"VEC3"});
    check_attribute(*attributes, "NORMAL", {"VEC3"});
    check_attribute(*attributes, "TEXCOORD_0", {"VEC2"});
    check_attribute(*attributes, "TEXCOORD_1", {"VEC2"});
    for (const char set : {'0', '1', '2', '3'}) {
      check_attribute(*attributes, std::string("JOINTS_") + set, {"VEC4"});
      check_attribute(*attributes, std::string("WEIGHTS_") + set, {"VEC4"});
    }
    check_attribute(*attributes, "COLOR_0", {"VEC3", "VEC4"});
    optional_object(node, "extensions");
    if (const auto targets = node.child("targets"))
      for (const JsonNode& target : targets->as_array()) check_target(target);
  }

  void check_target(const JsonNode& node) {
    if (!node.is(JsonValue::Type::object)) return node.wrong("wrong type", "an object");
    for (const JsonMember& member : node.value().members) index(node, member.key, counts_.accessors);
    check_attribute(node, "POSITION", {"VEC3"});
    check_attribute(node, "NORMAL", {"VEC3"});
  }

  void check_skin(const JsonNode& node) {
    indices(node, "joints", counts_.nodes);
    check_attribute(node, "inverseBindMatrices", {"MAT4"});
  }

  void check_mesh(const JsonNode& node) {
    optional_string(node, "name");
    const auto primitives = node.child("primitives");
    if (!primitives) return node.error("primitives is missing");
    for (const JsonNode& primitive : primitives->as_array()) check_primitive(primitive);
    numbers(node, "weights", 0);
  }

  void check_camera(const JsonNode& node) {
    optional_string(node, "type");
    const auto perspective = node.child("perspective");
    if (!perspective) return;
    required_number(*perspective, "yfov", {0.0, pi, true, true});
    required_number(*perspective, "znear", positive_number);
  }

  void check_node(const JsonNode& node) {
    optional_string(node, "name");
    index(node, "mesh", counts_.meshes);
    index(node, "camera", counts_.cameras);
    index(node, "skin", counts_.skins);
    numbers(node, "weights", 0);
    indices(node, "children", counts_.nodes);
    numbers(node, "matrix", 16);
    numbers(node, "translation", 3);
    numbers(node, "rotation", 4);
    numbers(node, "scale", 3);
    optional_object(node, "extensions");
    const auto extensions = node.child("extensions");
    if (!extensions) return;
    if (const auto light = extensions->child("KHR_lights_punctual"))
      required_index(*light, "light", counts_.lights);
  }

  JsonErrors errors_;
  JsonNode root_;
  Counts counts_{};
};

}  // namespace

Expected<CheckedGltf> check_gltf(std::string_view bytes, const std::string& file) {
  std::string_view text = bytes;
  const bool binary = is_glb(bytes) || lower_extension(file) == ".glb";
  if (binary) {
    const auto chunks = read_glb(bytes, file);
    if (!chunks) return fail(chunks.error());
    text = chunks->json;
  }
  auto document = parse_json(text, file, !binary);
  if (!document) return fail(document.error());
  CheckedGltf checked{std::move(*document), binary, {}};
  auto error = GltfChecker(checked.document).run(checked.notes);
  if (error) return fail(std::move(*error));
  return checked;
}

}  // namespace gnomon
