#include "scene/files/gltf/gltf_materials.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <optional>
#include <set>

#include "scene/files/formats.h"
#include "scene/files/gltf/gltf_textures.h"
#include "scene/files/gltf/gltf_value.h"
#include "scene/files/validate.h"

namespace gnomon {
namespace {

Vec3f color(const std::vector<double>& c) {
  return c.size() < 3 ? Vec3f(0.0f) : Vec3f(Vec3(c[0], c[1], c[2]));
}

float fraction(double v) {
  return static_cast<float>(std::clamp(v, 0.0, 1.0));
}

const JsonValue* material_extension(const JsonValue& from, std::string_view name) {
  return extension(member(&from, "extensions"), name);
}

const JsonValue* specular_glossiness(const JsonValue& from) {
  return material_extension(from, "KHR_materials_pbrSpecularGlossiness");
}

const JsonValue* metallic_roughness_of(const JsonValue& from) {
  return member(&from, "pbrMetallicRoughness");
}

std::vector<double> base_color_of(const JsonValue& from) {
  return numbers_of(metallic_roughness_of(from), "baseColorFactor", {1.0, 1.0, 1.0, 1.0});
}

Vec3f emissive_factor_of(const JsonValue& from) {
  return color(numbers_of(&from, "emissiveFactor", {0.0, 0.0, 0.0}));
}

GltfTextureUse base_texture(const JsonValue& from) {
  if (const JsonValue* gloss = specular_glossiness(from)) return texture_use(member(gloss, "diffuseTexture"));
  return texture_use(member(metallic_roughness_of(from), "baseColorTexture"));
}

GltfTextureUse metallic_roughness_texture(const JsonValue& from) {
  return texture_use(member(metallic_roughness_of(from), "metallicRoughnessTexture"));
}

class MaterialReader {
 public:
  MaterialReader(Scene& scene, const JsonDocument& json, GltfData& data)
      : scene_(scene),
        root_(json.root),
        materials_(gltf_list(json.root, "materials")),
        textures_(scene, json, data, unused_) {}

  Expected<TexcoordSets> run() {
    decode_textures();
    for (std::size_t i = 0; i < materials_.size(); ++i) {
      auto material = read(i);
      if (!material) return fail(material.error());
      scene_.materials.push_back(std::move(*material));
    }
    note_single_sided();
    for (const auto& [what, names] : unused_)
      scene_.notes.push_back(fmt::format("{} not used (material{} {}).", what, names.size() > 1 ? "s" : "",
                                         some_of({names.begin(), names.end()})));
    textures_.add_notes();
    return sets_;
  }

 private:
  void decode_textures() {
    std::set<int> colours, means;
    for (const JsonValue& from : materials_) {
      colours.insert(base_texture(from).index);
      if (emissive_factor_of(from) != Vec3f(0.0f))
        colours.insert(texture_use(member(&from, "emissiveTexture")).index);
      if (specular_glossiness(from) == nullptr) means.insert(metallic_roughness_texture(from).index);
    }
    colours.erase(-1), means.erase(-1);
    textures_.decode_ahead(colours, means);
  }

  void note_single_sided() {
    const auto& all = scene_.materials;
    const auto count =
        std::count_if(all.begin(), all.end(), [](const Material& m) { return !shows_back(m); });
    if (count > 0)
      scene_.notes.push_back(fmt::format(
          "Single-sided materials ({} of {}): the eye looks through their backs; both sides cast shadows.",
          count, all.size()));
  }

  Expected<Material> read(std::size_t index) {
    const JsonValue& from = materials_[index];
    const std::string name = text_of(&from, "name");
    Material m = model_material(name.empty() ? fmt::format("material-{}", index + 1) : name);
    sets_.push_back(0);
    const JsonValue* gloss = specular_glossiness(from);
    if (const auto read = read_base_texture(base_texture(from), m); !read) return fail(read.error());
    const TextureStatistics base =
        m.diffuse_texture == no_id ? TextureStatistics{} : textures_.statistics(m.diffuse_texture);
    double roughness = 1.0 - number_of(gloss, "glossinessFactor", 1.0);
    if (gloss != nullptr) {
      map_specular_glossiness(*gloss, m, roughness);
    } else {
      const auto rough = metallic_roughness(from);
      if (!rough) return fail(rough.error());
      const Vec3f factor = glm::clamp(color(base_color_of(from)), 0.0f, 1.0f);
      map_surface(m, factor, base.mean, dielectric_specular(from), rough->x, rough->y);
      roughness = rough->y;
    }
    if (const auto read = map_emission(from, m); !read) return fail(read.error());
    map_transmission(from, m);
    map_alpha(from, m, base);
    m.roughness = m.mirror > 0.0f || m.transmission > 0.0f ? fraction(roughness) : 0.0f;
    if (material_extension(from, "KHR_materials_unlit") != nullptr) make_unlit(from, m);
    m.double_sided = flag_of(&from, "doubleSided", false);
    m.casts_shadow = shadow_flag(from, "casts_shadow"),
    m.receives_shadow = shadow_flag(from, "receives_shadow");
    note_unused(from, m.name);
    return m;
  }

  // Roughness r has the lobe of the exponent 2 / r^4 - 2 (gltf_materials.h).
  static float shininess_of(double roughness) {
    const double a = std::max(roughness * roughness, 0.01);
    return static_cast<float>(std::max(1.0, 2.0 / (a * a) - 2.0));
  }

  void map_specular_glossiness(const JsonValue& gloss, Material& m, double roughness) {
    const auto clamped = [&](const char* key) {
      return glm::clamp(color(numbers_of(&gloss, key, {1.0, 1.0, 1.0})), 0.0f, 1.0f);
    };
    m.diffuse = glm::clamp(color(numbers_of(&gloss, "diffuseFactor", {1.0, 1.0, 1.0, 1.0})), 0.0f, 1.0f);
    m.specular = clamped("specularFactor");
    m.shininess = shininess_of(roughness);
    if (has(&gloss, "specularGlossinessTexture")) unused_["Specular-glossiness textures are"].insert(m.name);
  }

  // KHR_materials_unlit: the base colour as it is, and no light.
  void make_unlit(const JsonValue& from, Material& m) {
    m.unlit = true;
    m.diffuse = glm::clamp(color(base_color_of(from)), 0.0f, 1.0f);
    m.specular = m.emission = m.absorption = Vec3f(0.0f);
    m.emission_texture = no_id;
    m.mirror = m.roughness = 0.0f;
    if (!m.thin) m.transmission = 0.0f;
  }

  // Of the surface of a dielectric with an index of refraction of 1.5, times KHR_materials_specular.
  Vec3f dielectric_specular(const JsonValue& from) {
    const JsonValue* specular = material_extension(from, "KHR_materials_specular");
    if (has(specular, "specularTexture") || has(specular, "specularColorTexture"))
      unused_["Specular textures are"].insert(text_of(&from, "name"));
    const Vec3f tint = color(numbers_of(specular, "specularColorFactor", {1.0, 1.0, 1.0}));
    return glm::clamp(0.04f * tint, 0.0f, 1.0f) * fraction(number_of(specular, "specularFactor", 1.0));
  }

  void map_surface(Material& m, const Vec3f& base, const Vec3f& texture_mean, const Vec3f& dielectric,
                   double metallic, double roughness) {
    const auto metal = static_cast<float>(metallic);
    m.diffuse = base * (1.0f - metal);
    m.specular = glm::mix(dielectric, base * texture_mean, metal);
    m.shininess = shininess_of(roughness);
    if (metallic <= 0.9) return;
    if (roughness < 0.1)
      m.mirror = fraction((m.specular.x + m.specular.y + m.specular.z) / 3.0f);
    else
      unused_
          ["Mirrored surroundings of metals with roughness 0.1 or more (their highlights are shown; where no "
           "light "
           "reaches them they are black) are"]
              .insert(m.name);
  }

  Expected<void> map_emission(const JsonValue& from, Material& m) {
    const double strength =
        number_of(material_extension(from, "KHR_materials_emissive_strength"), "emissiveStrength", 1.0);
    m.emission = emissive_factor_of(from) * static_cast<float>(strength);
    const GltfTextureUse use = texture_use(member(&from, "emissiveTexture"));
    if (use.index < 0 || m.emission == Vec3f(0.0f)) return {};
    if (m.diffuse_texture == no_id && use.set >= 0 && use.set <= 1) sets_.back() = use.set;
    if (use.set != sets_.back()) {  // the texture says where it glows; everywhere would be wrong
      unused_["Emissive textures with other texture coordinates than the base colour's are"].insert(m.name);
      m.emission = Vec3f(0.0f);
      return {};
    }
    const auto texture = textures_.add(use.index, m.name);
    if (!texture) return fail(texture.error());
    m.emission_texture = *texture;
    m.emission_transform = use.transform;
    return {};
  }

  void make_thin_sheet(Material& m, float transmission, double ior) {
    const double reflected = std::pow((ior - 1.0) / (ior + 1.0), 2.0);
    m.mirror = fraction(transmission * reflected);
    m.transmission = transmission - m.mirror;
    m.ior = 1.0f;
    m.thin = true;
  }

  void map_transmission(const JsonValue& from, Material& m) {
    const JsonValue* transmission = material_extension(from, "KHR_materials_transmission");
    const float factor = fraction(number_of(transmission, "transmissionFactor", 0.0));
    if (factor <= 0.0f) return;
    if (has(transmission, "transmissionTexture")) unused_["Transmission textures are"].insert(m.name);
    const double ior = std::max(1.0, number_of(material_extension(from, "KHR_materials_ior"), "ior", 1.5));
    const JsonValue* volume = material_extension(from, "KHR_materials_volume");
    m.mirror = 0.0f;
    if (!(number_of(volume, "thicknessFactor", 0.0) > 0.0)) return make_thin_sheet(m, factor, ior);
    if (has(volume, "thicknessTexture"))
      unused_["Thickness textures (the geometry's own thickness counts) are"].insert(m.name);
    m.transmission = factor;
    m.ior = static_cast<float>(std::min(ior, 100.0));
    const double distance = number_of(volume, "attenuationDistance", infinity);
    const Vec3f attenuation = color(numbers_of(volume, "attenuationColor", {1.0, 1.0, 1.0}));
    constexpr float darkest = 1e-6f;  // ln(0) is not finite; this is black after one attenuation distance
    if (distance > 0.0 && std::isfinite(distance))
      m.absorption = -glm::log(glm::clamp(attenuation, darkest, 1.0f)) / static_cast<float>(distance);
  }

  void map_alpha(const JsonValue& from, Material& m, const TextureStatistics& base) {
    m.alpha = fraction(base_color_of(from)[3]);
    if (const JsonValue* gloss = specular_glossiness(from))
      m.alpha = fraction(numbers_of(gloss, "diffuseFactor", {1.0, 1.0, 1.0, 1.0})[3]);
    const std::string mode = text_of(&from, "alphaMode");
    if (mode == "MASK") {
      m.alpha_mode = AlphaMode::mask;
      m.alpha_cutoff = static_cast<float>(number_of(&from, "alphaCutoff", 0.5));
    }
    if (mode != "BLEND") return;
    const float highest = m.alpha * base.greatest_alpha;  // of any texel
    if (m.transmission > 0.0f) {
      scene_.notes.push_back(fmt::format("Material '{}': blending was left to its transmission.", m.name));
    } else if (base.least_alpha < 1.0f && highest >= 0.5f) {
      m.alpha_mode = AlphaMode::mask;
      scene_.notes.push_back(
          fmt::format("Material '{}': blending became an alpha mask with cutoff 0.5.", m.name));
    } else if (highest < 1.0f) {  // through a mask nothing would be left of it
      make_thin_sheet(m, 1.0f - highest, 1.0);
      scene_.notes.push_back(
          fmt::format("Material '{}': blending with alpha {:g} became a thin sheet with transmission {:g}.",
                      m.name, highest, m.transmission));
      m.alpha = 1.0f;
    }
  }

  // The unknown ones in the file's own list are noted by parse_gltf.
  bool is_listed(const std::string& name) const {
    const auto& used = gltf_list(root_, "extensionsUsed");
    return std::any_of(used.begin(), used.end(), [&](const JsonValue& n) { return n.text == name; });
  }

  void note_unused(const JsonValue& from, const std::string& name) {
    if (has(&from, "normalTexture")) unused_["Normal textures are"].insert(name);
    if (has(&from, "occlusionTexture")) unused_["Occlusion textures are"].insert(name);
    const JsonValue* extensions = member(&from, "extensions");
    if (extensions == nullptr) return;
    for (const auto& [key, begin, value] : extensions->members)
      if (value.type == JsonValue::Type::object && key.starts_with("KHR_materials_") && !is_listed(key) &&
          key != "KHR_materials_transmission" && key != "KHR_materials_ior" &&
          key != "KHR_materials_volume" && key != "KHR_materials_emissive_strength" &&
          key != "KHR_materials_specular" && key != "KHR_materials_unlit" &&
          key != "KHR_materials_pbrSpecularGlossiness")
        unused_[key + " is"].insert(name);
  }

  // Metallic and roughness factors, times the means of the texture's blue and green channels.
  Expected<Vec2> metallic_roughness(const JsonValue& from) {
    const JsonValue* pbr = metallic_roughness_of(from);
    const Vec2 out(number_of(pbr, "metallicFactor", 1.0), number_of(pbr, "roughnessFactor", 1.0));
    const int index = metallic_roughness_texture(from).index;
    if (index < 0) return out;
    const std::string name = text_of(&from, "name");
    const auto mean = textures_.linear_mean(index, name);
    if (!mean) return fail(mean.error());
    if (!*mean) return out;
    unused_["Metallic-roughness textures are averaged, the rest of them"].insert(name);
    return out * Vec2((*mean)->b, (*mean)->g);
  }

  Expected<void> read_base_texture(const GltfTextureUse& use, Material& m) {
    if (use.index < 0) return {};
    if (use.set < 0 || use.set > 1) {
      scene_.notes.push_back(fmt::format(
          "Material '{}': texture coordinates {} are not used (allowed 0 and 1).", m.name, use.set));
      return {};
    }
    const auto texture = textures_.add(use.index, m.name);
    if (!texture) return fail(texture.error());
    m.diffuse_texture = *texture;
    m.texture_transform = use.transform;
    sets_.back() = use.set;
    return {};
  }

  Scene& scene_;
  const JsonValue& root_;
  const std::vector<JsonValue>& materials_;
  UnusedParts unused_;
  GltfTextures textures_;
  TexcoordSets sets_;
};

}  // namespace

Expected<TexcoordSets> add_gltf_materials(Scene& scene, const JsonDocument& json, GltfData& data) {
  return MaterialReader(scene, json, data).run();
}

}  // namespace gnomon
