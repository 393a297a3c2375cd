// glTF 2.0 and GLB: checked by gltf_check, parsed by tinygltf, brought into the scene model here. One
// instance for each node with a mesh; lights by KHR_lights_punctual in their own units (lux, candela); the
// first perspective camera.
#include <fmt/format.h>
#include <tiny_gltf.h>

#include <exception>
#include <filesystem>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <map>
#include <set>

#include "scene/files/defaults.h"
#include "scene/files/formats.h"
#include "scene/files/gltf_check.h"
#include "scene/files/gltf_extras.h"
#include "scene/files/gltf_materials.h"
#include "scene/files/gltf_meshes.h"
#include "scene/files/gltf_repair.h"
#include "scene/files/read_file.h"
#include "scene/files/validate.h"

namespace gnomon {
namespace {

Error gltf_error(const std::string& file, std::string field, std::string reason) {
  return {ErrorKind::bad_input, std::move(reason), file, 0, 0, std::move(field)};
}

// ---- parsing ----

// What tinygltf asks of the file system: whole files, by plain paths (its own callbacks would let a shell
// expand them).
struct FileAccess {
  std::string folder;
  const LoadOptions& options;
  std::string problem;
};

std::optional<std::string> allowed_path(FileAccess& access, const std::string& path) {
  const auto relative = std::filesystem::path(path).lexically_relative(access.folder).string();
  const auto allowed = resolve_path(access.folder, relative.empty() ? path : relative, access.options);
  if (allowed) return *allowed;
  access.problem = allowed.error().reason;
  return std::nullopt;
}

tinygltf::FsCallbacks file_callbacks(FileAccess& access) {
  tinygltf::FsCallbacks callbacks{};
  callbacks.FileExists = [](const std::string& path, void*) {
    std::error_code ignored;
    return std::filesystem::is_regular_file(path, ignored);
  };
  callbacks.ExpandFilePath = [](const std::string& path, void*) { return path; };
  callbacks.ReadWholeFile = [](std::vector<unsigned char>* out, std::string* error, const std::string& path,
                               void* user) {
    const auto allowed = allowed_path(*static_cast<FileAccess*>(user), path);
    if (!allowed) return false;
    const auto bytes = read_file(*allowed);
    if (!bytes) {
      if (error) *error += bytes.error().reason;
      return false;
    }
    out->assign(bytes->begin(), bytes->end());
    return true;
  };
  callbacks.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
    return false;
  };
  callbacks.user_data = &access;
  return callbacks;
}

// Images stay encoded: only those that a material uses are decoded, through image_io.
bool keep_encoded(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
                  const unsigned char* bytes, int size, void*) {
  image->image.assign(bytes, bytes + size);
  image->as_is = true;
  return true;
}

std::string one_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.empty() ? "unknown reason" : text;
}

Expected<void> parse(tinygltf::Model& model, std::string_view bytes, bool binary, const std::string& file,
                     const std::string& folder, const LoadOptions& options) {
  FileAccess access{folder, options, {}};
  tinygltf::TinyGLTF loader;
  loader.SetFsCallbacks(file_callbacks(access));
  loader.SetImageLoader(&keep_encoded, nullptr);
  std::string errors, warnings;
  const auto length = static_cast<unsigned int>(bytes.size());
  const bool done =
      binary
          ? loader.LoadBinaryFromMemory(&model, &errors, &warnings,
                                        reinterpret_cast<const unsigned char*>(bytes.data()), length, folder)
          : loader.LoadASCIIFromString(&model, &errors, &warnings, bytes.data(), length, folder);
  if (!access.problem.empty()) return fail(gltf_error(file, "uri", access.problem));
  const bool is_file = errors.starts_with("File ");  // a buffer's: images that are missing are no error yet
  if (!done || !errors.empty()) return fail(gltf_error(file, is_file ? "buffers" : "", one_line(errors)));
  return {};
}

// ---- nodes ----

Mat4 local_matrix(const tinygltf::Node& node) {
  Mat4 matrix(1.0);
  if (node.matrix.size() == 16) {
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
    return matrix;
  }
  if (node.translation.size() == 3)
    matrix = glm::translate(matrix, Vec3(node.translation[0], node.translation[1], node.translation[2]));
  if (node.rotation.size() == 4) {
    const glm::dquat q(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    const double length = glm::length(q);
    if (length > 0.0) matrix *= glm::mat4_cast(q / length);
  }
  if (node.scale.size() == 3) matrix = glm::scale(matrix, Vec3(node.scale[0], node.scale[1], node.scale[2]));
  return matrix;
}

// What is of length one up to rounding stays as it is, so that a file that is written anew says the same.
Vec3 unit(const Vec3& v) {
  constexpr double rounding = 16.0 * std::numeric_limits<double>::epsilon();
  return std::abs(glm::dot(v, v) - 1.0) <= rounding ? v : glm::normalize(v);
}

class SceneBuilder {
 public:
  SceneBuilder(LoadedFile& loaded, const tinygltf::Model& model, const GltfExtras& extras,
               std::vector<Mesh> meshes)
      : loaded_(loaded),
        scene_(loaded.scene),
        model_(model),
        extras_(extras),
        meshes_(std::move(meshes)),
        our_mesh_(meshes_.size(), no_id) {}

  void run() {
    for (const int root : roots()) visit_from(root);
    if (orthographic_) note("An orthographic camera was skipped: only perspective is supported.");
    if (flattened_ > 0)
      note(fmt::format("{} node(s) that flatten their mesh to nothing (a scale of 0) were skipped.",
                       flattened_));
    if (ranged_)
      note("The range of lights is not used: their light falls off with the squared distance alone.");
    if (skinned_) note("Skins are not applied: meshes are shown as they are stored.");
    if (!model_.animations.empty()) note("Animations are not played.");
    if (instanced_) note("EXT_mesh_gpu_instancing is not supported: those meshes are shown once.");
    const Aabb bounds = loaded_.cameras.empty() ? Aabb{} : scene_bounds(scene_);
    for (std::size_t i = 0; i < loaded_.cameras.size(); ++i) {
      place_target(loaded_.cameras[i].camera, bounds);
      extras_.read_camera(gltf_cameras_[i], loaded_.cameras[i].camera);
    }
  }

 private:
  struct Visit {
    int node;
    Mat4 world_from_parent;
  };

  void note(std::string text) { scene_.notes.push_back(std::move(text)); }

  // The default scene, or the first, or every node without a parent.
  std::vector<int> roots() {
    if (!model_.scenes.empty()) {
      const std::size_t index = model_.defaultScene >= 0 ? static_cast<std::size_t>(model_.defaultScene) : 0;
      if (model_.scenes.size() > 1)
        note(fmt::format("Scene {} of {} is shown.", index, model_.scenes.size()));
      return model_.scenes[index].nodes;
    }
    std::set<int> all;
    for (std::size_t i = 0; i < model_.nodes.size(); ++i) all.insert(static_cast<int>(i));
    for (const tinygltf::Node& node : model_.nodes)
      for (const int child : node.children) all.erase(child);
    return {all.begin(), all.end()};
  }

  // Depth first, in the file's order, with a stack of its own: a long chain of nodes cannot overflow the
  // program's.
  void visit_from(int root) {
    std::vector<Visit> stack{{root, Mat4(1.0)}};
    while (!stack.empty()) {
      const Visit visit = stack.back();
      stack.pop_back();
      const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(visit.node)];
      const Mat4 world = visit.world_from_parent * local_matrix(node);
      if (node.mesh >= 0) add_instance(node, visit.node, world);
      if (node.camera >= 0) add_camera(node, world);
      add_light(node, world);
      for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
        stack.push_back({*child, world});
    }
  }

  void add_instance(const tinygltf::Node& node, int index, const Mat4& world) {
    const auto from = static_cast<std::size_t>(node.mesh);
    if (node.skin >= 0) skinned_ = true;
    if (node.extensions.contains("EXT_mesh_gpu_instancing")) instanced_ = true;
    if (meshes_[from].triangles.empty()) return;
    if (is_singular(Mat3(world))) {
      ++flattened_;
      return;
    }
    if (our_mesh_[from] == no_id) {
      our_mesh_[from] = static_cast<std::uint32_t>(scene_.meshes.size());
      scene_.meshes.push_back(meshes_[from]);
    }
    const std::string name = !node.name.empty() ? node.name : fmt::format("node-{}", index);
    scene_.instances.push_back({name, our_mesh_[from], world, 0});
  }

  void add_camera(const tinygltf::Node& node, const Mat4& world) {
    const tinygltf::Camera& from = model_.cameras[static_cast<std::size_t>(node.camera)];
    if (from.type != "perspective") {
      orthographic_ = true;
      return;
    }
    const Vec3 forward = Vec3(world * Vec4(0.0, 0.0, -1.0, 0.0));
    const Vec3 up = Vec3(world * Vec4(0.0, 1.0, 0.0, 0.0));
    if (!(glm::length(forward) > 0.0) || !(glm::length(up) > 0.0))
      return note("A camera whose node flattens it was skipped.");
    NamedCamera named;
    named.name = !node.name.empty()   ? node.name
                 : !from.name.empty() ? from.name
                                      : fmt::format("camera-{}", loaded_.cameras.size());
    named.camera.eye = Vec3(world[3]);
    named.camera.target = named.camera.eye + unit(forward);
    named.camera.up = unit(up);
    named.camera.vertical_fov = from.perspective.yfov;
    loaded_.cameras.push_back(std::move(named));
    gltf_cameras_.push_back(static_cast<std::size_t>(node.camera));
  }

  // Straight ahead, as far away as the middle of the scene is: what a viewer turns around.
  static void place_target(Camera& camera, const Aabb& bounds) {
    const Vec3 forward = camera.target - camera.eye;
    const double ahead = bounds.empty() ? 0.0 : glm::dot(bounds.center() - camera.eye, forward);
    if (ahead > 0.0) camera.target = camera.eye + ahead * forward;
  }

  void add_light(const tinygltf::Node& node, const Mat4& world) {
    const auto found = node.extensions.find("KHR_lights_punctual");
    if (found == node.extensions.end() || !found->second.Has("light")) return;
    const auto index = static_cast<std::size_t>(found->second.Get("light").GetNumberAsInt());
    if (index >= model_.lights.size()) return;
    const tinygltf::Light& from = model_.lights[index];
    Light light;
    if (from.type == "point")
      light.type = LightType::point;
    else if (from.type == "spot")
      light.type = LightType::spot;
    else if (from.type != "directional")
      return note(fmt::format("A light of unknown type '{}' was skipped.", from.type));
    const Vec3 direction = Vec3(world * Vec4(0.0, 0.0, -1.0, 0.0));
    if (!(glm::length(direction) > 0.0)) return note("A light whose node flattens it was skipped.");
    light.direction = unit(direction);
    light.position = Vec3(world[3]);
    const Vec3 tint = from.color.size() >= 3 ? Vec3(from.color[0], from.color[1], from.color[2]) : Vec3(1.0);
    light.intensity = Vec3f(tint * from.intensity);
    if (from.range > 0.0) ranged_ = true;
    if (light.type == LightType::spot) set_cone(light, from);
    light.name = unique_name(!node.name.empty() ? node.name : !from.name.empty() ? from.name : from.type);
    extras_.read_light(index, light);
    light_names_.insert(light.name);
    scene_.lights.push_back(std::move(light));
  }

  void set_cone(Light& light, const tinygltf::Light& from) {
    constexpr double widest = 0.5 * pi - 1e-3;  // our spots end before a right angle
    light.outer_angle = std::clamp(from.spot.outerConeAngle, 1e-3, widest);
    light.inner_angle = std::max(0.0, from.spot.innerConeAngle);
    if (light.inner_angle >= light.outer_angle) light.inner_angle = std::max(0.0, light.outer_angle - 1e-4);
    if (light.outer_angle != from.spot.outerConeAngle || light.inner_angle != from.spot.innerConeAngle)
      note(fmt::format("The cone of a spot light was narrowed to half-angles of {:.3f} and {:.3f} degrees.",
                       light.inner_angle * 180.0 / pi, light.outer_angle * 180.0 / pi));
  }

  std::string unique_name(const std::string& wanted) {
    std::string name = wanted;
    for (int& n = next_number_.try_emplace(wanted, 2).first->second; light_names_.contains(name); ++n)
      name = fmt::format("{}-{}", wanted, n);
    return name;
  }

  LoadedFile& loaded_;
  Scene& scene_;
  const tinygltf::Model& model_;
  const GltfExtras& extras_;
  std::vector<Mesh> meshes_;
  std::vector<std::uint32_t> our_mesh_;    // of a glTF mesh, once an instance uses it
  std::vector<std::size_t> gltf_cameras_;  // of loaded_.cameras
  std::set<std::string> light_names_;
  std::map<std::string, int> next_number_;  // behind a light's name that is taken
  int flattened_ = 0;
  bool orthographic_ = false, ranged_ = false, skinned_ = false, instanced_ = false;
};

Expected<LoadedFile> build(const tinygltf::Model& model, CheckedGltf checked, const std::string& file) {
  LoadedFile loaded;
  loaded.is_model = true;
  loaded.scene.notes = std::move(checked.notes);
  JsonErrors errors{checked.document};
  const GltfExtras extras(errors, checked.document.root);
  const auto sets = add_gltf_materials(loaded.scene, model, file);
  if (!sets) return fail(sets.error());
  for (std::size_t i = 0; i < loaded.scene.materials.size(); ++i)
    extras.read_material(i, loaded.scene.materials[i]);
  const auto default_material = static_cast<std::uint32_t>(loaded.scene.materials.size());
  loaded.scene.materials.push_back(model_material("default"));
  auto meshes = read_gltf_meshes(loaded.scene, model, *sets, default_material, file);
  if (!meshes) return fail(meshes.error());
  SceneBuilder(loaded, model, extras, std::move(meshes->meshes)).run();
  extras.read_scene(loaded.scene);
  if (errors.first) return fail(std::move(*errors.first));
  if (loaded.scene.instances.empty() && !meshes->skipped_points)
    return fail(gltf_error(file, "", "the file has no triangles"));
  if (loaded.scene.instances.empty())
    loaded.scene.notes.push_back("The file has no triangles: only what was made for it is shown.");
  return loaded;
}

}  // namespace

Expected<LoadedFile> read_gltf(std::string_view bytes, const std::string& file, const std::string& folder,
                               const LoadOptions& options) try {
  auto checked = check_gltf(bytes, file);
  if (!checked) return fail(checked.error());
  tinygltf::Model model;
  const auto repaired = repaired_gltf(*checked, bytes, folder, options);
  const auto parsed =
      parse(model, repaired ? std::string_view(*repaired) : bytes, checked->is_binary, file, folder, options);
  if (!parsed) return fail(parsed.error());
  return build(model, std::move(*checked), file);
} catch (const std::bad_alloc&) {
  throw;                             // load_scene answers for memory
} catch (const std::exception& e) {  // tinygltf's JSON library throws on what its checks forget
  return fail(gltf_error(file, "", one_line(e.what())));
}

}  // namespace gnomon
