#include "scene/files/gltf_materials.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tiny_gltf.h>

#include <map>
#include <optional>
#include <set>

#include "scene/files/formats.h"
#include "scene/files/image_io.h"
#include "scene/files/read_file.h"
#include "scene/files/validate.h"
#include "scene/texture_sample.h"

namespace gnomon {
namespace {

using Extensions = tinygltf::ExtensionMap;

const tinygltf::Value* extension(const Extensions& extensions, const std::string& name) {
  const auto found = extensions.find(name);
  return found == extensions.end() ? nullptr : &found->second;
}

double number(const tinygltf::Value* object, const std::string& key, double otherwise) {
  if (!object || !object->IsObject() || !object->Has(key) || !object->Get(key).IsNumber()) return otherwise;
  return object->Get(key).GetNumberAsDouble();
}

std::vector<double> numbers(const tinygltf::Value* object, const std::string& key,
                            std::vector<double> otherwise) {
  if (!object || !object->IsObject() || !object->Has(key) || !object->Get(key).IsArray()) return otherwise;
  const tinygltf::Value& list = object->Get(key);
  if (list.ArrayLen() != otherwise.size()) return otherwise;
  for (std::size_t i = 0; i < otherwise.size(); ++i)
    if (list.Get(i).IsNumber()) otherwise[i] = list.Get(i).GetNumberAsDouble();
  return otherwise;
}

bool has(const tinygltf::Value* object, const std::string& key) {
  return object && object->IsObject() && object->Has(key);
}

Vec3f color(const std::vector<double>& c) {
  return c.size() < 3 ? Vec3f(0.0f) : Vec3f(Vec3(c[0], c[1], c[2]));
}

float fraction(double v) {
  return static_cast<float>(std::clamp(v, 0.0, 1.0));
}

struct TextureStatistics {
  Vec3f mean{1.0f};  ///< linear when the texture is sRGB
  bool has_alpha = false;
};

TextureStatistics statistics(const Texture& texture) {
  TextureStatistics out;
  Vec3 sum(0.0);
  const auto& linear = linear_from_srgb8();
  for (const glm::u8vec4& t : texture.texels) {
    sum += texture.srgb ? Vec3(linear[t.r], linear[t.g], linear[t.b]) : Vec3(t.r, t.g, t.b) / 255.0;
    if (t.a < 255) out.has_alpha = true;
  }
  if (!texture.texels.empty()) out.mean = Vec3f(sum / static_cast<double>(texture.texels.size()));
  return out;
}

class MaterialReader {
 public:
  MaterialReader(Scene& scene, const tinygltf::Model& model, GltfData& data, const std::string& file)
      : scene_(scene), model_(model), data_(data), file_(file) {}

  Expected<TexcoordSets> run() {
    for (std::size_t i = 0; i < model_.materials.size(); ++i) {
      auto material = read(i);
      if (!material) return fail(material.error());
      scene_.materials.push_back(std::move(*material));
    }
    note_single_sided();
    for (const auto& [what, names] : unused_)
      scene_.notes.push_back(fmt::format("{} not used (material{} {}).", what, names.size() > 1 ? "s" : "",
                                         fmt::join(names, ", ")));
    return sets_;
  }

 private:
  // Both renderers see surfaces from both sides, and so do the lights. A body of glass is seen from inside
  // whatever its file says.
  void note_single_sided() {
    const auto count =
        std::count_if(model_.materials.begin(), model_.materials.end(), [](const tinygltf::Material& m) {
          return !m.doubleSided && !m.extensions.contains("KHR_materials_volume");
        });
    if (count > 0)
      scene_.notes.push_back(
          fmt::format("Single-sided materials are taken as two-sided, seen and casting shadows from behind "
                      "too: {} of {}.",
                      count, model_.materials.size()));
  }

  Expected<Material> read(std::size_t index) {
    const tinygltf::Material& from = model_.materials[index];
    const auto& pbr = from.pbrMetallicRoughness;
    Material m = model_material(from.name.empty() ? fmt::format("material-{}", index + 1) : from.name);
    sets_.push_back(0);
    TextureStatistics base_texture;
    if (pbr.baseColorTexture.index >= 0)
      if (const auto read = read_base_texture(from, m, base_texture); !read) return fail(read.error());
    const Vec3f base = glm::clamp(color(pbr.baseColorFactor), 0.0f, 1.0f);
    const auto rough = metallic_roughness(from);
    if (!rough) return fail(rough.error());
    map_surface(m, base, base_texture.mean, dielectric_specular(from), rough->x, rough->y);
    map_emission(from, m);
    map_transmission(from, m);
    map_alpha(from, m, base_texture.has_alpha);
    m.roughness = m.mirror > 0.0f || m.transmission > 0.0f ? static_cast<float>(rough->y) : 0.0f;
    note_unused(from, m.name);
    return m;
  }

  // Of the surface of a dielectric with an index of refraction of 1.5, times KHR_materials_specular.
  Vec3f dielectric_specular(const tinygltf::Material& from) {
    const tinygltf::Value* specular = extension(from.extensions, "KHR_materials_specular");
    if (has(specular, "specularTexture") || has(specular, "specularColorTexture"))
      unused_["Specular textures are"].insert(from.name);
    const Vec3f tint = color(numbers(specular, "specularColorFactor", {1.0, 1.0, 1.0}));
    return glm::clamp(0.04f * tint, 0.0f, 1.0f) * fraction(number(specular, "specularFactor", 1.0));
  }

  void map_surface(Material& m, const Vec3f& base, const Vec3f& texture_mean, const Vec3f& dielectric,
                   double metallic, double roughness) {
    const auto metal = static_cast<float>(metallic);
    const double a = std::max(roughness * roughness, 0.01);
    m.diffuse = base * (1.0f - metal);
    m.specular = glm::mix(dielectric, base * texture_mean, metal);
    m.shininess = static_cast<float>(std::max(1.0, 2.0 / (a * a) - 2.0));
    if (metallic <= 0.9) return;
    if (roughness < 0.1)
      m.mirror = fraction((m.specular.x + m.specular.y + m.specular.z) / 3.0f);
    else if (roughness < 0.6)
      unused_["Mirrored surroundings of metals with roughness 0.1 or more (their highlights are shown) are"]
          .insert(m.name);
  }

  void map_emission(const tinygltf::Material& from, Material& m) {
    const double strength =
        number(extension(from.extensions, "KHR_materials_emissive_strength"), "emissiveStrength", 1.0);
    m.emission = color(from.emissiveFactor) * static_cast<float>(strength);
    if (from.emissiveTexture.index >= 0) {  // the texture says where it glows; everywhere would be wrong
      m.emission = Vec3f(0.0f);
      unused_["Emissive textures are"].insert(m.name);
    }
  }

  void make_thin_sheet(Material& m, float transmission, double ior) {
    const double reflected = std::pow((ior - 1.0) / (ior + 1.0), 2.0);
    m.mirror = fraction(transmission * reflected);
    m.transmission = transmission - m.mirror;
    m.ior = 1.0f;
    m.thin = true;
  }

  void map_transmission(const tinygltf::Material& from, Material& m) {
    const tinygltf::Value* transmission = extension(from.extensions, "KHR_materials_transmission");
    const float factor = fraction(number(transmission, "transmissionFactor", 0.0));
    if (factor <= 0.0f) return;
    if (has(transmission, "transmissionTexture")) unused_["Transmission textures are"].insert(m.name);
    const double ior = std::max(1.0, number(extension(from.extensions, "KHR_materials_ior"), "ior", 1.5));
    const tinygltf::Value* volume = extension(from.extensions, "KHR_materials_volume");
    m.mirror = 0.0f;
    if (!(number(volume, "thicknessFactor", 0.0) > 0.0)) return make_thin_sheet(m, factor, ior);
    if (has(volume, "thicknessTexture"))
      unused_["Thickness textures (the geometry's own thickness counts) are"].insert(m.name);
    m.transmission = factor;
    m.ior = static_cast<float>(std::min(ior, 100.0));
    const double distance = number(volume, "attenuationDistance", infinity);
    const Vec3f attenuation = color(numbers(volume, "attenuationColor", {1.0, 1.0, 1.0}));
    constexpr float darkest = 1e-6f;  // ln(0) is not finite; this is black after one attenuation distance
    if (distance > 0.0 && std::isfinite(distance))
      m.absorption = -glm::log(glm::clamp(attenuation, darkest, 1.0f)) / static_cast<float>(distance);
  }

  void map_alpha(const tinygltf::Material& from, Material& m, bool texture_has_alpha) {
    m.alpha = fraction(from.pbrMetallicRoughness.baseColorFactor.size() == 4
                           ? from.pbrMetallicRoughness.baseColorFactor[3]
                           : 1.0);
    if (from.alphaMode == "MASK") {
      m.alpha_mode = AlphaMode::mask;
      m.alpha_cutoff = static_cast<float>(from.alphaCutoff);
    }
    if (from.alphaMode != "BLEND") return;
    if (m.transmission > 0.0f) {
      scene_.notes.push_back(fmt::format("Material '{}': blending was left to its transmission.", m.name));
    } else if (texture_has_alpha) {
      m.alpha_mode = AlphaMode::mask;
      scene_.notes.push_back(
          fmt::format("Material '{}': blending became an alpha mask with cutoff 0.5.", m.name));
    } else if (m.alpha < 1.0f) {
      make_thin_sheet(m, 1.0f - m.alpha, 1.0);
      scene_.notes.push_back(
          fmt::format("Material '{}': blending with alpha {:g} became a thin sheet with transmission {:g}.",
                      m.name, m.alpha, m.transmission));
      m.alpha = 1.0f;
    }
  }

  // The unknown ones in the file's own list are noted by gltf_check.
  bool is_listed(const std::string& name) const {
    const auto& used = model_.extensionsUsed;
    return std::find(used.begin(), used.end(), name) != used.end();
  }

  void note_unused(const tinygltf::Material& from, const std::string& name) {
    if (from.normalTexture.index >= 0) unused_["Normal textures are"].insert(name);
    if (from.occlusionTexture.index >= 0) unused_["Occlusion textures are"].insert(name);
    if (from.extensions.contains("KHR_materials_unlit"))
      unused_["KHR_materials_unlit (they are lit like the others) is"].insert(name);
    for (const auto& [key, value] : from.extensions)
      if (key.starts_with("KHR_materials_") && !is_listed(key) && key != "KHR_materials_transmission" &&
          key != "KHR_materials_ior" && key != "KHR_materials_volume" &&
          key != "KHR_materials_emissive_strength" && key != "KHR_materials_specular" &&
          key != "KHR_materials_unlit")
        unused_[key + " is"].insert(name);
  }

  // Metallic and roughness factors, times the means of the texture's blue and green channels.
  Expected<Vec2> metallic_roughness(const tinygltf::Material& from) {
    const auto& pbr = from.pbrMetallicRoughness;
    Vec2 out(pbr.metallicFactor, pbr.roughnessFactor);
    const int index = pbr.metallicRoughnessTexture.index;
    if (index < 0) return out;
    const auto image = find_image(index, from.name);
    if (!image) return fail(image.error());
    if (!*image) return out;
    auto known = linear_means_.find((*image)->index);
    if (known == linear_means_.end()) {
      const auto texture = decode(**image, false);
      if (!texture) return fail(texture.error());
      known = linear_means_.emplace((*image)->index, statistics(*texture).mean).first;
    }
    const Vec3f mean = known->second;
    unused_["Metallic-roughness textures are averaged, the rest of them"].insert(from.name);
    return out * Vec2(mean.b, mean.g);
  }

  Expected<void> read_base_texture(const tinygltf::Material& from, Material& m, TextureStatistics& result) {
    const tinygltf::TextureInfo& info = from.pbrMetallicRoughness.baseColorTexture;
    sets_.back() = info.texCoord;
    if (const tinygltf::Value* transform = extension(info.extensions, "KHR_texture_transform")) {
      const auto offset = numbers(transform, "offset", {0.0, 0.0});
      const auto scale = numbers(transform, "scale", {1.0, 1.0});
      m.texture_transform = {
          {offset[0], offset[1]}, {scale[0], scale[1]}, number(transform, "rotation", 0.0)};
      sets_.back() = static_cast<int>(number(transform, "texCoord", info.texCoord));
    }
    if (sets_.back() < 0 || sets_.back() > 1) {
      scene_.notes.push_back(fmt::format(
          "Material '{}': texture coordinates {} are not used (allowed 0 and 1).", m.name, sets_.back()));
      return {};
    }
    const auto image = find_image(info.index, m.name);
    if (!image) return fail(image.error());
    if (!*image) return {};
    if (const auto known = textures_.find(info.index); known != textures_.end()) {
      m.diffuse_texture = known->second;
    } else {
      auto texture = decode(**image, true);
      if (!texture) return fail(texture.error());
      apply_sampler(info.index, *texture, m.name);
      m.diffuse_texture = static_cast<std::uint32_t>(scene_.textures.size());
      textures_.emplace(info.index, m.diffuse_texture);
      scene_.textures.push_back(std::move(*texture));
    }
    auto& known = statistics_[m.diffuse_texture];
    if (!known) known = statistics(scene_.textures[m.diffuse_texture]);
    result = *known;
    return {};
  }

  void note_once(std::string note) {
    if (std::find(scene_.notes.begin(), scene_.notes.end(), note) == scene_.notes.end())
      scene_.notes.push_back(std::move(note));
  }

  // Of a texture: the plain image first, then what an extension offers; -1 where there is none.
  static std::vector<int> sources(const tinygltf::Texture& texture) {
    std::vector<int> out;
    if (texture.source >= 0) out.push_back(texture.source);
    const tinygltf::Value* webp = extension(texture.extensions, "EXT_texture_webp");
    if (const double source = number(webp, "source", -1.0); source >= 0.0)
      out.push_back(static_cast<int>(std::min(source, 2147483647.0)));
    return out;
  }

  // None where no file of it is there, or none that can be decoded: said, and the material's plain factors are
  // used.
  Expected<std::optional<GltfImage>> find_image(int texture_index, const std::string& material) {
    const tinygltf::Texture& texture = model_.textures[static_cast<std::size_t>(texture_index)];
    std::string why = extension(texture.extensions, "KHR_texture_basisu") != nullptr
                          ? "is in Basis Universal alone, which is not decoded"
                          : "has no image";
    for (const int source : sources(texture)) {
      if (static_cast<std::size_t>(source) >= data_.image_count())
        return fail(Error{ErrorKind::bad_input,
                          fmt::format("there is no such image (got {}, allowed 0 to {})", source,
                                      static_cast<std::int64_t>(data_.image_count()) - 1),
                          file_, 0, 0, fmt::format("textures[{}].source", texture_index)});
      auto image = data_.image(static_cast<std::size_t>(source));
      if (!image) return fail(image.error());
      if (!image->bytes.empty()) return std::move(*image);
      why = image->uri.empty() ? "is empty" : fmt::format("{} is not there", printable(image->uri, 80));
    }
    note_once(fmt::format("Material '{}': the texture {}; its plain colour is used.", material, why));
    return std::nullopt;
  }

  void apply_sampler(int texture_index, Texture& texture, const std::string& material) {
    const int index = model_.textures[static_cast<std::size_t>(texture_index)].sampler;
    if (index < 0) return;
    const tinygltf::Sampler& sampler = model_.samplers[static_cast<std::size_t>(index)];
    texture.repeat_s = sampler.wrapS != TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    texture.repeat_t = sampler.wrapT != TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    texture.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
    if (sampler.wrapS == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ||
        sampler.wrapT == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT)
      unused_["Mirrored repeat of textures (they repeat plainly) is"].insert(material);
  }

  Expected<Texture> decode(const GltfImage& image, bool srgb) const {
    const std::string path = fmt::format("images[{}]", image.index);
    auto texture = read_texture_bytes(path, image.bytes, srgb);
    if (!texture) return fail(Error{ErrorKind::bad_input, texture.error().reason, file_, 0, 0, path});
    texture->name = image.name;
    return texture;
  }

  Scene& scene_;
  const tinygltf::Model& model_;
  GltfData& data_;
  const std::string& file_;
  TexcoordSets sets_;
  std::map<int, std::uint32_t> textures_;                                 // glTF texture to ours
  std::map<std::uint32_t, std::optional<TextureStatistics>> statistics_;  // of ours
  std::map<std::size_t, Vec3f> linear_means_;            // of glTF images that are no colours
  std::map<std::string, std::set<std::string>> unused_;  // what, and by which materials
};

}  // namespace

Expected<TexcoordSets> add_gltf_materials(Scene& scene, const tinygltf::Model& model, GltfData& data,
                                          const std::string& file) {
  return MaterialReader(scene, model, data, file).run();
}

}  // namespace gnomon
