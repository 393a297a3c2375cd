// A file of the fuzzer's bytes through the loaders, and what must hold of whatever comes out.
#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include "fuzz_target.h"
#include "scene/load.h"
#include "scene/world.h"

namespace gnomon::fuzz {
namespace {

class Folder {
 public:
  Folder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "gnomon-fuzz-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) broken("no temporary folder");
    path_ = pattern;
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

bool finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void check_world(const Scene& scene) {
  if (scene.materials.empty() || scene.lights.empty()) broken("a scene without material or light");
  const World world = make_world(scene);
  for (const Vec3& p : positions_of(world))
    if (!finite(p)) broken("a vertex that is not finite");
  for (std::uint32_t i = 0; i < world.triangle_count(); ++i) {
    for (const std::uint32_t corner : world.triangle(i))
      if (corner >= world.vertex_count()) broken("a corner beyond the vertices");
    if (world.material_of(i) >= scene.materials.size()) broken("a material beyond the list");
  }
  for (const Shape& shape : world.shapes)
    if (shape.material >= scene.materials.size()) broken("a shape's material beyond the list");
  for (const Material& material : scene.materials)
    for (const std::uint32_t texture : {material.diffuse_texture, material.emission_texture})
      if (texture != no_id && texture >= scene.textures.size()) broken("a texture beyond the list");
  for (const Mesh& mesh : scene.meshes) {
    if (!mesh.colors.empty() && mesh.colors.size() != mesh.positions.size())
      broken("not one colour for each vertex");
    for (const Vec4f& c : mesh.colors)
      for (int i = 0; i < 4; ++i)
        if (!(c[i] >= 0.0f && c[i] <= 1.0f)) broken("a colour beyond [0, 1]");
  }
  for (const Light& light : scene.lights)
    if (!finite(light.position) || !(std::abs(glm::length(light.direction) - 1.0) < 1e-6))
      broken("a light without a place or direction");
}

void check_error(const Error& error) {
  if (error.kind != ErrorKind::bad_input && error.kind != ErrorKind::graphics)
    broken("an error of kind " + std::to_string(static_cast<int>(error.kind)) + ": " + error.message());
  const std::string line = error.message();
  if (error.reason.empty()) broken("an error without a reason");
  if (line.find('\n') != std::string::npos) broken("an error of more than one line: " + line);
}

LoadCounts counts;

}  // namespace

const LoadCounts& load_counts() {
  return counts;
}

void broken(const std::string& what) {
  std::fprintf(stderr, "fuzz: %s\n", what.c_str());
  std::abort();
}

const std::string& folder() {
  static const Folder all;
  return all.path();
}

std::string put(const std::string& name, std::string_view bytes) {
  std::string path = folder() + "/" + name;
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) broken("cannot write " + path);
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  if (std::fclose(file) != 0 || !written) broken("cannot write " + path);
  return path;
}

void note_read(const Error* error) {
  ++counts.tried;
  if (error == nullptr) {
    ++counts.loaded;
    return;
  }
  counts.last_error = error->message();
  check_error(*error);
}

void load_as(std::string_view extension, const std::uint8_t* data, std::size_t size) {
  load(put("input" + std::string(extension), {reinterpret_cast<const char*>(data), size}));
}

void load(const std::string& path) {
  const Expected<Scene> scene = load_scene(path, {.confine_paths = true});
  note_read(scene ? nullptr : &scene.error());
  if (scene) check_world(*scene);
}

}  // namespace gnomon::fuzz
