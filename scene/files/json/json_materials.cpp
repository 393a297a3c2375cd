// Materials and textures of a JSON scene.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include "scene/files/json/json_generate.h"
#include "scene/files/json/json_parts.h"
#include "scene/files/pictures/image_io.h"
#include "scene/files/pictures/texture_memory.h"
#include "scene/files/read_file.h"

namespace gnomon {
namespace {

Texture texture_pixels(SceneReader& reader, const JsonObject& object, const std::string& path) {
  if (path.empty()) {
    object.forbid("srgb", "does not apply to a generated texture");
    const JsonNode node = *object.find("generate");
    auto texture = generate_from_json<Texture>(node, &generate_texture);
    const HeaderCheck fits = TextureMemory::kept(reader.options.textures, {});
    if (texture && fits)
      if (const auto taken = fits(texture->size, 0); !taken) reader.adopt(node, taken.error());
    return texture ? std::move(*texture) : Texture{};
  }
  const bool srgb = object.boolean("srgb", true);
  if (reader.failed()) return {};
  auto texture = read_texture(path, srgb, TextureMemory::kept(reader.options.textures, path));
  if (texture) return std::move(*texture);
  reader.adopt(*object.find("file"), texture.error());
  return {};
}

/// An image file is decoded once for all materials that show it in the same way.
std::uint32_t texture_index(SceneReader& reader, const JsonObject& object) {
  const std::string_view source = object.exactly_one({"file", "generate"});
  const std::string path = source == "file" ? reader.resolve(*object.find("file")) : std::string();
  if (reader.failed() || source.empty()) return 0;
  const auto filter = object.find("filter"), wrap = object.find("wrap");
  const bool nearest = filter && filter->as_choice({"bilinear", "nearest"}) == 1;
  const bool repeat = !wrap || wrap->as_choice({"repeat", "clamp"}) == 0;
  const std::string key = fmt::format("{}{}{} {}", object.boolean("srgb", true), nearest, repeat, path);
  const auto next = static_cast<std::uint32_t>(reader.scene.textures.size());
  if (!path.empty())
    if (const auto [known, is_new] = reader.textures.try_emplace(key, next); !is_new) return known->second;
  Texture texture = texture_pixels(reader, object, path);
  texture.nearest = nearest;
  texture.repeat_s = texture.repeat_t = repeat;
  reader.scene.textures.push_back(std::move(texture));
  return next;
}

void read_texture_of(SceneReader& reader, const JsonNode& node, std::uint32_t& texture,
                     TextureTransform& transform) {
  const JsonObject object(
      node, {"file", "generate", "srgb", "filter", "wrap", "offset", "scale", "rotation_degrees"});
  if (reader.failed()) return;
  texture = texture_index(reader, object);
  if (const auto offset = object.find("offset")) transform.offset = offset->as_vec2();
  if (const auto scale = object.find("scale")) transform.scale = scale->as_scale2();
  transform.rotation = object.number("rotation_degrees", 0.0, coordinate_range) * pi / 180.0;
}

Material read_material(SceneReader& reader, const JsonNode& node) {
  const JsonObject object(
      node, {"name",         "diffuse",      "specular",       "shininess",    "emission",         "mirror",
             "transmission", "ior",          "absorption",     "roughness",    "priority",         "thin",
             "texture",      "alpha",        "alpha_mode",     "alpha_cutoff", "emission_texture", "unlit",
             "double_sided", "casts_shadow", "receives_shadow"});
  const auto number = [&](std::string_view key, float otherwise, const NumberRange& range) {
    return static_cast<float>(object.number(key, static_cast<double>(otherwise), range));
  };
  Material m;
  if (const auto name = object.require("name")) m.name = name->as_string();
  m.diffuse = object.color("diffuse", m.diffuse, unit_interval);
  m.specular = object.color("specular", m.specular, unit_interval);
  m.shininess = number("shininess", m.shininess, {0.001, 1e6});
  m.emission = object.color("emission", m.emission);
  m.mirror = number("mirror", m.mirror, unit_interval);
  m.transmission = number("transmission", m.transmission, unit_interval);
  m.ior = number("ior", m.ior, {0.01, 100.0});
  m.absorption = object.color("absorption", m.absorption);
  m.roughness = number("roughness", m.roughness, unit_interval);
  m.priority = static_cast<int>(object.number("priority", m.priority, {-1000.0, 1000.0, false, false, true}));
  m.thin = object.boolean("thin", m.thin);
  m.alpha = number("alpha", m.alpha, unit_interval);
  if (const auto mode = object.find("alpha_mode"))
    m.alpha_mode = mode->as_choice({"opaque", "mask"}) == 1 ? AlphaMode::mask : AlphaMode::opaque;
  m.alpha_cutoff = number("alpha_cutoff", m.alpha_cutoff, unit_interval);
  const auto transmission = object.find("transmission");
  if (transmission && m.mirror + m.transmission > 1.0f)  // mirror alone has its own range
    transmission->error(
        fmt::format("mirror + transmission (got {:g} + {:g}, allowed up to 1)", m.mirror, m.transmission));
  m.unlit = object.boolean("unlit", m.unlit);
  m.double_sided = object.boolean("double_sided", m.double_sided);
  m.casts_shadow = object.boolean("casts_shadow", m.casts_shadow);
  m.receives_shadow = object.boolean("receives_shadow", m.receives_shadow);
  if (const auto texture = object.find("texture"))
    read_texture_of(reader, *texture, m.diffuse_texture, m.texture_transform);
  if (const auto texture = object.find("emission_texture"))
    read_texture_of(reader, *texture, m.emission_texture, m.emission_transform);
  return m;
}

}  // namespace

void read_materials(SceneReader& reader, const JsonNode& list) {
  for (const JsonNode& node : list.as_array()) {
    Material material = read_material(reader, node);
    if (reader.failed()) return;
    const auto index = static_cast<std::uint32_t>(reader.scene.materials.size());
    if (!reader.names.materials.emplace(material.name, index).second) {
      return node.child("name")->error(
          fmt::format("another material has this name (got \"{}\")", printable(material.name)));
    }
    reader.scene.materials.push_back(std::move(material));
  }
}

std::uint32_t find_material(SceneReader& reader, const JsonNode& name) {
  const std::string text = name.as_string();
  if (reader.failed()) return 0;
  const auto found = reader.names.materials.find(text);
  if (found != reader.names.materials.end()) return found->second;
  std::vector<std::string_view> names;
  for (const auto& entry : reader.names.materials) names.push_back(entry.first);
  name.error(fmt::format("no such material (got \"{}\", allowed {}){}", printable(text),
                         names.empty() ? "none: there are no materials" : list_names(names),
                         suggestion(text, names)));
  return 0;
}

}  // namespace gnomon
