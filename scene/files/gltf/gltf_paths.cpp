
#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "scene/files/gltf/gltf_accessor.h"
#include "scene/files/gltf/gltf_transforms.h"
#include "scene/files/json/json_reader.h"

namespace gnomon {
namespace {

Quaternion quaternion(const double* v) {
  return {v[3], v[0], v[1], v[2]};
}
Vec3 vector(const double* v) {
  return {v[0], v[1], v[2]};
}

/// The channels of one animation of a node.
struct Moved {
  MovedNode node;
  std::optional<KeyedNumbers> weights{};  ///< of its mesh's morph targets
};
// By the node that they move.
using MovedNodes = std::map<std::size_t, Moved>;

class AnimationReader {
 public:
  AnimationReader(const gltf::Model& model, const GltfData& data, const JsonNode& animation)
      : model_(model), data_(data), animation_(animation) {
    if (const auto list = animation.child("samplers")) samplers_ = list->as_array();
  }

  MovedNodes read() {
    MovedNodes moved;
    if (const auto channels = animation_.child("channels"))
      for (const JsonNode& channel : channels->as_array()) read_channel(channel, moved);
    return moved;
  }

 private:
  bool failed() const { return animation_.errors().first.has_value(); }

  std::size_t index(const JsonNode& owner, std::string_view key, std::size_t count) const {
    const auto node = owner.child(key);
    if (!node) {
      owner.error(fmt::format("{} is missing", key));
      return 0;
    }
    const NumberRange range{0.0, static_cast<double>(count) - 1.0, false, false, true};
    return static_cast<std::size_t>(node->as_number(range));
  }

  void read_channel(const JsonNode& channel, MovedNodes& moved) {
    const auto target = channel.child("target");
    if (!target) return channel.error("target is missing");
    if (!target->child("node")) return;  // an extension's affair
    const auto path = target->child("path");
    if (!path) return target->error("path is missing");
    const std::string what = path->as_string();
    const std::size_t node = index(*target, "node", model_.nodes.size());
    const std::size_t sampler = index(channel, "sampler", samplers_.size());
    if (failed()) return;
    if (what == "weights") return read_weights(node, samplers_[sampler], moved);
    if (what != "translation" && what != "rotation" && what != "scale") return;
    MovedNode& to = moved.try_emplace(node, Moved{stored(node)}).first->second.node;
    if (what == "translation")
      to.translations.emplace(), read_keys(samplers_[sampler], {3, 3}, vector, *to.translations);
    if (what == "scale") to.scales.emplace(), read_keys(samplers_[sampler], {3, 3}, vector, *to.scales);
    if (what == "rotation")
      to.rotations.emplace(), read_keys(samplers_[sampler], {4, 4}, quaternion, *to.rotations);
    if (what == "rotation" && !failed()) check_rotations(samplers_[sampler], *to.rotations);
  }

  /// One number for each of the mesh's targets; of a node without any they move nothing.
  void read_weights(std::size_t node, const JsonNode& sampler, MovedNodes& moved) const {
    const int mesh = model_.nodes[node].mesh;
    if (mesh < 0 || model_.meshes[static_cast<std::size_t>(mesh)].primitives.empty()) return;
    const std::size_t targets =
        model_.meshes[static_cast<std::size_t>(mesh)].primitives.front().targets.size();
    if (targets == 0) return;
    Moved& to = moved.try_emplace(node, Moved{stored(node)}).first->second;
    const auto numbers_of = [targets](const double* v) { return std::valarray<double>(v, targets); };
    read_keys(sampler, {1, targets}, numbers_of, to.weights.emplace());
  }

  MovedNode stored(std::size_t index) const {
    const gltf::Node& node = model_.nodes[index];
    MovedNode out;
    out.translation = node.translation.value_or(out.translation);
    out.scale = node.scale.value_or(out.scale);
    if (node.rotation && glm::length(quaternion(&node.rotation->x)) > 0.0)
      out.rotation = glm::normalize(quaternion(&node.rotation->x));
    return out;
  }

  std::vector<double> numbers(const JsonNode& sampler, std::string_view key, std::size_t components) const {
    const std::size_t accessor = index(sampler, key, model_.accessors.size());
    if (failed()) return {};
    const GltfAccessor from(model_, data_, static_cast<int>(accessor));
    if (from.components() != components) {
      sampler.child(key)->error(
          fmt::format("the accessor's elements do not fit (got {} numbers each, allowed {})",
                      from.components(), components));
      return {};
    }
    std::vector<double> out(from.count() * components);
    from.read(0, from.count(), out.data());
    return out;
  }

  struct KeyLayout {
    std::size_t components = 0;  ///< of an element of the accessor
    std::size_t numbers = 0;     ///< of a key's value
  };

  template <class Make, class Value>
  void read_keys(const JsonNode& sampler, const KeyLayout& layout, const Make& make,
                 Keys<Value>& keys) const {
    if (const auto choice = sampler.child("interpolation"))
      keys.interpolation = static_cast<Interpolation>(choice->as_choice({"LINEAR", "CUBICSPLINE", "STEP"}));
    keys.times = numbers(sampler, "input", 1);
    const std::vector<double> values = numbers(sampler, "output", layout.components);
    if (failed()) return;
    const bool cubic = keys.interpolation == Interpolation::cubic;
    const std::size_t each = cubic ? 3 : 1, count = keys.times.size();
    for (std::size_t i = 0; i < count; ++i)
      if (!(keys.times[i] >= 0.0) || (i > 0 && !(keys.times[i] > keys.times[i - 1])))
        return sampler.error("the times of input must not be negative, and must rise");
    if (count == 0 || values.size() != each * count * layout.numbers)
      return sampler.error(fmt::format("output does not fit input (got {} elements, allowed {})",
                                       values.size() / layout.components,
                                       each * count * layout.numbers / layout.components));
    for (const double value : values)
      if (!(std::abs(value) <= max_coordinate)) return sampler.error("output has values that are not finite");
    for (std::size_t i = 0; i < count; ++i) {  // in-tangent, value, out-tangent
      const double* at = &values[i * each * layout.numbers];
      if (cubic) keys.slopes_in.push_back(make(at));
      keys.values.push_back(make(at + (cubic ? layout.numbers : 0)));
      if (cubic) keys.slopes_out.push_back(make(at + 2 * layout.numbers));
    }
  }

  static void check_rotations(const JsonNode& sampler, const KeyedRotation& keys) {
    for (const Quaternion& value : keys.values)
      if (!(glm::length(value) > 0.0)) return sampler.error("a rotation of length 0");
  }

  const gltf::Model& model_;
  const GltfData& data_;
  const JsonNode& animation_;
  std::vector<JsonNode> samplers_;
};

class PathBuilder {
 public:
  PathBuilder(const gltf::Model& model, const CarriedNodes& carried, Scene& scene)
      : model_(model), carried_(carried), scene_(scene) {}

  /// Nothing where no node moves.
  std::optional<LoadedPath> path(const MovedNodes& moved, std::string name) {
    LoadedPath out;
    std::set<std::size_t> used;
    if (moved.empty()) return std::nullopt;
    for (const std::size_t node : carried_.cameras) out.cameras.push_back(chain(node, moved, used));
    for (std::size_t i = 0; i < carried_.lights.size(); ++i)
      if (NodeChain nodes = chain(carried_.lights[i], moved, used); !nodes.empty())
        out.lights[scene_.lights[i].name].nodes = std::move(nodes);
    out.name = std::move(name);
    for (const auto& [node, keys] : moved)
      if (holds_mesh(node)) out.objects_until = std::max(out.objects_until.value_or(0.0), last_key(keys));
    return out;
  }

 private:
  static double last_key(const Moved& moved) {
    const MovedNode& node = moved.node;
    double last = moved.weights ? moved.weights->times.back() : 0.0;
    if (node.translations) last = std::max(last, node.translations->times.back());
    if (node.scales) last = std::max(last, node.scales->times.back());
    if (node.rotations) last = std::max(last, node.rotations->times.back());
    return last;
  }

  // The node or one below it has a mesh, or is a joint of a skin.
  bool holds_mesh(std::size_t from) const {
    const auto is_joint = [&](std::size_t node) {
      return std::any_of(model_.skins.begin(), model_.skins.end(), [&](const gltf::Skin& skin) {
        return std::find(skin.joints.begin(), skin.joints.end(), node) != skin.joints.end();
      });
    };
    std::vector<std::size_t> left{from};
    while (!left.empty()) {
      const std::size_t node = left.back();
      left.pop_back();
      if (model_.nodes[node].mesh >= 0 || is_joint(node)) return true;
      left.insert(left.end(), model_.nodes[node].children.begin(), model_.nodes[node].children.end());
    }
    return false;
  }

  // Empty where no node on the way moves.
  NodeChain chain(std::size_t node, const MovedNodes& moved, std::set<std::size_t>& used) const {
    NodeChain out;
    bool any = false;
    for (int at = static_cast<int>(node); at >= 0;) {
      const auto index = static_cast<std::size_t>(at);
      at = model_.nodes[index].parent;
      const auto found = moved.find(index);
      const bool keyed = found != moved.end() && found->second.node.is_keyed();
      if (keyed) any = true, used.insert(index);
      out.push_back(keyed ? found->second.node : MovedNode{.matrix = local_matrix(model_.nodes[index])});
    }
    if (!any) return {};
    std::reverse(out.begin(), out.end());
    return out;
  }

  const gltf::Model& model_;
  const CarriedNodes& carried_;
  Scene& scene_;
};

}  // namespace

namespace {

/// each(index, name, what it moves) for every animation of the file.
template <class Each>
Expected<void> for_each_animation(const GltfDocument& document, const GltfData& data, const Each& each) {
  JsonErrors errors{document.json};
  const JsonNode root(errors, document.json.root, "");
  const auto list = root.child("animations");
  if (!list) return {};
  std::size_t index = 0;
  for (const JsonNode& animation : list->as_array()) {
    const auto name = animation.child("name");
    const std::string own = name ? name->as_string() : std::string();
    const MovedNodes moved = AnimationReader(document.model, data, animation).read();
    if (errors.first) return fail(*errors.first);
    each(own.empty() ? fmt::format("animation-{}", index) : own, moved);
    ++index;
  }
  if (errors.first) return fail(*errors.first);
  return {};
}

}  // namespace

Expected<std::vector<LoadedPath>> read_gltf_paths(const GltfDocument& document, const GltfData& data,
                                                  const CarriedNodes& carried, Scene& scene) {
  std::vector<LoadedPath> paths;
  PathBuilder builder(document.model, carried, scene);
  const auto read = for_each_animation(document, data, [&](const std::string& name, const MovedNodes& moved) {
    if (auto path = builder.path(moved, name)) paths.push_back(std::move(*path));
  });
  if (!read) return fail(read.error());
  return paths;
}

Expected<void> play_gltf_animation(GltfDocument& document, const GltfData& data, const LoadOptions& options) {
  bool found = false;
  MovedNodes played;
  const auto read = for_each_animation(document, data, [&](const std::string& name, const MovedNodes& moved) {
    if (!found && name == options.animation) found = true, played = moved;
  });
  if (!read) return read;
  if (!found) {
    Error error{ErrorKind::bad_input, fmt::format("no animation is called {}", options.animation)};
    error.file = document.json.file;
    return fail(std::move(error));
  }
  for (const auto& [index, keys] : played) {
    gltf::Node& node = document.model.nodes[index];
    if (keys.weights) {
      const std::valarray<double> weights = keys.weights->at(options.seconds);
      node.weights.assign(std::begin(weights), std::end(weights));
    }
    if (!keys.node.is_keyed()) continue;
    node.matrix = keys.node.at(options.seconds);
    node.translation.reset(), node.scale.reset(), node.rotation.reset();
  }
  return {};
}

}  // namespace gnomon
