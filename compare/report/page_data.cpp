// Numbers are exact (gap: the bits of the 32-bit float that the shader tested; labels; ids) or rounded to a
// step that is written beside them: map positions to 1/256 texel downwards, so that the texel stays the same,
// visibilities to 1/25200 (exact for filters of up to 7 x 7 samples), distances and depths to a power of two
// of about 2^-22 of the map's depth range, normals to 1/32767, colours to 16-bit floats.
#include "compare/report/page_data.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>

#include <bit>
#include <cmath>
#include <functional>
#include <glm/gtc/packing.hpp>
#include <nlohmann/json.hpp>

#include "compare/option_names.h"
#include "compare/output_parts.h"
#include "compare/outputs.h"
#include "compare/report/explanations.h"
#include "compare/report/html.h"
#include "compare/report/packing.h"
#include "compare/report/section_mesh.h"
#include "compare/report/sections.h"
#include "compare/sweep/engine.h"

namespace gnomon::compare {
namespace {

using Json = nlohmann::ordered_json;

constexpr double position_steps = 256.0, visibility_steps = 25200.0, normal_steps = 32767.0;
constexpr std::size_t most_map_texels = std::size_t{1} << 21;  // larger maps are reduced

std::uint32_t integer(double value) {
  constexpr double limit = 2147483647.0;
  return std::isnan(value)
             ? 0u
             : static_cast<std::uint32_t>(static_cast<std::int32_t>(std::clamp(value, -limit, limit)));
}

/// integer(std::round(value)): what is added is the largest number below one half, so that nothing else is
/// rounded up with the halves. std::round is a call for each of some forty million numbers.
std::uint32_t rounded(double value) {
  constexpr double almost_half = 0.49999999999999994;
  return integer(value + std::copysign(almost_half, value));
}

Json vector3(const Vec3& v) {
  return Json::array({v.x, v.y, v.z});
}

// --- words ---

Json labels_json() {
  Json list = Json::array();
  for (int k = static_cast<int>(Label::uncertain); k <= static_cast<int>(class_count); ++k) {
    const auto label = static_cast<Label>(k);
    const LabelText& text = label_text(label);
    const glm::u8vec3 c = label_colour(label);
    list.push_back({{"value", k},
                    {"name", text.name},
                    {"what", text.what},
                    {"cause", text.cause},
                    {"cure", text.cure},
                    {"colour", hex_colour(c.r, c.g, c.b)}});
  }
  return list;
}

Json rungs_json() {
  Json list = Json::array();
  for (std::size_t k = 0; k < rung_count; ++k) {
    const RungText& rung = rung_text(static_cast<Rung>(k));
    Json json{{"name", rung.name}, {"what", rung.what}};
    if (k > 0) json["step"] = step_text(static_cast<Cause>(k - 1)).name;
    list.push_back(std::move(json));
  }
  return list;
}

// --- one light's numbers ---

// All arrays of a page, packed side by side on all cores. Until then their text is empty in the JSON, where
// nothing else is called "data".
class Packer {
 public:
  using Numbers = std::function<std::vector<std::uint32_t>()>;

  /// What is said of an array beside its text. `numbers`, and what it refers to, must last until run().
  Json add(PackOptions options, Numbers numbers) {
    jobs_.push_back({options, std::move(numbers), {}});
    return {{"bytes", options.bytes}, {"difference", options.difference}, {"data", ""}};
  }
  std::size_t count() const { return jobs_.size(); }

  void run() {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, jobs_.size(), 1),
        [&](const auto& range) {
          for (std::size_t i = range.begin(); i != range.end(); ++i)
            jobs_[i].text = packed(jobs_[i].numbers(), jobs_[i].options);
        },
        tbb::simple_partitioner());
  }

  /// The JSON with the texts of its arrays, the first of them that of job `first`.
  std::string filled(const Json& json, std::size_t first) const {
    constexpr std::string_view empty = "\"data\":\"\"";
    const std::string bare = json.dump();
    std::size_t size = bare.size(), copied = 0;
    for (std::size_t i = first; i < jobs_.size(); ++i) size += jobs_[i].text.size();
    std::string text;
    text.reserve(size);
    for (std::size_t at = bare.find(empty); at != std::string::npos; at = bare.find(empty, copied)) {
      const std::size_t place = at + empty.size() - 1;
      text.append(bare, copied, place - copied).append(jobs_[first++].text);
      copied = place;
    }
    return text.append(bare, copied);
  }

 private:
  struct Job {
    PackOptions options;
    Numbers numbers;
    std::string text;
  };
  std::vector<Job> jobs_;
};

// Some of them, by name.
class Channels {
 public:
  explicit Channels(Packer& packer) : packer_(packer) {}

  template <class Value>
  void add(const std::string& name, std::size_t count, PackOptions options, const Value& value) {
    json_[name] = packer_.add(options, [count, value] {
      std::vector<std::uint32_t> numbers(count);
      for (std::size_t i = 0; i < count; ++i) numbers[i] = value(i);
      return numbers;
    });
  }
  /// The numbers of a channel that is there.
  void add_same(const std::string& name, const std::string& as) { json_[name] = {{"same", as}}; }
  const Json& json() const { return json_; }

 private:
  Packer& packer_;
  Json json_ = Json::object();
};

double depth_step(const LightView& view) {
  const Interval range = view.depth_range();
  return std::exp2(std::ceil(std::log2(range.max - range.min)) - 22.0);
}

void add_ladder(Channels& channels, const LightComparison& light) {
  const std::size_t n = light.labels.data.size();
  channels.add("label", n, {1, false},
               [&light](std::size_t i) { return static_cast<std::uint32_t>(light.labels.data[i]); });
  for (std::size_t k = 0; k < rung_count; ++k) {
    const std::string name = fmt::format("V{}", k);
    if (k > 0 && light.rungs[k].data == light.rungs[k - 1].data) {
      channels.add_same(name, fmt::format("V{}", k - 1));
      continue;
    }
    channels.add(name, n, {2, false}, [&light, k](std::size_t i) {
      return rounded(visibility_steps * double{light.rungs[k].data[i]});
    });
  }
}

void add_lookup(Channels& channels, const Comparison& c, const LightComparison& light) {
  const raster::LightRecord& record = drawn_record(c, light);
  const std::size_t n = light.labels.data.size();
  const double step = depth_step(record.map.view);
  channels.add("u", n, {4, true}, [&record](std::size_t i) {
    return integer(std::floor(position_steps * double{record.texel_uv.data[i].x}));
  });
  channels.add("v", n, {4, true}, [&record](std::size_t i) {
    return integer(std::floor(position_steps * double{record.texel_uv.data[i].y}));
  });
  channels.add("face", n, {1, false},
               [&record](std::size_t i) { return std::uint32_t{record.face.data[i]}; });
  channels.add("distance", n, {4, true},
               [&record, step](std::size_t i) { return rounded(double{record.distance.data[i]} / step); });
  channels.add("gap", n, {4, false},
               [&record](std::size_t i) { return std::bit_cast<std::uint32_t>(record.gap.data[i]); });
}

// Linear light as 16-bit floats, before exposure.
void add_picture(Channels& channels, const ColorImage& image, std::string_view prefix) {
  const bool grey = std::all_of(image.data.begin(), image.data.end(),
                                [](const Vec3f& c) { return c.x == c.y && c.y == c.z; });
  for (int k = 0; k < 3; ++k) {
    const std::string name = fmt::format("{}{}", prefix, "RGB"[k]);
    if (grey && k > 0)
      channels.add_same(name, fmt::format("{}R", prefix));
    else
      channels.add(name, image.data.size(), {2, true},
                   [&image, k](std::size_t i) { return std::uint32_t{glm::packHalf1x16(image.data[i][k])}; });
  }
}

// The metrics' maps: FLIP in steps of 1/255, SSIM in steps of 1/127 with -128 where no window fits.
void add_metrics(Channels& channels, const LightComparison& light) {
  const std::size_t n = light.flip_map.data.size();
  if (n == 0) return;
  channels.add("flip", n, {1, false},
               [&light](std::size_t i) { return rounded(255.0 * double{light.flip_map.data[i]}); });
  channels.add("ssim", n, {1, false}, [&light](std::size_t i) {
    const double value = light.ssim_map.data[i];
    return std::isnan(value) ? integer(-128.0) : rounded(127.0 * value);
  });
}

void add_decisions(Channels& channels, const raster::LightRecord& record) {
  if (!record.external || record.external->decision.data.empty()) return;
  const auto& decision = record.external->decision.data;
  channels.add("decision", decision.size(), {1, false},
               [&decision](std::size_t i) { return std::uint32_t{decision[i]}; });
}

void add_receiver(Channels& channels, const Comparison& c) {
  const auto& points = c.raytraced.receiver.data;
  channels.add("primitive", points.size(), {4, true},
               [&points](std::size_t i) { return points[i].primitive; });
  for (int k = 0; k < 3; ++k)
    channels.add(fmt::format("n{}", "xyz"[k]), points.size(), {2, true}, [&points, k](std::size_t i) {
      return points[i].primitive == no_id ? 0u : rounded(normal_steps * points[i].normal[k]);
    });
}

Json view_json(const LightView& view) {
  Json faces = Json::array();
  for (int i = 0; i < view.face_count; ++i) {
    const LightFace& face = view.faces[static_cast<std::size_t>(i)];
    faces.push_back({{"right", vector3(face.right)},
                     {"up", vector3(face.up)},
                     {"forward", vector3(face.forward)},
                     {"center", Json::array({face.center.x, face.center.y})},
                     {"half_extent", Json::array({face.half_extent.x, face.half_extent.y})},
                     {"warp", face.warp}});
  }
  return {{"perspective", view.projection == LightProjection::perspective},
          {"size", view.size},
          {"faces", std::move(faces)},
          {"origin", vector3(view.origin)},

          {"near", view.depth_range().min},
          {"far", view.depth_range().max}};
}

// Depths in world units, in steps; -1 where nothing is stored. A reduced map keeps the nearest depth of each
// block.
Json map_json(const raster::ShadowMap& map, Packer& packer) {
  int step = 1;
  const auto texels = [&map](int s) {
    const auto side = static_cast<std::size_t>((map.view.size + s - 1) / s);
    return static_cast<std::size_t>(map.view.face_count) * side * side;
  };
  while (texels(step) > most_map_texels) ++step;
  Json json{{"step", step}};
  json.update(packer.add({4, true}, [&map, step] {
    const raster::ShadowMap small = step == 1 ? raster::ShadowMap{} : reduced_map(map, step);
    const std::vector<float>& depth = step == 1 ? map.depth : small.depth;
    const LightView& view = step == 1 ? map.view : small.view;
    const double unit = depth_step(view), near_depth = view.depth_range().min;
    const auto side = static_cast<std::size_t>(view.size);
    std::vector<std::uint32_t> numbers(depth.size());
    tbb::parallel_for(std::size_t{0}, depth.size(), [&](std::size_t i) {
      const double stored = depth[i];
      const auto face = static_cast<int>(i / (side * side));
      const double v = static_cast<double>(i / side % side) + 0.5;
      numbers[i] = holds_caster(view, stored)
                       ? rounded((depth_from_stored(view, face, v, stored) - near_depth) / unit)
                       : 0xffffffffu;
    });
    return numbers;
  }));
  return json;
}

Json light_data(const PageInput& in, std::size_t index, Packer& packer) {
  const Comparison& c = in.comparison;
  const LightComparison& light = c.lights[index];
  const raster::LightRecord& record = drawn_record(c, light);
  const raster::Bias& bias = c.raster.options.map.bias;
  Channels channels(packer);
  add_ladder(channels, light);
  add_lookup(channels, c, light);
  add_metrics(channels, light);
  add_decisions(channels, record);
  const raster::MapOptions& map = c.raster.options.map;
  return {{"name", shown_light_name(c, index)},
          {"view", view_json(record.map.view)},
          {"technique", technique_name(map.technique)},
          {"gaps_decide", biases_follow_from_gaps(c.raster)},
          {"compares_depths", compares_depths(map.technique)},
          {"bias",
           {{"constant", draws_bias(c) ? record.bias_constant_world : 0.0},
            {"slope", bias.slope},
            {"normal_offset", bias.normal_offset_texels},
            {"receiver_plane", bias.receiver_plane}}},
          {"texel_world", light.texel_world[1]},
          {"depth_step", depth_step(record.map.view)},
          {"channels", channels.json()},
          {"map", map_json(record.map, packer)}};
}

// What all lights share: what is seen at each pixel, and both pictures.
Json pixels_json(const Comparison& c, Packer& packer) {
  Channels channels(packer);
  add_receiver(channels, c);
  add_picture(channels, c.raster.color, "raster");
  add_picture(channels, c.raytraced.color, "raytraced");
  return channels.json();
}

// --- geometry ---

Json triangles_json(const SectionMesh& mesh, const Aabb& bounds, Packer& packer) {
  const Vec3 low = bounds.min, extent = bounds.max - low;
  const double step =
      std::exp2(std::ceil(std::log2(std::max({extent.x, extent.y, extent.z, 1e-300}))) - 24.0);
  Channels channels(packer);
  for (int k = 0; k < 3; ++k)
    channels.add(
        fmt::format("{}", "xyz"[k]), mesh.positions.size(), {4, true},
        [&mesh, low, step, k](std::size_t i) { return rounded((mesh.positions[i][k] - low[k]) / step); });
  channels.add("corner", 3 * mesh.triangles.size(), {4, true},
               [&mesh](std::size_t i) { return mesh.triangles[i / 3][i % 3]; });
  return {{"low", vector3(low)}, {"step", step}, {"channels", channels.json()}};
}

Json geometry_json(const World& world, const SectionMesh& mesh, Packer& packer) {
  Json shapes = Json::array();
  for (const Shape& shape : world.shapes) {
    if (const auto* sphere = std::get_if<Sphere>(&shape.geometry))
      shapes.push_back(
          {{"name", shape.name}, {"center", vector3(sphere->center)}, {"radius", sphere->radius}});
    else if (const auto* plane = std::get_if<Plane>(&shape.geometry))
      shapes.push_back(
          {{"name", shape.name}, {"point", vector3(plane->point)}, {"normal", vector3(plane->normal)}});
  }
  Json json{
      {"shapes", std::move(shapes)}, {"solid_sectors", mesh.solid_sectors}, {"complete", mesh.complete}};
  if (!mesh.triangles.empty()) json["triangles"] = triangles_json(mesh, world.finite_bounds, packer);
  return json;
}

}  // namespace

std::string label_words() {
  return labels_json().dump();
}

PageData page_data(const PageInput& in) {
  const Comparison& c = in.comparison;
  PageData out;
  Json head{{"kind", "compare"},
            {"labels", labels_json()},
            {"rungs", rungs_json()},
            {"width", c.raytraced.receiver.size.width},
            {"height", c.raytraced.receiver.size.height},
            {"position_steps", position_steps},
            {"visibility_steps", visibility_steps},
            {"exposure", c.exposure},
            {"lights", c.lights.size()}};
  out.head = head.dump();
  if (c.lights.empty()) return out;
  struct Part {
    std::string name;
    Json json;
    std::size_t first;  // job of its arrays
  };
  Packer packer;
  std::vector<Part> parts;
  const auto add = [&](std::string name, const auto& make) {
    const std::size_t first = packer.count();
    parts.push_back({std::move(name), make(), first});
  };
  const SectionMesh mesh = section_mesh(*c.world);
  add("pixels", [&] { return pixels_json(c, packer); });
  add("geometry", [&] { return geometry_json(*c.world, mesh, packer); });
  for (std::size_t i = 0; i < c.lights.size(); ++i)
    add(fmt::format("light-{}", i), [&] { return light_data(in, i, packer); });
  packer.run();
  for (const Part& part : parts) out.parts.push_back({part.name, packer.filled(part.json, part.first)});
  return out;
}

}  // namespace gnomon::compare
