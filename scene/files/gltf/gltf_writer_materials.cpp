// Blinn-Phong with mirror and transmission, said in glTF's metallic-roughness terms as nearly as these allow:
// the other way round of gltf_materials.h, so that other programs show something alike. The exact numbers
// stand in the extras.
#include <fmt/core.h>

#include "scene/files/gltf/gltf_extras.h"
#include "scene/files/gltf/gltf_writer_parts.h"
#include "scene/files/pictures/image_io.h"

namespace gnomon::gltf_writer {
namespace {

float largest(const Vec3f& v) {
  return std::max({v.x, v.y, v.z});
}

/// glTF's base colours are sRGB-encoded.
Texture encoded(Texture texture) {
  if (texture.srgb) return texture;
  for (glm::u8vec4& t : texture.texels)
    for (int c = 0; c < 3; ++c)
      t[c] = static_cast<std::uint8_t>(
          std::lround(255.0f * srgb_from_linear(static_cast<float>(t[c]) / 255.0f)));
  return texture;
}

Expected<void> add_texture(File& file, const Texture& texture) {
  if (!texture.srgb)
    file.notes.push_back(fmt::format("The linear texture '{}' was encoded as sRGB.", texture.name));
  const auto png = encode_png(encoded(texture));
  if (!png) return fail(png.error());
  Json image{{"mimeType", "image/png"}, {"bufferView", file.add_view(*png, 0)}};
  if (!texture.name.empty()) image["name"] = texture.name;
  constexpr int nearest = 9728, linear = 9729, repeat = 10497, clamp = 33071;
  const Json sampler{{"magFilter", texture.nearest ? nearest : linear},
                     {"minFilter", texture.nearest ? nearest : linear},
                     {"wrapS", texture.repeat_s ? repeat : clamp},
                     {"wrapT", texture.repeat_t ? repeat : clamp}};
  file.add("textures",
           {{"sampler", file.add("samplers", sampler)}, {"source", file.add("images", std::move(image))}});
  return {};
}

Json texture_info(File& file, std::uint32_t texture, const TextureTransform& t) {
  Json info{{"index", texture}};
  if (t.offset == Vec2(0.0) && t.scale == Vec2(1.0) && t.rotation == 0.0) return info;
  file.extensions.insert("KHR_texture_transform");
  info["extensions"]["KHR_texture_transform"] = {
      {"offset", {t.offset.x, t.offset.y}}, {"rotation", t.rotation}, {"scale", {t.scale.x, t.scale.y}}};
  return info;
}

/// The roughness whose lobe is as wide as the highlight's (gltf_materials.h).
double roughness_of(const Material& m) {
  if (m.mirror > 0.0f || m.transmission > 0.0f) return shortest(m.roughness);
  return std::pow(2.0 / (static_cast<double>(m.shininess) + 2.0), 0.25);
}

Json base_of(File& file, const Material& m) {
  const Vec3f color = glm::clamp(m.diffuse, 0.0f, 1.0f);
  Json factor = shortest(color);
  factor.push_back(shortest(m.alpha));
  // A metal mirrors its base colour, and the rest of it is shaded: as ours, but for the mirror's tint.
  Json out{{"baseColorFactor", std::move(factor)},
           {"metallicFactor", m.transmission > 0.0f ? 0.0 : shortest(m.mirror)},
           {"roughnessFactor", roughness_of(m)}};
  if (m.diffuse_texture != no_id)
    out["baseColorTexture"] = texture_info(file, m.diffuse_texture, m.texture_transform);
  return out;
}

void add_specular(File& file, Json& extensions, const Material& m) {
  constexpr float usual = 0.04f;  // of a dielectric with an index of refraction of 1.5
  if (m.specular == Vec3f(usual)) return;
  file.extensions.insert("KHR_materials_specular");
  extensions["KHR_materials_specular"] = m.specular == Vec3f(0.0f)
                                             ? Json{{"specularFactor", 0.0}}
                                             : Json{{"specularColorFactor", shortest(m.specular / usual)}};
}

void add_transmission(File& file, Json& extensions, const Material& m) {
  if (m.transmission <= 0.0f) return;
  const auto add = [&](const char* name, Json value) {
    file.extensions.insert(name);
    extensions[name] = std::move(value);
  };
  add("KHR_materials_transmission", {{"transmissionFactor", shortest(m.transmission)}});
  if (m.ior >= 1.0f) add("KHR_materials_ior", {{"ior", shortest(m.ior)}});
  if (m.thin) return;
  // The geometry's own thickness counts for a ray tracer; others take this one.
  Json volume{{"thicknessFactor", 1.0}};
  if (m.absorption != Vec3f(0.0f)) {
    volume["attenuationDistance"] = 1.0;
    volume["attenuationColor"] = shortest(glm::exp(-m.absorption));
  }
  add("KHR_materials_volume", std::move(volume));
}

void add_emission(File& file, Json& material, Json& extensions, const Material& m) {
  if (m.emission == Vec3f(0.0f)) return;
  const float strength = std::max(1.0f, largest(m.emission));
  material["emissiveFactor"] = shortest(m.emission / strength);
  if (m.emission_texture != no_id)
    material["emissiveTexture"] = texture_info(file, m.emission_texture, m.emission_transform);
  if (strength == 1.0f) return;
  file.extensions.insert("KHR_materials_emissive_strength");
  extensions["KHR_materials_emissive_strength"] = {{"emissiveStrength", shortest(strength)}};
}

void add_material(File& file, const Material& m) {
  Json material = Json::object(), extensions = Json::object();
  if (!m.name.empty()) material["name"] = m.name;
  material["pbrMetallicRoughness"] = base_of(file, m);
  if (m.alpha_mode == AlphaMode::mask) {
    material["alphaMode"] = "MASK";
    material["alphaCutoff"] = shortest(m.alpha_cutoff);
  }
  // The surface of a body of glass has one outside.
  material["doubleSided"] = m.double_sided && (m.transmission <= 0.0f || m.thin);
  if (m.unlit) {
    file.extensions.insert("KHR_materials_unlit");
    extensions["KHR_materials_unlit"] = Json::object();
  }
  add_emission(file, material, extensions, m);
  add_specular(file, extensions, m);
  add_transmission(file, extensions, m);
  if (!extensions.empty()) material["extensions"] = std::move(extensions);
  material["extras"] = material_extras(m);
  if (!m.casts_shadow) material["extras"]["casts_shadow"] = false;
  if (!m.receives_shadow) material["extras"]["receives_shadow"] = false;
  file.add("materials", std::move(material));
}

}  // namespace

Expected<void> write_materials(File& file, const Scene& scene) {
  for (const Texture& texture : scene.textures)
    if (const auto added = add_texture(file, texture); !added) return added;
  for (const Material& material : scene.materials) add_material(file, material);
  return {};
}

}  // namespace gnomon::gltf_writer
