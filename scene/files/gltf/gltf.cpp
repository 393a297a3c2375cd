// glTF 2.0 and GLB: read by parse_gltf, brought into the scene model here. One instance for each
// node with a mesh, or as many as EXT_mesh_gpu_instancing says; lights by KHR_lights_punctual in their own units (lux,
// candela); the first perspective camera.
#include <fmt/core.h>

#include <exception>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <map>
#include <set>

#include "scene/base/threads.h"
#include "scene/files/defaults.h"
#include "scene/files/formats.h"
#include "scene/files/gltf/gltf_data.h"
#include "scene/files/gltf/gltf_extras.h"
#include "scene/files/gltf/gltf_materials.h"
#include "scene/files/gltf/gltf_meshes.h"
#include "scene/files/gltf/gltf_model.h"
#include "scene/files/gltf/gltf_transforms.h"
#include "scene/files/gltf/gltf_value.h"
#include "scene/files/read_file.h"
#include "scene/files/repeated_instances.h"
#include "scene/files/shadow_variants.h"
#include "scene/files/validate.h"

namespace gnomon {
namespace {

Error gltf_error(const std::string& file, std::string field, std::string reason) {
  return {ErrorKind::bad_input, std::move(reason), file, 0, 0, std::move(field)};
}

// ---- nodes ----

/// Twice its area beside the square of its longest edge: less is a line up to the rounding of the transform.
constexpr double narrowest_share = 1e-12;

bool has_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, bc = c - b;
  const double longest = std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(bc, bc)});
  return glm::length(glm::cross(ab, ac)) > narrowest_share * longest;
}

/// The mesh as a transform without inverse leaves it (a scale of 0 along one axis), in the world. What becomes a line or a
/// point is left out, normals are the triangles' own.
Mesh flattened(const Mesh& mesh, const Mat4& world_from_object) {
  Mesh out = mesh;
  out.normals.clear(), out.triangles.clear(), out.triangle_materials.clear();
  for (Vec3& p : out.positions) p = Vec3(world_from_object * Vec4(p, 1.0));
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto [a, b, c] = mesh.triangles[i];
    if (!has_area(out.positions[a], out.positions[b], out.positions[c])) continue;
    out.triangles.push_back(mesh.triangles[i]);
    if (!mesh.triangle_materials.empty()) out.triangle_materials.push_back(mesh.triangle_materials[i]);
  }
  return out;
}

// What is of length one up to rounding stays as it is, so that a file that is written again says the same.
Vec3 unit_vector(const Vec3& v) {
  constexpr double rounding = 16.0 * std::numeric_limits<double>::epsilon();
  return std::abs(glm::dot(v, v) - 1.0) <= rounding ? v : glm::normalize(v);
}

class SceneBuilder {
 public:
  SceneBuilder(LoadedFile& loaded, const GltfDocument& document, const GltfData& data,
               const GltfExtras& extras, GltfMeshReader& meshes)
      : loaded_(loaded),
        scene_(loaded.scene),
        json_(document.json),
        model_(document.model),
        data_(data),
        extras_(extras),
        meshes_(meshes) {}

  const CarriedNodes& carried() const { return carried_; }

  Expected<void> run() {
    for (const std::size_t root : roots())
      if (const auto visited = visit_from(root); !visited) return visited;
    if (flattened_ > 0)
      note(fmt::format("{} node(s) that leave a line or a point of their mesh (scales of 0) were skipped.",
                       flattened_));
    if (ranged_)
      note("The range of lights is not used: their light falls off with the squared distance alone.");
    meshes_.add_notes(scene_);
    if (scene_.lights.empty() && !model_.lights.empty()) loaded_.why_none = why_no_light();
    const Aabb bounds = loaded_.cameras.empty() ? Aabb{} : scene_bounds(scene_);
    for (std::size_t i = 0; i < loaded_.cameras.size(); ++i) {
      place_target(loaded_.cameras[i].camera, bounds);
      extras_.read_camera(gltf_cameras_[i], loaded_.cameras[i].camera);
    }
    return {};
  }

 private:
  struct Visit {
    std::size_t node;
    Mat4 world_from_parent;
  };

  void note(std::string text) { scene_.notes.push_back(std::move(text)); }

  /// Of lights that the file has and the scene has not. What was skipped has a note of its own.
  std::string why_no_light() const {
    if (skipped_light_) return "none of the file's lights can be used";
    return hides_light_ ? "the file hides its lights (KHR_node_visibility)"
                        : "no node that is shown has one of the file's lights";
  }

  bool has_light_below(std::size_t node) const {
    std::vector<std::size_t> stack{node};
    while (!stack.empty()) {
      const gltf::Node& one = model_.nodes[stack.back()];
      stack.pop_back();
      if (one.light >= 0) return true;
      stack.insert(stack.end(), one.children.begin(), one.children.end());
    }
    return false;
  }

  // The default scene, or the first, or every node without a parent.
  std::vector<std::size_t> roots() {
    if (!model_.scenes.empty()) {
      const auto index = static_cast<std::size_t>(std::max(model_.default_scene, 0));
      if (model_.scenes.size() > 1)
        note(fmt::format("Scene {} of {} is shown.", index, model_.scenes.size()));
      return model_.scenes[index];
    }
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < model_.nodes.size(); ++i)
      if (model_.nodes[i].parent < 0) out.push_back(i);
    return out;
  }

  // Depth first, in the file's order, with a stack of its own: a long chain of nodes cannot overflow the
  // program's.
  Expected<void> visit_from(std::size_t root) {
    std::vector<Visit> stack{{root, Mat4(1.0)}};
    while (!stack.empty()) {
      const Visit visit = stack.back();
      stack.pop_back();
      const gltf::Node& node = model_.nodes[visit.node];
      if (!node.visible) {  // KHR_node_visibility: nor is what is below it
        hides_light_ = hides_light_ || has_light_below(visit.node);
        continue;
      }
      const Mat4 world = visit.world_from_parent * local_matrix(node);
      if (node.mesh >= 0)
        if (const auto added = add_mesh(node, visit.node, world); !added) return added;
      if (node.camera >= 0) add_camera(node, visit.node, world);
      add_light(node, visit.node, world);
      for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
        stack.push_back({*child, world});
    }
    return {};
  }

  /// A mesh of the scene, and its instances' material.
  struct PosedMesh {
    std::uint32_t mesh = no_id, material = 0;
  };

  /// The mesh in the node's pose, read when the first node asks for it; no_id: it has no triangles.
  Expected<PosedMesh> posed_mesh(const gltf::Node& node) {
    const auto index = static_cast<std::size_t>(node.mesh);
    GltfPose pose{node.weights.empty() ? model_.meshes[index].weights : node.weights};
    const auto [known, is_new] = our_mesh_.try_emplace({node.mesh, skin_of(node), pose.weights});
    if (!is_new) return known->second;
    if (skin_of(node) >= 0) {
      if (node_transforms_.empty()) node_transforms_ = node_transforms(model_);
      pose.joints = joint_transforms(model_.skins[static_cast<std::size_t>(node.skin)], node_transforms_,
                                     model_, data_);
    }
    auto read = meshes_.read(index, pose);
    if (!read) return fail(read.error());
    if (read->mesh.triangles.empty()) return PosedMesh{};
    known->second = {static_cast<std::uint32_t>(scene_.meshes.size()), read->material};
    scene_.meshes.push_back(std::move(read->mesh));
    return known->second;
  }

  /// -1 where no primitive of the mesh is bound to it.
  int skin_of(const gltf::Node& node) const {
    const auto& primitives = model_.meshes[static_cast<std::size_t>(node.mesh)].primitives;
    const bool bound = std::any_of(primitives.begin(), primitives.end(), [](const gltf::Primitive& p) {
      return p.attributes.contains("JOINTS_0") && p.attributes.contains("WEIGHTS_0");
    });
    return bound ? node.skin : -1;
  }

  Expected<void> add_mesh(const gltf::Node& node, std::size_t index, const Mat4& world) {
    const auto mesh = posed_mesh(node);
    if (!mesh) return fail(mesh.error());
    if (mesh->mesh == no_id) return {};
    const std::string name = !node.name.empty() ? node.name : fmt::format("node-{}", index);
    const std::size_t first = scene_.instances.size();
    const auto placed = place_mesh(node, index, name, *mesh, world);
    for (std::size_t i = first; i < scene_.instances.size(); ++i)
      shadow_variants_.apply({node.casts_shadow, node.receives_shadow}, scene_, scene_.instances[i]);
    return placed;
  }

  Expected<void> place_mesh(const gltf::Node& node, std::size_t index, const std::string& name,
                            const PosedMesh& mesh, const Mat4& world) {
    if (skin_of(node) >= 0)  // in the world already
      add_instance(name, mesh, Mat4(1.0));
    else if (const JsonValue* instancing = extension(node.extensions, "EXT_mesh_gpu_instancing"))
      return add_instances(name, mesh, world, *instancing, index);
    else
      add_instance(name, mesh, world);
    return {};
  }

  void add_instance(const std::string& name, const PosedMesh& mesh, const Mat4& world) {
    if (is_singular(Mat3(world)))
      add_sheet(name, mesh, world);
    else
      scene_.instances.push_back({name, mesh.mesh, world, mesh.material});
  }

  /// A transform without inverse: a mesh of its own.
  void add_sheet(const std::string& name, const PosedMesh& mesh, const Mat4& world) {
    Mesh sheet = flattened(scene_.meshes[mesh.mesh], world);
    if (sheet.triangles.empty()) {
      ++flattened_;
      return;
    }
    scene_.instances.push_back(
        {name, static_cast<std::uint32_t>(scene_.meshes.size()), Mat4(1.0), mesh.material});
    scene_.meshes.push_back(std::move(sheet));
  }

  Expected<void> add_instances(const std::string& name, const PosedMesh& mesh, const Mat4& world,
                               const JsonValue& instancing, std::size_t node) {
    const auto places = gltf_instances(model_, data_, instancing);
    if (!places)
      return fail(gltf_error(json_.file, fmt::format("nodes[{}].extensions.EXT_mesh_gpu_instancing", node),
                             places.error().reason));
    for (std::size_t i = 0; i < places->size(); ++i)
      add_instance(fmt::format("{}-{}", name, i), mesh, world * (*places)[i]);
    return {};
  }

  void add_camera(const gltf::Node& node, std::size_t index, const Mat4& world) {
    const gltf::Camera& from = model_.cameras[static_cast<std::size_t>(node.camera)];
    const Vec3 forward = Vec3(world * Vec4(0.0, 0.0, -1.0, 0.0));
    const Vec3 up = Vec3(world * Vec4(0.0, 1.0, 0.0, 0.0));
    if (!(glm::length(forward) > 0.0) || !(glm::length(up) > 0.0))
      return note("A camera whose node flattens it was skipped.");
    NamedCamera named;
    named.name = !node.name.empty()   ? node.name
                 : !from.name.empty() ? from.name
                                      : fmt::format("camera-{}", loaded_.cameras.size());
    named.camera.eye = Vec3(world[3]);
    named.camera.target = named.camera.eye + unit_vector(forward);
    named.camera.up = unit_vector(up);
    if (from.is_perspective)
      named.camera.vertical_fov = from.vertical_fov;
    else
      named.camera.orthographic_height = 2.0 * from.half_height;
    loaded_.cameras.push_back(std::move(named));
    gltf_cameras_.push_back(static_cast<std::size_t>(node.camera));
    carried_.cameras.push_back(index);
  }

  // Straight ahead, as far away as the middle of the scene is: what a viewer turns around.
  static void place_target(Camera& camera, const Aabb& bounds) {
    const Vec3 forward = camera.target - camera.eye;
    const double ahead = bounds.empty() ? 0.0 : glm::dot(bounds.center() - camera.eye, forward);
    if (ahead > 0.0) camera.target = camera.eye + ahead * forward;
  }

  void add_light(const gltf::Node& node, std::size_t at, const Mat4& world) {
    if (node.light < 0) return;
    const auto index = static_cast<std::size_t>(node.light);
    const gltf::Light& from = model_.lights[index];
    Light light;
    if (from.type == "point")
      light.type = LightType::point;
    else if (from.type == "spot")
      light.type = LightType::spot;
    else if (from.type != "directional")
      return skip_light(fmt::format("A light of unknown type '{}' was skipped.", from.type));
    const Vec3 direction = Vec3(world * Vec4(0.0, 0.0, -1.0, 0.0));
    if (!(glm::length(direction) > 0.0)) return skip_light("A light whose node flattens it was skipped.");
    light.direction = unit_vector(direction);
    light.position = Vec3(world[3]);
    light.intensity = Vec3f(from.color * from.intensity);
    if (from.range > 0.0) ranged_ = true;
    if (light.type == LightType::spot) set_cone(light, from);
    light.name = unique_name(!node.name.empty() ? node.name : !from.name.empty() ? from.name : from.type);
    extras_.read_light(index, light);
    light_names_.insert(light.name);
    carried_.lights.push_back(at);
    scene_.lights.push_back(std::move(light));
  }

  void skip_light(std::string why) {
    skipped_light_ = true;
    note(std::move(why));
  }

  void set_cone(Light& light, const gltf::Light& from) {
    constexpr double widest = 0.5 * pi - 1e-3;  // our spots end before a right angle
    light.outer_angle = std::clamp(from.outer_cone_angle, 1e-3, widest);
    light.inner_angle = std::max(0.0, from.inner_cone_angle);
    if (light.inner_angle >= light.outer_angle) light.inner_angle = std::max(0.0, light.outer_angle - 1e-4);
    note_cone(light, from);
  }

  void note_cone(const Light& light, const gltf::Light& from) {
    const double inner = light.inner_angle * 180.0 / pi, outer = light.outer_angle * 180.0 / pi;
    const auto changed = [](double to, double was) { return to > was ? "widened" : "narrowed"; };
    if (light.outer_angle != from.outer_cone_angle)
      note(fmt::format("The cone of a spot light was {} to half-angles of {:.3f} and {:.3f} degrees.",
                       changed(light.outer_angle, from.outer_cone_angle), inner, outer));
    else if (light.inner_angle != from.inner_cone_angle)
      note(fmt::format(
          "The inner cone of a spot light was {} to a half-angle of {:.3f} degrees, within {:.3f}.",
          changed(light.inner_angle, from.inner_cone_angle), inner, outer));
  }

  std::string unique_name(const std::string& wanted) {
    std::string name = wanted;
    for (int& n = next_number_.try_emplace(wanted, 2).first->second; light_names_.contains(name); ++n)
      name = fmt::format("{}-{}", wanted, n);
    return name;
  }

  LoadedFile& loaded_;
  Scene& scene_;
  const JsonDocument& json_;
  const gltf::Model& model_;
  const GltfData& data_;
  const GltfExtras& extras_;
  GltfMeshReader& meshes_;
  std::vector<Mat4> node_transforms_;                                        // once a skin needs them
  std::map<std::tuple<int, int, std::vector<double>>, PosedMesh> our_mesh_;  // by mesh, skin and weights
  std::vector<std::size_t> gltf_cameras_;                                    // of loaded_.cameras
  CarriedNodes carried_;
  std::set<std::string> light_names_;
  std::map<std::string, int> next_number_;  // behind a light's name that is taken
  int flattened_ = 0;
  bool ranged_ = false, hides_light_ = false, skipped_light_ = false;
  ShadowVariants shadow_variants_;
};

/// Where a primitive's accessor has no data, not even packed, it is all zeros: not without limit.
std::optional<Error> empty_accessor_defect(const gltf::Model& model, const std::string& file) {
  constexpr std::size_t most = 16777216;
  for (std::size_t i = 0; i < model.accessors.size(); ++i)
    if (model.accessors[i].view < 0 && model.accessors[i].count > most)
      return gltf_error(file, fmt::format("accessors[{}].count", i),
                        fmt::format("no data stands behind these elements (got {}, allowed up to {} without "
                                    "bufferView)",
                                    model.accessors[i].count, most));
  return std::nullopt;
}

Expected<LoadedFile> build(GltfDocument& document, GltfData& data, const LoadOptions& options) {
  LoadedFile loaded;
  loaded.is_model = true;
  loaded.scene.notes = std::move(document.notes);
  JsonErrors errors{document.json};
  const GltfExtras extras(errors, document.json.root);
  const auto sets = add_gltf_materials(loaded.scene, document.json, data);
  if (!sets) return fail(sets.error());
  for (std::size_t i = 0; i < loaded.scene.materials.size(); ++i)
    extras.read_material(i, loaded.scene.materials[i]);
  const auto default_material = static_cast<std::uint32_t>(loaded.scene.materials.size());
  loaded.scene.materials.push_back(model_material("default"));
  loaded.scene.materials.back().double_sided = false;  // glTF 2.0, section 3.9.6
  const std::string& file = document.json.file;
  GltfMeshReader meshes(document.model, data, *sets, default_material, file);
  SceneBuilder builder(loaded, document, data, extras, meshes);
  if (const auto built = builder.run(); !built) return fail(built.error());
  if (options.paths == nullptr && options.animation.empty() &&
      !gltf_list(document.json.root, "animations").empty())
    loaded.scene.notes.push_back(
        "Animations are not played: all stands as it is stored. --time SECONDS shows a moment, gnomon "
        "shimmer "
        "plays them.");
  if (options.paths != nullptr) {
    auto paths = read_gltf_paths(document, data, builder.carried(), loaded.scene);
    if (!paths) return fail(paths.error());
    loaded.paths = std::move(*paths);
  }
  leave_out_repeated_instances(loaded.scene);
  extras.read_scene(loaded.scene);
  if (errors.first) return fail(std::move(*errors.first));
  if (loaded.scene.instances.empty() && !meshes.skipped_points())
    return fail(gltf_error(file, "", "the file has no triangles"));
  loaded.scene.is_empty_model = loaded.scene.instances.empty();
  if (loaded.scene.is_empty_model)
    loaded.scene.notes.push_back("The file has no triangles: only what was made for it is shown.");
  return loaded;
}

}  // namespace

Expected<LoadedFile> read_gltf(std::string_view bytes, const std::string& file, const std::string& folder,
                               const LoadOptions& options) try {
  auto document = parse_gltf(bytes, file);
  if (!document) return fail(document.error());
  auto data = GltfData::open(*document, bytes, folder, options);
  if (!data) return fail(data.error());
  if (const auto unpacked = unpack_draco(*document, *data); !unpacked) return fail(unpacked.error());
  if (auto defect = empty_accessor_defect(document->model, file)) return fail(std::move(*defect));
  if (!options.animation.empty())
    if (const auto played = play_gltf_animation(*document, *data, options); !played)
      return fail(played.error());
  return build(*document, *data, options);
} catch (const std::exception& e) {  // the libraries' own, on what the checks forget
  if (is_of_resource(e)) throw;      // whoever asked answers for memory and threads
  return fail(gltf_error(file, "", printable(e.what(), 200)));
}

}  // namespace gnomon
