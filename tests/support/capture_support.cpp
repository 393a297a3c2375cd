#include "support/capture_support.h"

#include <fmt/format.h>

#include <filesystem>

#include "scene/files/write_file.h"
#include "scene/load.h"

namespace gnomon::test {
namespace {

Channel channel_of(const std::string& name, const Image<float>& values) {
  return {name, values.data};
}

void write(const std::string& file, ImageSize size, const std::vector<Channel>& channels) {
  const auto written = write_exr(file, size, channels);
  ASSERT_TRUE(written) << written.error().message();
}

std::vector<Channel> position_channels(const raytrace::RayTracedFrame& frame) {
  std::vector<Channel> out{{"X", {}}, {"Y", {}}, {"Z", {}}, {"A", {}}};
  for (const raytrace::SurfacePoint& point : frame.receiver.data) {
    const bool hit = point.primitive != no_id;
    for (int k = 0; k < 3; ++k)
      out[static_cast<std::size_t>(k)].values.push_back(hit ? static_cast<float>(point.position[k]) : 0.0f);
    out[3].values.push_back(hit ? 1.0f : 0.0f);
  }
  return out;
}

/// World units along each texel's ray, of the stored depths of a perspective map.
std::vector<float> distances(const raster::ShadowMap& map, int face) {
  const LightView& view = map.view;
  std::vector<float> out;
  for (int row = 0; row < view.size; ++row)
    for (int column = 0; column < view.size; ++column) {
      const double stored = map.depth[map.texel_index(face, column, row)];
      const Vec3 ray = texel_ray(view, face, column + 0.5, row + 0.5).direction;
      out.push_back(holds_caster(view, stored)
                        ? static_cast<float>(depth_from_stored(view, face, row + 0.5, stored) /
                                             glm::dot(ray, view.face(face).forward))
                        : 0.0f);
    }
  return out;
}

std::vector<float> stored(const raster::ShadowMap& map, int face) {
  const auto texels = static_cast<std::size_t>(map.view.size) * static_cast<std::size_t>(map.view.size);
  const auto first = map.depth.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(face) * texels);
  return {first, first + static_cast<std::ptrdiff_t>(texels)};
}

void capture_map(const Compared& drawn, const std::string& folder, compare::Capture& out) {
  const raster::LightRecord& record = drawn.result.raster.lights[0];
  LightView view = record.map.view;
  view.reversed = false;
  const bool parallel = view.projection == LightProjection::orthographic;
  for (int face = 0; face < view.face_count; ++face) {
    compare::CapturedLayer& layer = out.map.emplace_back();
    layer.depth = folder + "/map" + std::to_string(face) + ".exr";
    layer.convention = parallel ? compare::StoredDepth::zero_to_one : compare::StoredDepth::distance;
    layer.rows = compare::RowOrder::bottom_up;
    Mat4 matrix = light_clip_from_relative(view, face, Vec3(0.0));
    if (!parallel)  // z from [0, w] to [-w, w]
      for (int column = 0; column < 4; ++column)
        matrix[column][2] = 2.0 * matrix[column][2] - matrix[column][3];
    layer.clip_from_world = matrix;
    write(layer.depth, {view.size, view.size},
          {{"Z", parallel ? stored(record.map, face) : distances(record.map, face)}});
  }
  const LightFace& face = view.face(0);
  const double unit = parallel ? face.far_depth - face.near_depth : 1.0;
  out.bias = compare::CapturedBias{.constant_depth = record.bias_constant_world / unit,
                                   .slope = drawn.result.raster.options.map.bias.slope};
  out.filter = compare::CapturedFilter{};
}

std::string quoted(const std::string& text) {
  return '"' + text + '"';
}

std::string map_json(const compare::Capture& c) {
  std::string out;
  for (const compare::CapturedLayer& layer : c.map) {
    out += (out.empty() ? "" : ", ") + std::string("{\"depth\": ") + quoted(layer.depth) +
           ", \"convention\": " +
           quoted(std::string(compare::stored_depth_names[static_cast<std::size_t>(*layer.convention)])) +
           ", \"rows\": " +
           quoted(std::string(compare::row_order_names[static_cast<std::size_t>(*layer.rows)])) +
           ", \"clip_from_world\": [";
    for (int i = 0; i < 16; ++i)
      out += (i == 0 ? "" : ", ") + fmt::format("{}", (*layer.clip_from_world)[i / 4][i % 4]);
    out += "]}";
  }
  return out;
}

}  // namespace

std::string write_json(const compare::Capture& c, const std::string& folder) {
  std::string text = "{\"schema\": \"gnomon/capture/1\", \"renderer\": {\"name\": " + quoted(c.renderer) +
                     "}, \"scene\": " + quoted(c.scene) + ", \"light\": " + quoted(c.light) +
                     fmt::format(", \"size\": [{}, {}]", c.size.width, c.size.height) +
                     ", \"visibility\": " + quoted(c.visibility);
  if (!c.position.empty()) text += ", \"position\": " + quoted(c.position);
  if (!c.map.empty()) {
    text += ", \"map\": [" + map_json(c) + "]";
    text += fmt::format(", \"bias\": {{\"constant_depth\": {}, \"slope\": {}}}", c.bias->constant_depth,
                        c.bias->slope);
    text += ", \"filter\": {\"kind\": \"none\"}";
  }
  const std::string file = folder + "/capture.json";
  EXPECT_TRUE(write_file(file, text + "}\n"));
  return file;
}

Compared draw_builtin(const std::string& name, ImageSize size, const raster::MapOptions& map) {
  auto scene = load_scene(name);
  EXPECT_TRUE(scene);
  compare::CompareOptions options = test_options(size, map.size);
  options.raster.map = map;
  scene->lights.resize(1);
  options.perceptual = false;
  return run_comparison(std::move(*scene), options);
}

compare::Capture self_capture(const Compared& drawn, const std::string& folder, const CaptureParts& parts) {
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  compare::Capture out;
  out.renderer = "gnomon";
  out.scene = drawn.scene->path;
  out.light = drawn.scene->lights[drawn.light().light].name;
  out.size = drawn.result.raster.options.size;
  out.visibility = folder + "/visibility.exr";
  std::vector<Channel> shadow{channel_of("V", drawn.result.raster.lights[0].visibility)};
  // What faces away from the light is dark, whatever the map says.
  for (std::size_t i = 0; i < shadow[0].values.size(); ++i)
    if (drawn.light().labels.data[i] == compare::Label::facing_away) shadow[0].values[i] = 0.0f;
  const std::vector<Channel> positions = position_channels(drawn.result.raytraced);
  if (parts.mask) shadow.push_back(positions[3]);
  write(out.visibility, out.size, shadow);
  if (parts.positions) {
    out.position = folder + "/position.exr";
    write(out.position, out.size, positions);
  }
  if (parts.map) capture_map(drawn, folder, out);
  return out;
}

void spoil(const std::string& file, const Spoil& change) {
  auto image = read_channels(file);
  ASSERT_TRUE(image);
  change(*image);
  write(file, image->size, image->channels);
}

Verdict judge(const compare::Capture& capture, const compare::JudgeOptions& options) {
  Verdict out;
  auto scene = load_scene(capture.scene);
  if (!scene) return out;
  out.scene = std::make_unique<Scene>(std::move(*scene));
  out.world = std::make_unique<World>(make_world(*out.scene));
  out.result = compare::judge_capture(capture, *out.scene, *out.world, options);
  return out;
}

}  // namespace gnomon::test
