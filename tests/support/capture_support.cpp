#include "tests/support/capture_support.h"

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

/// What a texel of the capture's map holds for one of the drawn map.
double converted(const LightView& view, int face, Vec2 texel, double stored, const LightView& captured,
                 judge::StoredDepth convention) {
  const bool linear = judge::is_linear(convention);
  if (!holds_caster(view, stored)) return linear || captured.reversed ? 0.0 : 1.0;
  if (!linear && view.reversed == captured.reversed) return stored;
  const double depth = depth_from_stored(view, face, texel.y, stored);
  if (!linear) return stored_from_depth(captured, face, texel.y, depth);
  if (convention == judge::StoredDepth::linear_z) return depth;
  return depth / glm::dot(texel_ray(view, face, texel.x, texel.y).direction, view.face(face).forward);
}

std::vector<float> layer_texels(const raster::ShadowMap& map, int face, const LightView& captured,
                                const judge::CapturedLayer& layer) {
  const int n = map.view.size;
  std::vector<float> out;
  for (int y = 0; y < n; ++y)
    for (int column = 0; column < n; ++column) {
      const int row = layer.rows == judge::RowOrder::top_down ? n - 1 - y : y;
      const double stored = map.depth[map.texel_index(face, column, row)];
      out.push_back(static_cast<float>(
          converted(map.view, face, {column + 0.5, row + 0.5}, stored, captured, *layer.convention)));
    }
  return out;
}

/// Returns the matrix as the convention has it: z from [0, w] to [-w, w] for two of them.
Mat4 layer_matrix(const LightView& captured, int face, judge::StoredDepth convention) {
  Mat4 matrix = light_clip_from_relative(captured, face, Vec3(0.0));
  if (convention == judge::StoredDepth::minus_one_to_one || judge::is_linear(convention))
    for (int column = 0; column < 4; ++column)
      matrix[column][2] = 2.0 * matrix[column][2] - matrix[column][3];
  return matrix;
}

void capture_map(const Compared& drawn, const std::string& folder, const CaptureParts& parts,
                 judge::Capture& out) {
  const raster::LightRecord& record = drawn.result.raster.lights[0];
  LightView view = record.map.view;
  const bool parallel = view.projection == LightProjection::orthographic;
  const judge::StoredDepth convention =
      parts.stored.value_or(parallel ? judge::StoredDepth::zero_to_one : judge::StoredDepth::distance);
  view.reversed = convention == judge::StoredDepth::reversed;
  for (int face = 0; face < view.face_count; ++face) {
    judge::CapturedLayer& layer = out.map.emplace_back();
    layer.depth = folder + "/map" + std::to_string(face) + ".exr";
    layer.convention = convention;
    layer.rows = parts.rows;
    layer.clip_from_world = layer_matrix(view, face, convention);
    write(layer.depth, {view.size, view.size}, {{"Z", layer_texels(record.map, face, view, layer)}});
  }
  // One difference of stored numbers is one distance of a sun's map, and of distances; else only none is.
  const bool even = parallel || judge::is_linear(convention);
  EXPECT_TRUE(even || record.bias_constant_world == 0.0);
  const double unit = parallel ? view.face(0).far_depth - view.face(0).near_depth : 1.0;
  out.bias = judge::CapturedBias{.constant_depth = record.bias_constant_world / unit,
                                 .slope = drawn.result.raster.options.map.bias.slope};
  out.filter = judge::CapturedFilter{};
}

/// Two pictures of a surface with colours of its own, whose ratio is the visibility.
void capture_ratio(const Compared& drawn, const std::vector<float>& visibility, const std::string& folder,
                   judge::Capture& out) {
  const raytrace::RayTracedFrame& frame = drawn.result.raytraced;
  const Light& light = drawn.scene->lights[frame.lights[0].light];
  std::vector<Channel> lit{{"R", {}}, {"G", {}}, {"B", {}}}, dark = lit;
  for (std::size_t i = 0; i < visibility.size(); ++i) {
    const raytrace::SurfacePoint& point = frame.receiver.data[i];
    const bool reached = point.primitive != no_id && !light_cannot_reach(light, point.position, point.normal);
    const double facing =
        reached ? 0.05 + glm::dot(point.normal, light_at(light, point.position).to_light) : 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto colour = static_cast<float>(facing * (0.2 + 0.1 * double((point.primitive + 2 * c) % 7)));
      lit[c].values.push_back(colour), dark[c].values.push_back(colour * visibility[i]);
    }
  }
  out.shadowed = folder + "/shadowed.exr", out.unshadowed = folder + "/unshadowed.exr";
  write(out.shadowed, out.size, dark), write(out.unshadowed, out.size, lit);
}

/// A number of the camera's depth buffer (docs/capture.md).
double buffer_value(const judge::CapturedDepth& depth, bool orthographic, double along_axis,
                    double along_ray) {
  const double n = depth.near.value_or(0.0), z = along_axis;
  if (orthographic && depth.near) {
    const double share = (z - n) / (*depth.far - n);
    return *depth.convention == judge::PixelDepth::reversed ? 1.0 - share : share;
  }
  switch (*depth.convention) {
    case judge::PixelDepth::view_z:
      return z;
    case judge::PixelDepth::distance:
      return along_ray;
    case judge::PixelDepth::zero_to_one:
      return (*depth.far / (*depth.far - n)) * (1.0 - n / z);
    case judge::PixelDepth::reversed:
      break;
  }
  return depth.far ? n / (*depth.far - n) * (*depth.far / z - 1.0) : n / z;
}

void capture_depth(const Compared& drawn, const judge::CapturedDepth& depth, const std::string& folder,
                   judge::Capture& out) {
  const View view = make_view(drawn.scene->camera, out.size);
  std::vector<Channel> channels{{"Z", {}}};
  for (const raytrace::SurfacePoint& point : drawn.result.raytraced.receiver.data) {
    const Vec3 off = point.position - view.eye;
    const bool hit = point.primitive != no_id;
    const double nothing = *depth.convention == judge::PixelDepth::zero_to_one ? 1.0 : 0.0;
    channels[0].values.push_back(
        static_cast<float>(hit ? buffer_value(depth, view.orthographic(), glm::dot(off, view.forward),
                                              view.distance(point.position))
                               : nothing));
  }
  out.depth = depth;
  out.depth->file = folder + "/depth.exr";
  write(out.depth->file, out.size, channels);
}

std::string quoted(const std::string& text) {
  return '"' + text + '"';
}

std::string map_json(const judge::Capture& c) {
  std::string out;
  for (const judge::CapturedLayer& layer : c.map) {
    out +=
        (out.empty() ? "" : ", ") + std::string("{\"depth\": ") + quoted(layer.depth) +
        ", \"convention\": " + quoted(std::string(judge::convention_of(*layer.convention).name)) +
        ", \"rows\": " + quoted(std::string(judge::row_order_names[static_cast<std::size_t>(*layer.rows)])) +
        ", \"clip_from_world\": [";
    for (int i = 0; i < 16; ++i)
      out += (i == 0 ? "" : ", ") + fmt::format("{}", (*layer.clip_from_world)[i / 4][i % 4]);
    out += "]}";
  }
  return out;
}

}  // namespace

std::string write_json(const judge::Capture& c, const std::string& folder) {
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
  scene->lights.resize(1);
  return draw_scene(std::move(*scene), size, map);
}

Compared draw_scene(Scene scene, ImageSize size, const raster::MapOptions& map) {
  compare::CompareOptions options = test_options(size, map.size);
  options.raster.map = map;
  options.perceptual = false;
  return run_comparison(std::move(scene), options);
}

raster::MapOptions hard_map(int size, raster::Technique technique) {
  raster::MapOptions map;
  map.technique = technique, map.size = size;
  map.bias = {.constant = 0.02, .unit = raster::BiasUnit::world};
  map.filter.receiver_plane = false;
  return map;
}

judge::Capture self_capture(const Compared& drawn, const std::string& folder, const CaptureParts& parts) {
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  judge::Capture out;
  out.renderer = "gnomon";
  out.scene = drawn.scene->path.empty() ? "made in code" : drawn.scene->path;
  out.light = drawn.scene->lights[drawn.light().light].name;
  out.size = drawn.result.raster.options.size;
  std::vector<Channel> shadow{channel_of("V", drawn.result.raster.lights[0].visibility)};
  // What faces away from the light is dark, whatever the map says.
  for (std::size_t i = 0; i < shadow[0].values.size(); ++i)
    if (drawn.light().labels.data[i] == compare::Label::facing_away) shadow[0].values[i] = 0.0f;
  const std::vector<Channel> positions = position_channels(drawn.result.raytraced);
  if (parts.mask) shadow.push_back(positions[3]);
  if (parts.ratio) {
    capture_ratio(drawn, shadow[0].values, folder, out);
  } else {
    out.visibility = folder + "/visibility.exr";
    write(out.visibility, out.size, shadow);
  }
  if (parts.depth != nullptr) capture_depth(drawn, *parts.depth, folder, out);
  if (parts.positions) {
    out.position = folder + "/position.exr";
    write(out.position, out.size, positions);
  }
  if (parts.map) capture_map(drawn, folder, parts, out);
  return out;
}

void spoil(const std::string& file, const Spoil& change) {
  auto image = read_channels(file);
  ASSERT_TRUE(image);
  change(*image);
  write(file, image->size, image->channels);
}

JudgeOutcome judge(const judge::Capture& capture, const judge::JudgeOptions& options) {
  const auto scene = load_scene(capture.scene);
  return scene ? judge(capture, *scene, options) : JudgeOutcome{};
}

JudgeOutcome judge(const judge::Capture& capture, const Scene& scene, const judge::JudgeOptions& options) {
  JudgeOutcome out;
  out.scene = std::make_unique<Scene>(scene);
  out.world = std::make_unique<World>(make_world(*out.scene));
  out.result = judge::judge_capture(capture, *out.scene, *out.world, options);
  return out;
}

std::string reason(const JudgeOutcome& outcome) {
  return outcome.result ? std::string("judged") : outcome.result.error().message();
}

}  // namespace gnomon::test
