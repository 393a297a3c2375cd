#include "scene/files/gltf/gltf_textures.h"

#include <fmt/core.h>

#include <algorithm>

#include "scene/base/parallel.h"
#include "scene/files/gltf/gltf_value.h"
#include "scene/files/pictures/image_io.h"
#include "scene/files/pictures/texture_memory.h"
#include "scene/files/read_file.h"
#include "scene/texture_sample.h"

namespace gnomon {
namespace {

TextureStatistics statistics_of(const Texture& texture) {
  TextureStatistics out;
  Vec3 sum(0.0);
  std::uint8_t least = 255, greatest = 0;
  const auto& linear = linear_from_srgb8();
  for (const glm::u8vec4& t : texture.texels) {
    sum += texture.srgb ? Vec3(linear[t.r], linear[t.g], linear[t.b]) : Vec3(t.r, t.g, t.b) / 255.0;
    least = std::min(least, t.a), greatest = std::max(greatest, t.a);
  }
  if (texture.texels.empty()) return out;
  out.least_alpha = static_cast<float>(least) / 255.0f,
  out.greatest_alpha = static_cast<float>(greatest) / 255.0f;
  out.mean = Vec3f(sum / static_cast<double>(texture.texels.size()));
  return out;
}

/// KTX 2.0, section 3.1: what every file begins with.
bool is_ktx2(std::string_view bytes) {
  return bytes.starts_with("\xabKTX 20\xbb\r\n\x1a\n");
}

/// The images of a texture: the plain one first, then what an extension offers.
std::vector<int> sources(const JsonValue& texture) {
  std::vector<int> out;
  const JsonValue* webp = extension(member(&texture, "extensions"), "EXT_texture_webp");
  for (const JsonValue* from : {&texture, webp})
    if (const double source = number_of(from, "source", -1.0); source >= 0.0)
      out.push_back(static_cast<int>(std::min(source, 2147483647.0)));
  return out;
}

}  // namespace

GltfTextureUse texture_use(const JsonValue* info) {
  GltfTextureUse use;
  use.index = static_cast<int>(std::clamp(number_of(info, "index", -1.0), -1.0, 2147483647.0));
  double set = number_of(info, "texCoord", 0.0);
  if (const JsonValue* transform = extension(member(info, "extensions"), "KHR_texture_transform")) {
    const auto offset = numbers_of(transform, "offset", {0.0, 0.0});
    const auto scale = numbers_of(transform, "scale", {1.0, 1.0});
    use.transform = {{offset[0], offset[1]}, {scale[0], scale[1]}, number_of(transform, "rotation", 0.0)};
    set = number_of(transform, "texCoord", set);
  }
  use.set = static_cast<int>(std::clamp(set, -1.0, 16.0));
  return use;
}

const JsonValue& GltfTextures::texture_at(int index) const {
  return gltf_list(json_.root, "textures")[static_cast<std::size_t>(index)];
}

Expected<std::uint32_t> GltfTextures::add(int index, const std::string& material) {
  const auto image = find_image(index, material);
  if (!image) return fail(image.error());
  if (!*image) return no_id;
  if (const auto known = textures_.find(index); known != textures_.end()) return known->second;
  auto decoded = claim_decoded(**image);
  if (!decoded) return fail(decoded.error());
  apply_sampler(index, *decoded->texture, material);
  const auto at = static_cast<std::uint32_t>(scene_.textures.size());
  textures_.emplace(index, at);
  statistics_.push_back(decoded->statistics);
  scene_.textures.push_back(std::move(*decoded->texture));
  return at;
}

void GltfTextures::decode_ahead(const std::set<int>& colours, const std::set<int>& means) {
  std::vector<Decoded> all;
  list_images(colours, true, all);
  list_images(means, false, all);
  parallel_for(all.size(), [&](std::size_t i) {
    Decoded& one = all[i];
    auto texture = decode(one.image, one.srgb);
    if (!texture) return;
    one.statistics = statistics_of(*texture);
    one.texture = one.srgb ? std::move(*texture) : Texture{};
  });
  for (Decoded& one : all) {
    const std::size_t image = one.image.index;
    if (!one.texture) continue;
    if (one.srgb)
      ahead_.emplace(image, std::move(one));
    else
      linear_means_.emplace(image, one.statistics.mean);
  }
}

void GltfTextures::list_images(const std::set<int>& textures, bool srgb, std::vector<Decoded>& out) {
  std::set<std::size_t> known;
  for (const int index : textures)
    for (const int source : sources(texture_at(index))) {
      const auto at = static_cast<std::size_t>(source);
      const auto image = at < data_.image_count() ? data_.image(at) : Expected<GltfImage>();
      if (!image || image->bytes.empty() || is_ktx2(image->bytes)) continue;
      if (known.insert(at).second) out.push_back({*image, srgb, {}, {}});
      break;  // the first that is there
    }
}

Expected<GltfTextures::Decoded> GltfTextures::claim_decoded(const GltfImage& image) {
  if (auto found = ahead_.extract(image.index)) return std::move(found.mapped());
  Decoded out{image, true, {}, {}};
  auto texture = decode(image, true);
  if (!texture) return fail(texture.error());
  out.statistics = statistics_of(*texture);
  out.texture = std::move(*texture);
  return out;
}

Expected<std::optional<Vec3f>> GltfTextures::linear_mean(int index, const std::string& material) {
  const auto image = find_image(index, material);
  if (!image) return fail(image.error());
  if (!*image) return std::nullopt;
  if (const auto known = linear_means_.find((*image)->index); known != linear_means_.end())
    return known->second;
  const auto texture = decode(**image, false);
  if (!texture) return fail(texture.error());
  return linear_means_.emplace((*image)->index, statistics_of(*texture).mean).first->second;
}

Expected<std::optional<GltfImage>> GltfTextures::find_image(int index, const std::string& material) {
  const JsonValue& texture = texture_at(index);
  std::string why = extension(member(&texture, "extensions"), "KHR_texture_basisu") != nullptr
                        ? "is in Basis Universal alone, which is not decoded"
                        : "has no image";
  for (const int source : sources(texture)) {
    if (static_cast<std::size_t>(source) >= data_.image_count())
      return fail(Error{ErrorKind::bad_input,
                        fmt::format("there is no such image (got {}, allowed 0 to {})", source,
                                    static_cast<std::int64_t>(data_.image_count()) - 1),
                        json_.file, 0, 0, fmt::format("textures[{}].source", index)});
    auto image = data_.image(static_cast<std::size_t>(source));
    if (!image) return fail(image.error());
    if (is_ktx2(image->bytes)) {
      why = "is in KTX 2, which is not decoded";
      continue;
    }
    if (!image->bytes.empty()) return std::move(*image);
    why = image->uri.empty() ? "is empty" : fmt::format("{} is not there", printable(image->uri, 80));
  }
  notes_.add(material, "the texture {}; its plain colour is used",
             "Textures are missing; plain colours are used", why);
  return std::nullopt;
}

void GltfTextures::apply_sampler(int texture_index, Texture& texture, const std::string& material) {
  constexpr double nearest = 9728.0, clamp_to_edge = 33071.0, mirrored_repeat = 33648.0, repeat = 10497.0;
  const auto& samplers = gltf_list(json_.root, "samplers");
  const int index = index_of(&texture_at(texture_index), "sampler", samplers.size());
  if (index < 0) return;
  const JsonValue* sampler = &samplers[static_cast<std::size_t>(index)];
  const double wrap_s = number_of(sampler, "wrapS", repeat), wrap_t = number_of(sampler, "wrapT", repeat);
  texture.repeat_s = wrap_s != clamp_to_edge;
  texture.repeat_t = wrap_t != clamp_to_edge;
  texture.nearest = number_of(sampler, "magFilter", 0.0) == nearest;
  if (wrap_s == mirrored_repeat || wrap_t == mirrored_repeat)
    unused_["Mirrored repeat of textures (they repeat plainly) is"].insert(material);
}

Expected<Texture> GltfTextures::decode(const GltfImage& image, bool srgb) const {
  const std::string path = fmt::format("images[{}]", image.index);
  TextureMemory* const memory = data_.options().textures;
  const HeaderCheck fits = srgb ? TextureMemory::kept(memory, path) : TextureMemory::passing(memory, path);
  auto texture = read_texture_bytes(path, image.bytes, srgb, fits);
  if (!texture) return fail(Error{texture.error().kind, texture.error().reason, json_.file, 0, 0, path});
  texture->name = image.name;
  return texture;
}

}  // namespace gnomon
