#include "judge/captured_frame.h"

#include <algorithm>

#include "compare/ladder/biased_test.h"
#include "compare/truth/texel_groups.h"
#include "judge/outside_map.h"
#include "judge/stored_depths.h"
#include "scene/base/parallel.h"
#include "scene/base/stages.h"

namespace gnomon::judge {
namespace {

using raytrace::SurfacePoint;

raster::MapOptions map_options(const Capture& capture, int size) {
  raster::MapOptions map;
  const CapturedFilter filter = capture.filter.value_or(CapturedFilter{});
  map.technique = technique_of(filter.kind);
  map.size = size;
  map.bias = {.constant = 0.0, .unit = raster::BiasUnit::world};
  if (capture.bias) map.bias.slope = capture.bias->slope;
  map.filter.radius_texels = filter.radius_texels;
  map.filter.search_radius = filter.radius_texels * 1024.0 / size;
  map.filter.blur_radius_texels = static_cast<int>(std::ceil(filter.radius_texels - 0.5));
  map.filter.receiver_plane = map.filter.mipmaps = false;
  map.filter.light_bleeding_reduction = 0.0;
  return map;
}

using raster::UnitAt;

/// World units of distance that 1 of a stored depth counts for: at the nearest, the middle and the farthest receiver.
std::array<UnitAt, 3> units_of_depth(const raster::ShadowMap& map, const raytrace::RayTracedFrame& traced) {
  const LightView& view = map.view;
  const double n = view.face(0).near_depth, f = view.face(0).far_depth;
  std::array<UnitAt, 3> out;
  if (view.projection == LightProjection::orthographic) {
    out.fill({n, f - n});
    return out;
  }
  std::vector<double> depths;
  double nearest = infinity, farthest = n;
  for (std::size_t i = 0; i < traced.receiver.data.size(); i += 61) {
    if (traced.receiver.data[i].primitive == no_id) continue;
    const TexelCoordinate at = project_to_texel(view, traced.receiver.data[i].position);
    depths.push_back(std::max(at.depth, n));
    if (!at.inside || at.depth > f) continue;
    nearest = std::min(nearest, depths.back()), farthest = std::max(farthest, depths.back());
  }
  if (depths.empty()) return out;
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  const std::array<double, 3> at{std::min(nearest, farthest), *middle, farthest};
  for (std::size_t i = 0; i < at.size(); ++i) out[i] = {at[i], at[i] * at[i] * (f - n) / (n * f)};
  return out;
}

/// Returns what floats leave open where the picture's receivers stand: a triangle that reaches absurdly far, and is not seen,
/// tells nothing of them.
raster::BiasRounding rounding_of(const LightView& view, const FrameInput& in) {
  // As of Gnomon's own shaders (raster::bias_rounding), but positions are floats in the world's own frame.
  double farthest = 0.0;
  for (const SurfacePoint& point : in.traced.receiver.data)
    if (point.primitive != no_id) farthest = std::max(farthest, glm::length(point.position));
  const double reach = glm::length(view.origin) + farthest;
  const Aabb& box = in.world.finite_bounds;
  return {.float_world = 8.0 * std::exp2(-24.0) * reach,
          .stored_step = std::exp2(-24),
          .adaptive_epsilon_world = raster::adaptive_epsilon * (box.empty() ? reach : box.diagonal())};
}

/// What the picture shows: the receiver's primitive, or another number where it shows something else.
Image<std::uint32_t> shown_primitives(const FrameInput& in) {
  Image<std::uint32_t> shown(in.capture.size, no_id);
  const bool masked = !in.pictures.drawn.data.empty();
  parallel_for(shown.data.size(), [&](std::size_t i) {
    const std::uint32_t primitive = in.traced.receiver.data[i].primitive;
    const bool drawn = !masked || in.pictures.drawn.data[i] != 0;
    if (primitive == no_id)
      shown.data[i] = masked && drawn ? 0 : no_id;
    else if (drawn && in.elsewhere.data[i] == 0 && in.pictures.reached.data[i] != 0)
      shown.data[i] = primitive;
  });
  // Facing away is known without a picture: such pixels keep their surface.
  const Light& light = in.world.scene->lights[in.traced.lights.front().light];
  parallel_for(shown.data.size(), [&](std::size_t i) {
    const SurfacePoint& point = in.traced.receiver.data[i];
    const bool unlit = point.primitive != no_id && in.pictures.reached.data[i] == 0;
    if (unlit && light_cannot_reach(light, point.position, point.normal)) shown.data[i] = point.primitive;
  });
  return shown;
}

/// The capture's picture as bright as Gnomon's on the page.
ColorImage shown_colour(const FrameInput& in) {
  ColorImage out = in.pictures.color;
  double scale = 1.0 / in.exposure;
  if (in.pictures.ratio) {
    std::vector<float> values;
    for (std::size_t i = 0; i < out.data.size(); i += 7)
      values.push_back(std::max({out.data[i].x, out.data[i].y, out.data[i].z}));
    const auto high = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 99 / 100);
    std::nth_element(values.begin(), high, values.end());
    if (*high > 0.0f) scale /= double{*high};
  }
  for (Vec3f& c : out.data) c *= static_cast<float>(scale);
  return out;
}

/// A quarter of the texels with the depth of a later surface than the first: the renderer left the first ones out.
constexpr double culled_share = 0.25;

/// Whether back faces are stored in the place of the front faces before them, which it takes to explain the depths.
bool is_culled(const FrameInput& in, const raster::LightRecord& record) {
  const StoredDepths depths(in, record);
  std::size_t seen = 0, later = 0;
  const std::size_t step = std::max<std::size_t>(1, in.traced.receiver.data.size() / 4096);
  for (std::size_t i = 0; i < in.traced.receiver.data.size(); i += step) {
    raytrace::TexelKey key;
    if (in.traced.receiver.data[i].primitive == no_id || !compare::texel_of_pixel(record, i, key)) continue;
    if (depths.is_empty(key)) continue;
    const std::vector<SurfaceOnRay> met = depths.all(key, 8);
    const auto back = std::find_if(met.begin(), met.end(), [](const SurfaceOnRay& s) { return !s.front; });
    ++seen;
    if (back == met.end() || back == met.begin()) continue;
    later += depths.is_stored(key, back->depth, 0.5 * back->across) &&
                     !depths.is_stored(key, met.front().depth, 0.5 * met.front().across)
                 ? 1
                 : 0;
  }
  return seen > 0 && static_cast<double>(later) > culled_share * static_cast<double>(seen);
}

/// Makes a map for a picture without one: a place to measure pixels by, with nothing stored in it.
Expected<raster::ShadowMap> empty_map(const FrameInput& in, const Light& light) {
  constexpr int texels = 64;
  raster::ShadowMap map;
  const double aspect = static_cast<double>(in.capture.size.width) / in.capture.size.height;
  auto view = fit_light_view(in.world, light, in.camera, aspect, texels);
  if (!view) return fail(view.error());
  map.view = *view;
  const auto count = static_cast<std::size_t>(view->face_count) * texels * texels;
  map.depth.assign(count, 1.0f);
  return map;
}

/// The layer of which most is drawn: where one gives way to the next that is the next from the middle on.
std::uint8_t selected_face(const View& view, const std::vector<CapturedSelect>& select, const Vec3& place) {
  using Test = CapturedTest;
  if (select.empty()) return Test::any_face;
  for (std::size_t k = 0; k < select.size(); ++k) {
    const double distance = from_camera(view, select[k].by_distance, place);
    if (!(distance >= select[k].near && distance < select[k].far)) continue;
    const bool gives_way = select[k].blend > 0.0 && distance >= select[k].far - 0.5 * select[k].blend;
    return static_cast<std::uint8_t>(gives_way ? k + 1 : k);
  }
  return Test::no_face;
}

/// Gives a test the capture's bias and numbers.
void fill_test(const FrameInput& in, const CapturedMap& map, CapturedTest& test) {
  test.stores = convention_of(map.stored).stores, test.unit_world = map.unit_world;
  test.range = in.capture.map.front().range.value_or(Vec2(0.0, 1.0));
  const CapturedBias& first = map.bias.front();
  test.normal_offset_world = first.normal_offset_world;
  test.normal_offset_angle = first.normal_offset_angle, test.constant_angle = first.angle;
  test.least = first.min, test.most = first.max;
  for (const CapturedBias& bias : map.bias)
    test.layers.push_back(
        {bias.constant_depth - first.constant_depth, bias.normal_offset_world - first.normal_offset_world});
  const auto alike = [](const CapturedTest::LayerBias& b) {
    return b.constant == 0.0 && b.normal_offset_world == 0.0;
  };
  if (std::all_of(test.layers.begin(), test.layers.end(), alike)) test.layers.clear();
  test.faces = looked_up_faces(in, map.select, in.capture.fade);
}

void fill_light(const FrameInput& in, const CapturedMap* captured, raster::RasterFrame& frame,
                raster::LightRecord& record) {
  raster::MapOptions& map = frame.options.map;
  raster::ForeignPicture& picture = record.foreign.emplace();
  if (in.capture.filter) picture.said = {"filter-radius", "search-radius", "blur-radius"};
  record.texel_world = raster::texel_world(record.map.view, in.world);
  record.rounding = rounding_of(record.map.view, in);
  record.rounding_world = raster::rounding_world(record.rounding, record.map.view, in.world);
  if (captured == nullptr) return fill_record(in, map.bias, record);
  CapturedTest& test = *captured->test;
  picture.test = captured->test;
  fill_test(in, *captured, test);
  picture.units.fill({0.0, test.unit_world});
  if (test.stores == Stores::depths) {
    const std::array<UnitAt, 3> units = units_of_depth(record.map, in.traced);
    picture.units = {units.front(), units.back()}, test.unit_world = units[1].world;
  }
  picture.unit_world = test.unit_world;
  test.describe(map, picture);
  const CapturedBias& bias = captured->bias.front();
  record.bias_constant_world = map.bias.constant = bias.constant_depth * test.unit_world;
  map.bias.slope = bias.slope;
  fill_record(in, map.bias, record);
}

}  // namespace

double from_camera(const View& view, bool by_distance, const Vec3& place) {
  return by_distance ? glm::length(place - view.eye) : glm::dot(place - view.eye, view.forward);
}

std::vector<CapturedSelect> captured_selects(const Capture& capture) {
  std::vector<CapturedSelect> out;
  for (const CapturedLayer& layer : capture.map)
    if (layer.select) out.push_back(*layer.select);
  return out;
}

Image<std::uint8_t> looked_up_faces(const FrameInput& in, const std::vector<CapturedSelect>& select,
                                    const std::optional<CapturedFade>& fade) {
  if (select.empty() && !fade) return {};
  Image<std::uint8_t> faces(in.capture.size, CapturedTest::no_face);
  const View view = make_view(in.camera, in.capture.size);
  parallel_for(faces.data.size(), [&](std::size_t i) {
    const SurfacePoint& point = in.traced.receiver.data[i];
    if (point.primitive == no_id) return;
    const bool faded =
        fade && from_camera(view, fade->by_distance, point.position) > 0.5 * (fade->from + fade->to);
    if (!faded) faces.data[i] = selected_face(view, select, point.position);
  });
  return faces;
}

void fill_record(const FrameInput& in, const raster::Bias& bias, raster::LightRecord& record) {
  const ImageSize size = in.capture.size;
  record.texel_uv = Image<Vec2f>(size, Vec2f(0.0f));
  const CapturedTest* test = !record.has_known_map() ? nullptr : &captured_test(record);
  using Test = CapturedTest;
  record.face = Image<std::uint8_t>(size, 0);
  record.distance = record.gap = Image<float>(size, 0.0f);
  record.outside_map = Image<std::uint8_t>(size, 0);
  const Light& light = in.world.scene->lights[record.light];
  parallel_for(size.pixels(), [&](std::size_t i) {
    const SurfacePoint& point = in.traced.receiver.data[i];
    if (point.primitive == no_id) return;
    const std::uint8_t face = test != nullptr ? test->face_of(i) : Test::any_face;
    const bool beside = face == Test::no_face;
    const TexelCoordinate at = beside || face == Test::any_face
                                   ? project_to_texel(record.map.view, point.position)
                                   : project_to_face(record.map.view, face, point.position);
    const bool held = test == nullptr || !at.inside || test->holds(at.face, at.column(), at.row());
    // Else it is lit, whatever a map holds.
    const bool looks_up = in.tracer.receives_shadow(point) && held && !beside;
    record.texel_uv.data[i] = looks_up ? Vec2f(at.u, at.v) : Vec2f(-1.0f);
    record.face.data[i] = static_cast<std::uint8_t>(at.face);
    record.distance.data[i] = static_cast<float>(at.distance);
    record.outside_map.data[i] = at.inside && looks_up ? 0 : 1;
    if (!record.has_known_map()) return;
    if (looks_up && lies_beyond_depths(record, bias, light, point, i))
      record.texel_uv.data[i] = Vec2f(-1.0f), record.outside_map.data[i] = 1;
    record.gap.data[i] = static_cast<float>(
        compare::biased_gap(record, bias, light_at(light, point.position).to_light, point, i));
  });
}

void find_culling(const FrameInput& in, raster::RasterFrame& frame) {
  if (is_culled(in, frame.lights.front())) frame.options.map.cull = raster::Cull::front;
}

Expected<raster::RasterFrame> make_frame(const FrameInput& in, std::optional<CapturedMap> map) {
  const TimedStage stage("capture's map");
  const Light& light = in.world.scene->lights[in.traced.lights.front().light];
  raster::RasterFrame frame;
  frame.context = {"capture", in.capture.version, in.capture.renderer, 0};
  frame.color = shown_colour(in);
  frame.primitive = shown_primitives(in);
  raster::LightRecord& record = frame.lights.emplace_back();
  record.light = in.traced.lights.front().light;
  record.visibility = in.pictures.visibility;
  if (map) {
    record.map = std::move(map->map);
  } else {
    auto empty = empty_map(in, light);
    if (!empty) return fail(empty.error());
    record.map = std::move(*empty);
  }
  frame.options.size = in.capture.size;
  frame.options.map = map_options(in.capture, record.map.view.size);
  frame.options.map.depth_format = record.map.format;
  frame.map_texels = map ? record.map.depth.size() : 0;
  frame.map_bytes = frame.map_texels * sizeof(float);
  fill_light(in, map ? &*map : nullptr, frame, record);
  return frame;
}

}  // namespace gnomon::judge
