#include "scene/effects.h"

#include <fmt/core.h>

#include <functional>
#include <set>

#include "scene/light.h"

namespace gnomon {
namespace {

std::set<std::uint32_t> used_materials(const Scene& scene) {
  std::set<std::uint32_t> used;
  for (const MeshInstance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    if (mesh.triangle_materials.empty()) used.insert(instance.material);
    const auto& of_triangles = mesh.triangle_materials;
    for (std::size_t i = 0; i < of_triangles.size(); ++i)
      if (i == 0 || of_triangles[i] != of_triangles[i - 1]) used.insert(of_triangles[i]);
  }
  for (const Shape& shape : scene.shapes) used.insert(shape.material);
  return used;
}

struct Remark {
  bool supported;
  std::string_view text;  ///< added to the reason of an effect that is called for
};
constexpr Remark simulated{true, ""}, traced_only{true, "; only the ray tracer shows it"},
    plainly_drawn{true, "; only the ray tracer shows it, the rasterizer draws matte grey in its place"};

// The first used material for which `needs` holds is the reason.
EffectEntry from_materials(const Scene& scene, const std::set<std::uint32_t>& used, Effect effect,
                           const Remark& remark, std::string_view property,
                           const std::function<bool(const Material&)>& needs) {
  for (const std::uint32_t id : used) {
    const Material& material = scene.materials[id];
    if (!needs(material)) continue;
    return {effect, true, remark.supported,
            fmt::format("material '{}' has {}{}", material.name, property, remark.text)};
  }
  return {effect, false, false, fmt::format("no material has {}", property)};
}

// An effect that is asked for by a number of samples above `off`.
EffectEntry sampled(Effect effect, int samples, int off, std::string reason, std::string_view reason_off) {
  if (samples > off) return {effect, true, true, std::move(reason)};
  return {effect, false, false, std::string(reason_off)};
}

EffectEntry vertex_colors(const Scene& scene) {
  for (const MeshInstance& instance : scene.instances)
    if (const Mesh& mesh = scene.meshes[instance.mesh]; !mesh.colors.empty())
      return {Effect::vertex_colors, true, true, fmt::format("mesh '{}' has colours", mesh.name)};
  return {Effect::vertex_colors, false, false, "no mesh has colours"};
}

// The lights that have a size, or those that have none; the first one is the reason.
EffectEntry shadow(const Scene& scene, bool soft) {
  const Effect effect = soft ? Effect::soft_shadow : Effect::hard_shadow;
  if (scene.lights.empty()) return {effect, false, false, "the scene has no light"};
  const Light* first = nullptr;
  std::size_t count = 0;
  for (const Light& light : scene.lights) {
    if (has_size(light) != soft) continue;
    if (count++ == 0) first = &light;
  }
  if (first == nullptr)
    return {effect, false, false, soft ? "no light has a size" : "every light has a size"};
  return {
      effect, true, true,
      fmt::format("light '{}'{} {}", first->name, count > 1 ? fmt::format(" (and {} more)", count - 1) : "",
                  soft ? "has a size; a shadow map sees from its centre alone" : "has no size")};
}

}  // namespace

std::string_view effect_name(Effect effect) {
  static constexpr std::array<std::string_view, effect_count> names{
      "hard_shadow", "soft_shadow",    "reflection",    "refraction", "absorption",
      "glossy",      "indirect_light", "textures",      "alpha_mask", "emission",
      "specular",    "antialiasing",   "vertex_colors", "unlit",      "single_sided"};
  return names[static_cast<std::size_t>(effect)];
}

EffectPlan plan_effects(const Scene& scene) {
  const auto any = [](const Vec3f& v) { return v.x > 0.0f || v.y > 0.0f || v.z > 0.0f; };
  const std::set<std::uint32_t> used = used_materials(scene);
  const auto material = [&](Effect e, const Remark& remark, std::string_view property, auto needs) {
    return from_materials(scene, used, e, remark, property, needs);
  };
  using M = const Material&;
  const int per_pixel = scene.camera.samples_per_pixel;
  return {{
      shadow(scene, false),
      shadow(scene, true),
      material(Effect::reflection, plainly_drawn, "mirror or transmission > 0",
               [](M m) { return m.mirror > 0.0f || m.transmission > 0.0f; }),
      material(Effect::refraction,
               Remark{true,
                      "; the ray tracer's picture lets light through it, the rasterizer and the comparison "
                      "count it as opaque"},
               "transmission > 0", [](M m) { return m.transmission > 0.0f; }),
      material(Effect::absorption, simulated, "transmission > 0 and absorption > 0",
               [&](M m) { return m.transmission > 0.0f && any(m.absorption); }),
      material(Effect::glossy, traced_only, "roughness > 0 on a mirror or transmissive surface",
               [](M m) { return m.roughness > 0.0f && (m.mirror > 0.0f || m.transmission > 0.0f); }),
      sampled(Effect::indirect_light, scene.indirect_samples, 0,
              fmt::format("the scene asks for {} samples per point; only the ray tracer's picture shows it",
                          scene.indirect_samples),
              "the scene does not ask for it"),
      material(Effect::textures, simulated, "a texture",
               [](M m) { return m.diffuse_texture != no_id || m.emission_texture != no_id; }),
      material(Effect::alpha_mask, simulated, "an alpha mask",
               [](M m) { return m.alpha_mode == AlphaMode::mask; }),
      material(Effect::emission, simulated, "emission > 0", [&](M m) { return any(m.emission); }),
      material(Effect::specular, simulated, "specular > 0", [&](M m) { return any(m.specular); }),
      sampled(
          Effect::antialiasing, per_pixel, 1,
          fmt::format("the camera asks for {} samples per pixel; gnomon raytrace does it, everything else "
                      "stays at pixel centres",
                      per_pixel),
          "the camera asks for one sample per pixel"),
      vertex_colors(scene),
      material(Effect::unlit, simulated, "a colour that no light changes", [](M m) { return m.unlit; }),
      material(Effect::single_sided,
               Remark{true, "; the eye looks through its back, and both sides cast shadows"}, "a single side",
               [](M m) { return !shows_back(m); }),
  }};
}

}  // namespace gnomon
