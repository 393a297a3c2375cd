#include "scene/files/obj_textures.h"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <filesystem>

#include "scene/files/read_file.h"
#include "scene/files/texture_file.h"

namespace gnomon {
namespace {

std::string with_slashes(std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  return name;
}

// In v-up terms the lookup is s * v + o; with v' = 1 - v on both sides that is s * v' + (1 - s - o).
TextureTransform transform_of(const tinyobj::texture_option_t& option) {
  TextureTransform t;
  t.scale = {option.scale[0], option.scale[1]};
  t.offset = {option.origin_offset[0], 1.0 - option.scale[1] - option.origin_offset[1]};
  return t;
}

bool lie_alike(const tinyobj::texture_option_t& a, const tinyobj::texture_option_t& b) {
  const TextureTransform of_a = transform_of(a), of_b = transform_of(b);
  return of_a.scale == of_b.scale && of_a.offset == of_b.offset && a.clamp == b.clamp;
}

/// A picture of numbers, such as a mask.
bool is_grey(const Texture& texture) {
  return std::all_of(texture.texels.begin(), texture.texels.end(),
                     [](const glm::u8vec4& t) { return t.r == t.g && t.g == t.b; });
}

}  // namespace

bool ObjTextures::is_cut_out(const tinyobj::material_t& from) const {
  const auto path = [&](const std::string& name) {
    return (std::filesystem::path(folder_) / with_slashes(name)).lexically_normal();
  };
  return !from.alpha_texname.empty() && !from.diffuse_texname.empty() &&
         path(from.alpha_texname) == path(from.diffuse_texname);
}

Expected<ObjTextures::Known> ObjTextures::find_or_read(const std::string& path, bool clamped, bool cut_out) {
  if (const auto found = known_.find({path, clamped, cut_out}); found != known_.end()) return found->second;
  auto file = read_texture_file(path, true);
  if (!file) return fail(file.error());
  Texture& texture = file->texture;
  texture.repeat_s = texture.repeat_t = !clamped;
  const Mask mask = file->has_alpha ? Mask::alpha : cut_out && is_grey(texture) ? Mask::grey : Mask::none;
  const Known known{static_cast<std::uint32_t>(scene_.textures.size()), mask};
  if (mask == Mask::grey)
    for (glm::u8vec4& texel : texture.texels) texel.a = texel.r;  // as it is stored: numbers are not encoded
  scene_.textures.push_back(std::move(texture));
  known_.emplace(Key{path, clamped, cut_out}, known);
  if (file->has_alpha) known_.emplace(Key{path, clamped, !cut_out}, known);  // one texture serves both
  return known;
}

Expected<void> ObjTextures::add(const tinyobj::material_t& from, Material& material) {
  const auto note = [&](const std::string& words) {
    scene_.notes.push_back(fmt::format("Material '{}': {}.", from.name, words));
  };
  const bool cut_out = is_cut_out(from);
  if (!from.alpha_texname.empty() && !cut_out) note("map_d is used only when it is map_Kd's file");
  if (from.diffuse_texname.empty()) return {};
  const auto path = resolve_path(folder_, with_slashes(from.diffuse_texname), options_);
  if (!path) {
    Error error = path.error();
    error.field = fmt::format("{}.map_Kd", from.name);
    return fail(std::move(error));
  }
  std::error_code ignored;
  if (!std::filesystem::exists(*path, ignored)) {
    note(fmt::format("the texture {} is not there; its plain colour is used", *path));
    return {};
  }
  const auto known = find_or_read(*path, from.diffuse_texopt.clamp, cut_out);
  if (!known) return fail(known.error());
  material.diffuse_texture = known->texture;
  material.texture_transform = transform_of(from.diffuse_texopt);
  if (!cut_out) return {};
  if (known->mask == Mask::none) {
    note(fmt::format("map_d is not used: {} has colours and no alpha channel", from.diffuse_texname));
    return {};
  }
  material.alpha_mode = AlphaMode::mask;
  if (known->mask == Mask::grey)
    note(fmt::format("map_d is the grey of {}, which has no alpha channel", from.diffuse_texname));
  if (!lie_alike(from.diffuse_texopt, from.alpha_texopt))
    note("map_d lies as map_Kd does: its own -s, -o and -clamp are not used");
  return {};
}

}  // namespace gnomon
