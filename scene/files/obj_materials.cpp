#include "scene/files/obj_materials.h"

#include <fmt/core.h>
#include <tiny_obj_loader.h>

#include <algorithm>

#include "scene/files/formats.h"
#include "scene/files/mtl_options.h"
#include "scene/files/obj_textures.h"

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

/// "Tr 1" would let all light through, and the material would not be seen: MeshLab and others write it of what lets none.
float dissolve_of(Scene& scene, const tinyobj::material_t& from) {
  const auto dissolve = static_cast<float>(std::clamp<tinyobj::real_t>(from.dissolve, 0.0, 1.0));
  if (dissolve == 1.0f && from.unknown_parameter.contains(std::string(full_transparency)))
    scene.notes.push_back(fmt::format(
        "Material '{}': Tr 1 is read as opaque, as some programs write it (d 0 makes it invisible).",
        from.name));
  return dissolve;
}

void map_transparency(Scene& scene, const tinyobj::material_t& from, Material& m) {
  m.ior = from.ior > 0.0 ? static_cast<float>(from.ior) : 1.0f;
  const bool glass = from.illum == 4 || from.illum == 6 || from.illum == 7;
  const float dissolve = dissolve_of(scene, from);
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

}  // namespace

Expected<void> add_obj_materials(Scene& scene, const std::vector<tinyobj::material_t>& materials,
                                 const std::set<std::string>& without_diffuse, const std::string& folder,
                                 const LoadOptions& options) {
  ObjTextures textures(scene, folder, options);
  if (const auto read = textures.read(materials); !read) return fail(read.error());
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const tinyobj::material_t& from = materials[i];
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
    textures.give(from, i, m);
    scene.materials.push_back(std::move(m));
  }
  return {};
}

}  // namespace gnomon
