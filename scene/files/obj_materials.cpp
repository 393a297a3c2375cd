#include "scene/files/obj_materials.h"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <filesystem>

#include "scene/files/formats.h"
#include "scene/files/image_io.h"
#include "scene/files/read_file.h"

namespace gnomon {
namespace {

Vec3f color(const tinyobj::real_t (&c)[3]) {
  return {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2])};
}

float mean(const Vec3f& c) {
  return (c.x + c.y + c.z) / 3.0f;
}

Vec3f clamp_color(Scene& scene, const std::string& name, std::string_view key, const Vec3f& c) {
  const Vec3f clamped = glm::clamp(c, 0.0f, 1.0f);
  if (clamped != c) scene.notes.push_back(fmt::format("Material '{}': {} was clipped to [0, 1].", name, key));
  return clamped;
}

void map_transparency(Scene& scene, const tinyobj::material_t& from, Material& m) {
  const auto dissolve = static_cast<float>(std::clamp<tinyobj::real_t>(from.dissolve, 0.0, 1.0));
  m.ior = from.ior > 0.0 ? static_cast<float>(from.ior) : 1.0f;
  const bool glass = from.illum == 4 || from.illum == 6 || from.illum == 7;
  if (dissolve < 1.0f)
    m.transmission = 1.0f - dissolve;
  else if (glass)
    m.transmission = std::clamp(mean(color(from.transmittance)), 0.0f, 1.0f);
  m.thin = m.transmission > 0.0f && m.ior == 1.0f;  // files without Ni: windows, leaves, veils
  if (m.transmission > 0.0f)
    scene.notes.push_back(fmt::format(
        "Material '{}': dissolve {:g}, illum {} became transmission {:g} with index of refraction {:g}.",
        m.name, dissolve, from.illum, m.transmission, m.ior));
  const bool mirrors = from.illum == 3 || from.illum == 5 || from.illum == 7;
  if (mirrors) m.mirror = std::clamp(mean(m.specular), 0.0f, 1.0f - m.transmission);
}

void note_unused_maps(Scene& scene, const tinyobj::material_t& from) {
  for (const auto& [key, name] : {std::pair{"map_Ka", &from.ambient_texname},
                                  {"map_Ks", &from.specular_texname},
                                  {"map_Ns", &from.specular_highlight_texname},
                                  {"bump", &from.bump_texname},
                                  {"disp", &from.displacement_texname},
                                  {"refl", &from.reflection_texname},
                                  {"map_Ke", &from.emissive_texname},
                                  {"norm", &from.normal_texname}})
    if (!name->empty()) scene.notes.push_back(fmt::format("Material '{}': {} is not used.", from.name, key));
}

// In v-up terms the lookup is s * v + o; with v' = 1 - v on both sides that is s * v' + (1 - s - o).
TextureTransform transform_of(const tinyobj::texture_option_t& option) {
  TextureTransform t;
  t.scale = {option.scale[0], option.scale[1]};
  t.offset = {option.origin_offset[0], 1.0 - option.scale[1] - option.origin_offset[1]};
  return t;
}

Expected<void> add_texture(Scene& scene, const tinyobj::material_t& from, Material& m,
                           const std::string& folder, const LoadOptions& options,
                           std::map<std::string, std::uint32_t>& known) {
  std::string name = from.diffuse_texname;
  std::replace(name.begin(), name.end(), '\\', '/');
  const auto path = resolve_path(folder, name, options);
  if (!path) {
    Error error = path.error();
    error.field = fmt::format("{}.map_Kd", from.name);
    return fail(std::move(error));
  }
  std::error_code ignored;
  if (!std::filesystem::exists(*path, ignored)) {
    scene.notes.push_back(fmt::format("Material '{}': the texture {} is not there; its plain colour is used.",
                                      from.name, *path));
    return {};
  }
  const bool clamp = from.diffuse_texopt.clamp;
  const std::string key = fmt::format("{}{}", *path, clamp ? " clamped" : "");
  if (const auto found = known.find(key); found != known.end()) {
    m.diffuse_texture = found->second;
  } else {
    auto texture = read_texture(*path, true);
    if (!texture) return fail(texture.error());
    texture->repeat_s = texture->repeat_t = !clamp;
    m.diffuse_texture = static_cast<std::uint32_t>(scene.textures.size());
    known.emplace(key, m.diffuse_texture);
    scene.textures.push_back(std::move(*texture));
  }
  m.texture_transform = transform_of(from.diffuse_texopt);
  if (from.alpha_texname == from.diffuse_texname) m.alpha_mode = AlphaMode::mask;
  return {};
}

}  // namespace

Expected<void> add_obj_materials(Scene& scene, const std::vector<tinyobj::material_t>& materials,
                                 const std::set<std::string>& without_diffuse, const std::string& folder,
                                 const LoadOptions& options) {
  std::map<std::string, std::uint32_t> known_textures;
  for (const tinyobj::material_t& from : materials) {
    Material m = model_material(from.name);
    const bool textured = !from.diffuse_texname.empty();
    if (!without_diffuse.contains(from.name))
      m.diffuse = clamp_color(scene, from.name, "Kd", color(from.diffuse));
    else if (textured)
      m.diffuse = Vec3f(1.0f);
    m.specular = clamp_color(scene, from.name, "Ks", color(from.specular));
    m.emission = color(from.emission);
    m.shininess = std::max(1.0f, static_cast<float>(from.shininess));
    map_transparency(scene, from, m);
    note_unused_maps(scene, from);
    if (!from.alpha_texname.empty() && from.alpha_texname != from.diffuse_texname)
      scene.notes.push_back(
          fmt::format("Material '{}': map_d is used only when it is map_Kd's file.", from.name));
    if (textured)
      if (const auto added = add_texture(scene, from, m, folder, options, known_textures); !added)
        return fail(added.error());
    scene.materials.push_back(std::move(m));
  }
  return {};
}

}  // namespace gnomon
