#include "scene/files/gltf/gltf_writer.h"

#include <fmt/core.h>

#include <limits>

#include "scene/base/expected.h"
#include "scene/camera.h"
#include "scene/files/defaults.h"
#include "scene/files/encodings.h"
#include "scene/files/gltf/gltf_extras.h"
#include "scene/files/gltf/gltf_writer_parts.h"
#include "scene/light.h"

namespace gnomon {
namespace gltf_writer {

std::size_t File::add_view(std::string_view bytes, int target) {
  binary.resize((binary.size() + 3) / 4 * 4, '\0');
  Json view{{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}};
  if (target != 0) view["target"] = target;
  binary += bytes;
  return add("bufferViews", std::move(view));
}

double shortest(float value) {
  return std::stod(fmt::format("{}", value));
}
Json shortest(const Vec3f& value) {
  return {shortest(value.x), shortest(value.y), shortest(value.z)};
}
Json array(const Vec3& value) {
  return {value.x, value.y, value.z};
}
Json array(const Mat4& value) {
  Json out = Json::array();
  for (int i = 0; i < 16; ++i) out.push_back(value[i / 4][i % 4]);
  return out;
}

namespace {

// Near and far are for programs that need them: behind everything finite, and a thousandth of that, or half
// way to the nearest corner.
Json clip_distances(const Scene& scene, const View& view) {
  const Aabb bounds = scene_bounds(scene);
  double near = infinity, far = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p((corner & 1) ? bounds.max.x : bounds.min.x, (corner & 2) ? bounds.max.y : bounds.min.y,
                 (corner & 4) ? bounds.max.z : bounds.min.z);
    const double depth = glm::dot(p - view.eye, view.forward);
    near = std::min(near, depth), far = std::max(far, depth);
  }
  if (scene.camera.orthographic()) {
    if (!(far > 0.0) || !std::isfinite(far)) far = 100.0, near = 0.0;
    return {{"znear", std::max(0.0, near - 0.01 * far)}, {"zfar", 1.01 * far}};
  }
  if (!(far > 0.0) || !std::isfinite(far)) return {{"znear", 0.01}};
  return {{"znear", std::max(1e-3 * far, 0.5 * near)}, {"zfar", 1.01 * far}};
}

void write_camera(File& file, const Scene& scene) {
  const View view = make_view(scene.camera, {1, 1});
  const char* type = scene.camera.orthographic() ? "orthographic" : "perspective";
  Json own = clip_distances(scene, view);
  if (scene.camera.orthographic())
    own["xmag"] = own["ymag"] = 0.5 * scene.camera.orthographic_height;
  else
    own["yfov"] = scene.camera.vertical_fov;
  const std::size_t camera =
      file.add("cameras", {{"type", type}, {type, std::move(own)}, {"extras", camera_extras(scene.camera)}});
  const Mat4 matrix{Vec4(view.right, 0.0), Vec4(view.up, 0.0), Vec4(-view.forward, 0.0), Vec4(view.eye, 1.0)};
  file.add("nodes", {{"name", "camera"}, {"camera", camera}, {"matrix", array(matrix)}});
}

// Lux for a directional light, candela for the others: as our intensities are.
Json light_json(const Light& light) {
  const Vec3f& rgb = light.intensity;
  const double strength = shortest(std::max({rgb.x, rgb.y, rgb.z}));
  const Vec3 color =
      strength > 0.0 ? Vec3(shortest(rgb.x), shortest(rgb.y), shortest(rgb.z)) / strength : Vec3(1.0);
  Json out{{"type", light_type_name(light.type)},
           {"name", light.name},
           {"color", array(color)},
           {"intensity", strength}};
  if (light.type == LightType::spot)
    out["spot"] = {{"innerConeAngle", light.inner_angle}, {"outerConeAngle", light.outer_angle}};
  if (Json extras = light_extras(light); !extras.is_null()) out["extras"] = std::move(extras);
  return out;
}

void write_lights(File& file, const Scene& scene) {
  Json lights = Json::array();
  for (const Light& light : scene.lights) {
    Vec3 right, up;
    orthonormal_basis(-light.direction, right, up);
    const Mat4 matrix{Vec4(right, 0.0), Vec4(up, 0.0), Vec4(-light.direction, 0.0),
                      Vec4(light.position, 1.0)};
    const Json reference{{"light", lights.size()}};
    file.add("nodes", {{"name", light.name},
                       {"matrix", array(matrix)},
                       {"extensions", {{"KHR_lights_punctual", reference}}}});
    lights.push_back(light_json(light));
    if (!std::holds_alternative<PointShape>(light.extent))
      file.notes.push_back(fmt::format(
          "The size of the light '{}' stands in its extras: others take it for a hard light.", light.name));
  }
  file.extensions.insert("KHR_lights_punctual");
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = std::move(lights);
}

void append_word(std::string& out, std::size_t value) {
  for (int i = 0; i < 4; ++i) out += static_cast<char>(value >> (8 * i) & 255u);
}

// glTF 2.0, section 4.4.
Expected<std::string> glb(std::string text, std::string binary) {
  text.resize((text.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4, '\0');
  const std::size_t total = 12 + 8 + text.size() + 8 + binary.size();
  if (total > std::numeric_limits<std::uint32_t>::max())
    return fail(ErrorKind::cannot_write,
                fmt::format("the scene is too large for a GLB (got {} bytes, allowed 4294967295)", total));
  std::string out = "glTF";
  append_word(out, 2), append_word(out, total);
  append_word(out, text.size());
  out += "JSON" + text;
  append_word(out, binary.size());
  out += std::string_view("BIN\0", 4);
  return out + binary;
}

void write_scene(File& file, const Scene& scene) {
  Json roots = Json::array();
  for (std::size_t i = 0; i < file.json["nodes"].size(); ++i) roots.push_back(i);
  file.json["scene"] = 0;
  file.json["scenes"] = Json::array({{{"name", scene.name}, {"nodes", std::move(roots)}}});
  file.json["extensionsUsed"] = file.extensions;
  file.json["extras"] = scene_extras(scene);
}

}  // namespace
}  // namespace gltf_writer

Expected<GltfFile> write_gltf(const Scene& scene, bool binary) {
  gltf_writer::File file;
  file.json["asset"] = {{"version", "2.0"}, {"generator", gltf_generator}};
  if (const auto written = gltf_writer::write_materials(file, scene); !written) return fail(written.error());
  gltf_writer::write_instances(file, scene);
  gltf_writer::write_lights(file, scene);
  gltf_writer::write_camera(file, scene);
  gltf_writer::write_scene(file, scene);
  gltf_writer::Json buffer{{"byteLength", file.binary.size()}};
  if (!binary) buffer["uri"] = "data:application/octet-stream;base64," + base64(file.binary);
  file.json["buffers"] = gltf_writer::Json::array({std::move(buffer)});
  const auto replace = gltf_writer::Json::error_handler_t::replace;
  std::string text = plain_lines(file.json.dump(binary ? -1 : 1, ' ', false, replace));
  if (!binary) return GltfFile{text + "\n", std::move(file.notes)};
  auto bytes = gltf_writer::glb(std::move(text), std::move(file.binary));
  if (!bytes) return fail(bytes.error());
  return GltfFile{std::move(*bytes), std::move(file.notes)};
}

}  // namespace gnomon
