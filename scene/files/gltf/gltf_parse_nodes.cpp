#include <algorithm>

#include "scene/files/gltf/gltf_members.h"
#include "scene/files/json/json_generate.h"

namespace gnomon::gltf {
namespace {

/// Reads meshes and what places them.
class NodeReader {
 public:
  NodeReader(const JsonNode& root, Model& model) : root_(root), model_(model) {}

  void run() {
    each("meshes", [&](const JsonNode& n) { model_.meshes.push_back(read_mesh(n)); });
    each("skins", [&](const JsonNode& n) { model_.skins.push_back(read_skin(n)); });
    each("cameras", [&](const JsonNode& n) { model_.cameras.push_back(read_camera(n)); });
    if (const auto owner = light_owner())
      gltf::each(*owner, "lights", [&](const JsonNode& n) { model_.lights.push_back(read_light(n)); });
    model_.nodes.resize(count("nodes"));
    std::size_t at = 0;
    each("nodes", [&](const JsonNode& n) { read_node(n, at++); });
    each("scenes",
         [&](const JsonNode& n) { model_.scenes.push_back(indices(n, "nodes", model_.nodes.size())); });
    model_.default_scene = index(root_, "scene", model_.scenes.size());
    if (!failed(root_)) check_cycles();
  }

 private:
  template <class Visit>
  void each(std::string_view list, const Visit& visit) const {
    gltf::each(root_, list, visit);
  }

  std::size_t count(std::string_view list) const { return gltf_list(root_.value(), list).size(); }

  // ---- meshes ----

  /// An accessor of one of these types.
  int accessor(const JsonNode& owner, std::string_view key,
               const std::vector<std::string_view>& types) const {
    const int index = gltf::index(owner, key, model_.accessors.size());
    if (index < 0) return index;
    const JsonValue& known = gltf_list(root_.value(), "accessors")[static_cast<std::size_t>(index)];
    const std::string type = text_of(&known, "type");
    if (std::find(types.begin(), types.end(), type) == types.end())
      owner.child(key)->error(
          fmt::format("the accessor's type does not fit (got {}, allowed {})", type, list_names(types)));
    return index;
  }

  Attributes attributes(const JsonNode& node) const {
    Attributes out;
    for (const JsonMember& member : node.value().members)
      out[member.key] = index(node, member.key, model_.accessors.size());
    accessor(node, "POSITION", {"VEC3"}), accessor(node, "NORMAL", {"VEC3"});
    return out;
  }

  Primitive read_primitive(const JsonNode& node) const {
    Primitive out;
    out.mode = static_cast<int>(number(node, "mode", triangles, {0.0, 6.0, false, false, true}));
    out.material = index(node, "material", count("materials"));
    out.indices = accessor(node, "indices", {"SCALAR"});
    const auto own = node.child("attributes");
    if (!own) return node.error("attributes is missing"), out;
    check_object(*own);
    out.attributes = attributes(*own);
    accessor(*own, "TEXCOORD_0", {"VEC2"}), accessor(*own, "TEXCOORD_1", {"VEC2"});
    for (const char set : {'0', '1', '2', '3'}) {
      accessor(*own, std::string("JOINTS_") + set, {"VEC4"});
      accessor(*own, std::string("WEIGHTS_") + set, {"VEC4"});
    }
    accessor(*own, "COLOR_0", {"VEC3", "VEC4"});
    out.extensions = object(node, "extensions");
    gltf::each(node, "targets", [&](const JsonNode& n) { out.targets.push_back(attributes(n)); });
    return out;
  }

  Mesh read_mesh(const JsonNode& node) const {
    Mesh out;
    out.name = string(node, "name");
    if (!node.child("primitives")) return node.error("primitives is missing"), out;
    gltf::each(node, "primitives", [&](const JsonNode& n) { out.primitives.push_back(read_primitive(n)); });
    out.weights = numbers(node, "weights", 0);
    return out;
  }

  Skin read_skin(const JsonNode& node) const {
    return {indices(node, "joints", count("nodes")), accessor(node, "inverseBindMatrices", {"MAT4"})};
  }

  // ---- cameras and lights ----

  Camera read_camera(const JsonNode& node) const {
    Camera out;
    out.name = text_of(&node.value(), "name");
    if (const auto perspective = node.child("perspective")) {
      out.vertical_fov = required_number(*perspective, "yfov", 0.5 * pi, {0.0, pi, true, true});
      required_number(*perspective, "znear", 1.0, positive_number);
    }
    const auto type = node.child("type");
    if (!type) return node.error("type is missing"), out;
    out.is_perspective = type->as_choice({"perspective", "orthographic"}) == 0;
    const auto own = node.child(type->value().text);
    if (!own) return node.error(fmt::format("{} is missing", printable(type->value().text))), out;
    check_object(*own);
    if (out.is_perspective) return out;
    required_number(*own, "xmag", 1.0);
    out.half_height = required_number(*own, "ymag", 1.0, positive_number);
    for (const std::string_view key : {"zfar", "znear"}) required_number(*own, key, 1.0);
    return out;
  }

  std::optional<JsonNode> light_owner() const {
    const auto extensions = root_.child("extensions");
    const auto owner = extensions ? extensions->child("KHR_lights_punctual") : std::nullopt;
    const bool has_list =
        owner && owner->child("lights") && owner->child("lights")->is(JsonValue::Type::array);
    return has_list ? owner : std::nullopt;
  }

  static Light read_light(const JsonNode& node) {
    Light out;
    const JsonValue& from = node.value();
    if (!node.child("type")) return node.error("type is missing"), out;
    out.type = string(node, "type");
    const auto spot = node.child("spot");
    if (out.type == "spot" && !spot) node.error("spot is missing");
    if (out.type == "spot" && spot) {
      check_object(*spot);
      out.inner_cone_angle = number_of(&spot->value(), "innerConeAngle", out.inner_cone_angle);
      out.outer_cone_angle = number_of(&spot->value(), "outerConeAngle", out.outer_cone_angle);
    }
    out.name = text_of(&from, "name");
    const auto color = numbers_of(&from, "color", {1.0, 1.0, 1.0});
    out.color = {color[0], color[1], color[2]};
    out.intensity = number_of(&from, "intensity", out.intensity);
    out.range = number_of(&from, "range", out.range);
    return out;
  }

  // ---- nodes ----

  void read_node(const JsonNode& node, std::size_t at) const {
    Node& out = model_.nodes[at];
    out.name = string(node, "name");
    out.mesh = index(node, "mesh", model_.meshes.size());
    out.camera = index(node, "camera", model_.cameras.size());
    out.skin = index(node, "skin", model_.skins.size());
    out.weights = numbers(node, "weights", 0);
    read_children(node, at);
    read_transform(node, out);
    out.extensions = object(node, "extensions");
    out.casts_shadow = shadow_flag(node.value(), "casts_shadow");
    out.receives_shadow = shadow_flag(node.value(), "receives_shadow");
    const auto extensions = node.child("extensions");
    if (!extensions) return;
    if (const auto light = extensions->child("KHR_lights_punctual"))
      out.light = required_index(*light, "light", model_.lights.size());
    out.visible = flag_of(extension(out.extensions, "KHR_node_visibility"), "visible", true);
  }

  void read_children(const JsonNode& node, std::size_t at) const {
    model_.nodes[at].children = indices(node, "children", model_.nodes.size());
    if (failed(root_)) return;
    for (std::size_t i = 0; i < model_.nodes[at].children.size(); ++i) {
      const std::size_t child = model_.nodes[at].children[i];
      int& parent = model_.nodes[child].parent;
      if (parent >= 0)
        node.child("children")
            ->as_array()[i]
            .error(fmt::format("node {} has two parents ({} and {})", child, parent, at));
      parent = static_cast<int>(at);
    }
  }

  static void read_transform(const JsonNode& node, Node& out) {
    const auto matrix = numbers(node, "matrix", 16);
    const auto translation = numbers(node, "translation", 3);
    const auto rotation = numbers(node, "rotation", 4);
    const auto scale = numbers(node, "scale", 3);
    if (!matrix.empty()) {
      Mat4& m = out.matrix.emplace();
      for (std::size_t i = 0; i < matrix.size(); ++i)
        m[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = matrix[i];
      return;
    }
    if (!translation.empty()) out.translation.emplace(translation[0], translation[1], translation[2]);
    if (!rotation.empty()) out.rotation.emplace(rotation[0], rotation[1], rotation[2], rotation[3]);
    if (!scale.empty()) out.scale.emplace(scale[0], scale[1], scale[2]);
  }

  /// Where everyone has one parent at most, the nodes that no walk from the roots meets are those on and below cycles.
  void check_cycles() const {
    std::vector<bool> met(model_.nodes.size(), false);
    std::vector<std::size_t> stack;
    for (std::size_t i = 0; i < met.size(); ++i)
      if (model_.nodes[i].parent < 0) stack.push_back(i);
    while (!stack.empty()) {
      const std::size_t at = stack.back();
      stack.pop_back();
      met[at] = true;
      stack.insert(stack.end(), model_.nodes[at].children.begin(), model_.nodes[at].children.end());
    }
    const auto missed = std::find(met.begin(), met.end(), false);
    if (missed != met.end())
      root_.child("nodes")->as_array()[static_cast<std::size_t>(missed - met.begin())].error(
          "the node is its own ancestor, or below one (a cycle of children)");
  }

  const JsonNode& root_;
  Model& model_;
};

}  // namespace

int attribute(const Attributes& attributes, std::string_view name) {
  const auto found = attributes.find(name);
  return found == attributes.end() ? -1 : found->second;
}

void read_nodes(const JsonNode& root, Model& model) {
  NodeReader(root, model).run();
}

}  // namespace gnomon::gltf
