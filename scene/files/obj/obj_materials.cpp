
#include <fmt/core.h>

#include <algorithm>

#include "scene/files/formats.h"
#include "scene/files/obj/obj_textures.h"

namespace gnomon {
namespace {

float mean(const Vec3f& c) {
  return (c.x + c.y + c.z) / 3.0f;
}

Vec3f clamp_color(MaterialNotes& notes, const std::string& name, const std::string& key, const Vec3& c) {
  const Vec3f clamped = glm::clamp(Vec3f(c), 0.0f, 1.0f);
  if (clamped != Vec3f(c)) notes.add(name, "{} was clipped to [0, 1]", "Colours were clipped to [0, 1]", key);
  return clamped;
}

/// "Tr 1" would let all light through, and the material would not be seen: MeshLab and others write it of what lets none.
float dissolve_of(MaterialNotes& notes, const MtlMaterial& from) {
  const auto dissolve = static_cast<float>(std::clamp(from.dissolve, 0.0, 1.0));
  if (dissolve == 1.0f && from.has_full_transparency)
    notes.add(from.name, "Tr 1 is read as opaque, as some programs write it (d 0 makes it invisible)",
              "Tr 1 is read as opaque, as some programs write it; d 0 makes what has it invisible");
  return dissolve;
}

void map_transparency(MaterialNotes& notes, const MtlMaterial& from, Material& m) {
  m.ior = from.ior > 0.0 ? static_cast<float>(from.ior) : 1.0f;
  const bool glass = from.illum == 4 || from.illum == 6 || from.illum == 7;
  const float dissolve = dissolve_of(notes, from);
  if (dissolve < 1.0f)
    m.transmission = 1.0f - dissolve;
  else if (glass)
    m.transmission = std::clamp(mean(Vec3f(from.transmittance)), 0.0f, 1.0f);
  m.thin = m.transmission > 0.0f && m.ior == 1.0f;  // files without Ni: windows, leaves, veils
  if (m.transmission > 0.0f)
    notes.add(m.name, "{}", "Dissolve and illum became transmission with an index of refraction",
              fmt::format("dissolve {:g}, illum {} became transmission {:g} with index of refraction {:g}",
                          dissolve, from.illum, m.transmission, m.ior));
  const bool mirrors = from.illum == 3 || from.illum == 5 || from.illum == 7;
  if (mirrors) m.mirror = std::clamp(mean(m.specular), 0.0f, 1.0f - m.transmission);
}

void note_unused_maps(MaterialNotes& notes, const MtlMaterial& from) {
  for (const std::string& map : from.other_maps)
    notes.add(from.name, "{} is not used", "Maps that are not used", map);
}

}  // namespace

Expected<void> add_obj_materials(Scene& scene, const std::vector<MtlMaterial>& materials,
                                 const std::string& folder, const LoadOptions& options) {
  MaterialNotes notes;
  ObjTextures textures(scene, notes, folder, options);
  if (const auto read = textures.read(materials); !read) return fail(read.error());
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const MtlMaterial& from = materials[i];
    Material m = model_material(from.name);
    if (from.diffuse)
      m.diffuse = clamp_color(notes, from.name, "Kd", *from.diffuse);
    else if (!from.colours.file.empty())
      m.diffuse = Vec3f(1.0f);
    m.specular = clamp_color(notes, from.name, "Ks", from.specular);
    m.emission = Vec3f(from.emission);
    m.shininess = std::max(1.0f, static_cast<float>(from.shininess));
    map_transparency(notes, from, m);
    note_unused_maps(notes, from);
    textures.give(from, i, m);
    scene.materials.push_back(std::move(m));
  }
  notes.put(scene);
  return {};
}

}  // namespace gnomon
