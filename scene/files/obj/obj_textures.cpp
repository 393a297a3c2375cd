#include "scene/files/obj/obj_textures.h"

#include <fmt/core.h>

#include <algorithm>

#include "scene/base/parallel.h"
#include "scene/files/path_status.h"
#include "scene/files/pictures/image_io.h"
#include "scene/files/pictures/texture_memory.h"
#include "scene/files/read_file.h"
#include "scene/texture_sample.h"

namespace gnomon {
namespace {

std::string with_slashes(std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  return name;
}

// In v-up terms the lookup is s * v + o; with v' = 1 - v on both sides that is s * v' + (1 - s - o).
TextureTransform transform_of(const MtlTexture& texture) {
  TextureTransform t;
  t.scale = texture.scale;
  t.offset = {texture.offset.x, 1.0 - texture.scale.y - texture.offset.y};
  return t;
}

bool lie_alike(const MtlTexture& a, const MtlTexture& b) {
  return a.scale == b.scale && a.offset == b.offset && a.clamped == b.clamped;
}

/// A picture of numbers, such as a mask.
bool is_grey(const Texture& texture) {
  return std::all_of(texture.texels.begin(), texture.texels.end(),
                     [](const glm::u8vec4& t) { return t.r == t.g && t.g == t.b; });
}

bool is_opaque(const Texture& texture) {
  return std::all_of(texture.texels.begin(), texture.texels.end(),
                     [](const glm::u8vec4& t) { return t.a == 255; });
}

Texture white() {
  Texture texture;
  texture.size = {1, 1};
  texture.texels = {glm::u8vec4(255)};
  return texture;
}

Texture resized(Texture from, const ImageSize& size) {
  if (from.size == size) return from;
  std::vector<glm::u8vec4> texels;
  texels.reserve(size.pixels());
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const Vec4f value = sample_texture(from, {(x + 0.5) / size.width, (y + 0.5) / size.height});
      const auto stored = [&](float v) { return to_8_bit(from.srgb ? srgb_from_linear(v) : v); };
      texels.emplace_back(stored(value.r), stored(value.g), stored(value.b), to_8_bit(value.a));
    }
  from.size = size;
  from.texels = std::move(texels);
  return from;
}

/// Makes alpha the luminance of the stored values (ITU-R BT.709's weights), as MTL's -imfchan l does. Of a grey texel
/// it is the grey.
void set_alpha_from_luminance(Texture& mask) {
  for (glm::u8vec4& t : mask.texels)
    t.a = static_cast<std::uint8_t>(std::lround(0.2126 * t.r + 0.7152 * t.g + 0.0722 * t.b));
}

/// The larger width and the larger height of the two.
ImageSize larger_of(const ImageSize& a, const ImageSize& b) {
  return {std::max(a.width, b.width), std::max(a.height, b.height)};
}

/// The colours of one texture with the alpha of the other, both wrapped as `colours` is. Where they have different
/// sizes, at the larger width and the larger height of the two: a texel then is what the lookup (texture_sample.h)
/// gives at its centre.
Texture with_alpha_of(Texture colours, Texture mask) {
  const ImageSize size = larger_of(colours.size, mask.size);
  mask.repeat_s = colours.repeat_s;
  mask.repeat_t = colours.repeat_t;
  colours = resized(std::move(colours), size);
  mask = resized(std::move(mask), size);
  for (std::size_t i = 0; i < colours.texels.size(); ++i) colours.texels[i].a = mask.texels[i].a;
  return colours;
}

}  // namespace

Expected<std::string> ObjTextures::find_file(const std::string& name, const std::string& material,
                                             const std::string& statement) {
  auto path = resolve_path(folder_, with_slashes(name), options_);
  if (path) return path;
  Error error = path.error();
  error.field = fmt::format("{}.{}", material, statement);
  return fail(std::move(error));
}

Expected<ObjTextures::Files> ObjTextures::find_files(const MtlMaterial& from) {
  Files files;
  if (!from.colours.file.empty()) {
    auto path = find_file(from.colours.file, from.name, "map_Kd");
    if (!path) return fail(path.error());
    const auto there = is_there(*path);
    if (!there) return fail(there.error());
    if (*there)
      files.colours = std::move(*path);
    else
      notes_.add(from.name, "the texture {} is not there; its plain colour is used",
                 "Textures are not there; plain colours are used", *path);
  }
  if (!from.mask.file.empty()) {
    auto path = find_file(from.mask.file, from.name, "map_d");
    if (!path) return fail(path.error());
    const auto there = is_there(*path);
    if (!there) return fail(there.error());
    if (!*there) {
      notes_.add(from.name, "the mask {} is not there; map_d is not used",
                 "Masks are not there; map_d is not used", *path);
    } else {
      const auto one = are_one_path(*path, files.colours);
      if (!one) return fail(one.error());
      files.mask = *one ? files.colours : std::move(*path);
    }
  }
  const auto& placed = files.colours.empty() ? from.mask : from.colours;
  files.clamped = placed.clamped;
  return files;
}

Expected<ObjTextures::Made> ObjTextures::make(const Files& files) const {
  auto read =
      files.colours.empty()
          ? Expected<TextureFile>(TextureFile{white(), false})
          : read_texture_file(files.colours, true, TextureMemory::kept(options_.textures, files.colours));
  if (!read) return fail(read.error());
  Made made{std::move(read->texture)};
  made.texture.repeat_s = made.texture.repeat_t = !files.clamped;
  if (files.has_mask_of_its_own()) {
    auto other = read_texture_file(files.mask, false, TextureMemory::passing(options_.textures, files.mask));
    if (!other) return fail(other.error());
    const ImageSize both = larger_of(made.texture.size, other->texture.size);
    const HeaderCheck fits = TextureMemory::kept(options_.textures, files.mask);
    if (fits && !(both == made.texture.size))
      if (const auto taken = fits(both, 0); !taken) return fail(taken.error());
    made.mask = is_opaque(other->texture) ? Mask::grey : Mask::alpha;
    if (made.mask == Mask::grey) set_alpha_from_luminance(other->texture);
    made.texture = with_alpha_of(std::move(made.texture), std::move(other->texture));
  } else if (!files.mask.empty() && read->has_alpha) {
    made.mask = Mask::alpha;
  } else if (!files.mask.empty() && is_grey(made.texture)) {
    made.mask = Mask::grey;
    set_alpha_from_luminance(made.texture);
  }
  return made;
}

Expected<void> ObjTextures::read(const std::vector<MtlMaterial>& materials) {
  std::vector<Files> wanted;  // once each
  for (const MtlMaterial& from : materials) {
    auto files = find_files(from);
    if (!files) return fail(files.error());
    const bool is_new = std::find(wanted.begin(), wanted.end(), *files) == wanted.end();
    if (is_new && !files->empty()) wanted.push_back(*files);
    files_.push_back(std::move(*files));
  }
  std::vector<Expected<Made>> all(wanted.size());
  parallel_for(all.size(), [&](std::size_t i) { all[i] = make(wanted[i]); });
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!all[i]) return fail(all[i].error());
    known_.emplace(wanted[i], Known{static_cast<std::uint32_t>(scene_.textures.size()), all[i]->mask});
    scene_.textures.push_back(std::move(all[i]->texture));
  }
  return {};
}

void ObjTextures::give(const MtlMaterial& from, std::size_t number, Material& material) {
  const Files& files = files_[number];
  if (files.empty()) return;
  const Known& known = known_.at(files);
  material.diffuse_texture = known.texture;
  material.texture_transform = transform_of(files.colours.empty() ? from.mask : from.colours);
  if (files.mask.empty()) return;
  if (known.mask == Mask::none)
    return notes_.add(from.name, "map_d is not used: {} has colours and no alpha channel",
                      "map_d is not used where it has colours and no alpha channel", from.mask.file);
  material.alpha_mode = AlphaMode::mask;
  if (known.mask == Mask::grey && !files.has_mask_of_its_own())
    notes_.add(from.name, "map_d is the grey of {}, which has no alpha channel",
               "map_d is a file's grey where that has no alpha channel", from.mask.file);
  if (!files.colours.empty() && !lie_alike(from.colours, from.mask))
    notes_.add(from.name, "map_d lies as map_Kd does: its own -s, -o and -clamp are not used",
               "map_d lies as map_Kd does: its own -s, -o and -clamp are not used");
}

}  // namespace gnomon
