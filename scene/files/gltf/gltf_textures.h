// Textures of glTF materials: which image is taken, and how it is looked up.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>

#include "scene/base/expected.h"
#include "scene/files/gltf/gltf_data.h"
#include "scene/files/material_notes.h"
#include "scene/scene.h"

namespace gnomon {

/// What a material says of one of its textures; index < 0: it has none.
struct GltfTextureUse {
  int index = -1;
  int set = 0;  ///< of texture coordinates
  TextureTransform transform{};
};
/// `info` is the textureInfo object (glTF 2.0, section 5.28); nullptr and what is no object: none.
GltfTextureUse texture_use(const JsonValue* info);

/// What is not used of a file, and by which materials.
using UnusedParts = std::map<std::string, std::set<std::string>>;

struct TextureStatistics {
  Vec3f mean{1.0f};                                 ///< linear when the texture is sRGB
  float least_alpha = 1.0f, greatest_alpha = 1.0f;  ///< in [0, 1]
};

class GltfTextures {
 public:
  GltfTextures(Scene& scene, const JsonDocument& json, GltfData& data, UnusedParts& unused)
      : scene_(scene), json_(json), data_(data), unused_(unused) {}

  /// Decodes what is likely to be asked for, in parallel: textures of colours (sRGB), and such as only their means are
  /// asked of. What is wrong with one is said when it is asked for.
  void decode_ahead(const std::set<int>& colours, const std::set<int>& means);
  /// The scene's index of an sRGB texture, decoded the first time. no_id where no image of it is there, or none
  /// that can be decoded: said, and the material's plain factors are used.
  Expected<std::uint32_t> add(int index, const std::string& material);
  /// Returns the statistics of a texture that add() gave.
  const TextureStatistics& statistics(std::uint32_t texture) const { return statistics_[texture]; }
  /// The mean of a texture that holds no colours, in [0, 1]; none where it is not there.
  Expected<std::optional<Vec3f>> linear_mean(int index, const std::string& material);
  /// Notes on textures that are not there.
  void add_notes() { notes_.put(scene_); }

 private:
  struct Decoded {
    GltfImage image;
    bool srgb = true;
    std::optional<Texture> texture;
    TextureStatistics statistics;
  };
  /// One for each image of these textures that is there.
  void list_images(const std::set<int>& textures, bool srgb, std::vector<Decoded>& out);
  Expected<Decoded> claim_decoded(const GltfImage& image);

  Expected<std::optional<GltfImage>> find_image(int index, const std::string& material);
  Expected<Texture> decode(const GltfImage& image, bool srgb) const;
  const JsonValue& texture_at(int index) const;
  void apply_sampler(int index, Texture& texture, const std::string& material);

  Scene& scene_;
  MaterialNotes notes_;
  const JsonDocument& json_;
  GltfData& data_;
  UnusedParts& unused_;
  std::map<std::size_t, Decoded> ahead_;       // glTF images of colours
  std::map<int, std::uint32_t> textures_;      // glTF texture to ours
  std::vector<TextureStatistics> statistics_;  // of ours
  std::map<std::size_t, Vec3f> linear_means_;  // of glTF images that are no colours
};

}  // namespace gnomon
