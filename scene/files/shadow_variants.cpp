#include "scene/files/shadow_variants.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/files/material_notes.h"

namespace gnomon {

std::uint32_t ShadowVariants::material(const ShadowFlags& flags, Scene& scene, std::uint32_t material) {
  const Material& own = scene.materials[material];
  const ShadowFlags both{own.casts_shadow && flags.casts, own.receives_shadow && flags.receives};
  if (both == ShadowFlags{own.casts_shadow, own.receives_shadow}) return material;
  const auto [found, is_new] =
      materials_.try_emplace({material, both}, static_cast<std::uint32_t>(scene.materials.size()));
  if (!is_new) return found->second;
  Material variant = own;
  variant.casts_shadow = both.casts, variant.receives_shadow = both.receives;
  variant.name += !both.casts && !both.receives ? " (casts and receives no shadow)"
                  : both.receives               ? " (casts no shadow)"
                                                : " (receives no shadow)";
  scene.materials.push_back(std::move(variant));
  return found->second;
}

void ShadowVariants::apply(const ShadowFlags& flags, Scene& scene, MeshInstance& instance) {
  if (flags.casts && flags.receives) return;
  if (scene.meshes[instance.mesh].triangle_materials.empty()) {
    instance.material = material(flags, scene, instance.material);
    return;
  }
  const auto [found, is_new] =
      meshes_.try_emplace({instance.mesh, flags}, static_cast<std::uint32_t>(scene.meshes.size()));
  if (is_new) {
    Mesh copy = scene.meshes[instance.mesh];
    for (std::uint32_t& m : copy.triangle_materials) m = material(flags, scene, m);
    scene.meshes.push_back(std::move(copy));
  }
  instance.mesh = found->second;
}

namespace {

/// `one`, `several`: what is said of them.
void note_objects(const std::vector<std::string>& names, const char* one, const char* several, Scene& scene) {
  if (names.empty()) return;
  scene.notes.push_back(fmt::format("{} object{} ({}).", names.size(),
                                    names.size() == 1 ? std::string(one) : "s" + std::string(several),
                                    some_of(names)));
}

}  // namespace

void note_shadow_flags(Scene& scene) {
  std::vector<std::string> casts_none, receives_none;
  const auto look = [&](const std::string& name, const auto& any) {
    if (any([](const Material& m) { return !m.casts_shadow; })) casts_none.push_back(name);
    if (any([](const Material& m) { return !m.receives_shadow; })) receives_none.push_back(name);
  };
  for (const MeshInstance& instance : scene.instances) {
    const std::vector<std::uint32_t>& of_triangles = scene.meshes[instance.mesh].triangle_materials;
    look(instance.name, [&](const auto& is) {
      if (of_triangles.empty()) return is(scene.materials[instance.material]);
      return std::any_of(of_triangles.begin(), of_triangles.end(),
                         [&](std::uint32_t m) { return is(scene.materials[m]); });
    });
  }
  for (const Shape& shape : scene.shapes)
    look(shape.name, [&](const auto& is) { return is(scene.materials[shape.material]); });
  note_objects(casts_none, " casts no shadow: it is in no map, and no shadow ray meets it",
               " cast no shadow: they are in no map, and no shadow ray meets them", scene);
  note_objects(receives_none, " receives no shadow: both renderers light it, and it counts as lit",
               " receive no shadow: both renderers light them, and they count as lit", scene);
}

}  // namespace gnomon
