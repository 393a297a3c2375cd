#include "judge/directions_test.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "compare/ladder/biased_test.h"
#include "judge/capture_pictures.h"
#include "judge/test_suspects.h"

namespace gnomon::judge {
namespace {

constexpr double rigid_slack = 1e-4;  ///< floats, some of them sums of a few
/// Of the nearest and farthest distance, what the cube's near and far plane leave beside them; its corners lie sqrt(3) times as
/// far as its planes.
constexpr double beside = 2.0;

DirectionPlace place_of(const DirectionsTest& test, const raster::LightRecord& record,
                        const raster::MapLookup& lookup) {
  return test.place(glm::normalize(lookup.position - record.map.view.origin));
}

/// The layer's distances, world units, rows from its bottom.
Expected<DistanceLayer> read_distances(const Capture& capture, std::size_t i) {
  const CapturedLayer& layer = capture.map[i];
  ImageSize picture;
  const auto channel = read_layer_numbers(capture, i, picture);
  if (!channel) return fail(channel.error());
  const CapturedRect rect = layer.rect.value_or(CapturedRect{0, 0, picture.width, picture.height});
  DistanceLayer out{rect.width, rect.height};
  std::size_t bad = 0;
  for (int v = 0; v < rect.height; ++v)
    for (int u = 0; u < rect.width; ++u) {
      const int y = rect.y + (*layer.rows == RowOrder::top_down ? rect.height - 1 - v : v);
      const float value =
          channel->values[static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                          static_cast<std::size_t>(rect.x + u)];
      bad += std::isnan(value) ? 1 : 0;
      const double world = linear_world(layer.range, double{value});
      out.distances.push_back(std::isfinite(world) ? static_cast<float>(world) : 0.0f);
    }
  if (bad > 0)
    return capture_error(capture, fmt::format("map[{}].depth", i),
                         fmt::format("{} texels are not numbers", bad));
  return out;
}

/// A cube around the light, whose depths hold all distances.
LightView cube_around(const Vec3& origin, const DirectionsTest& test, double share) {
  Interval distances{infinity, 0.0};
  double texels = 0.0;
  for (const DistanceLayer& layer : test.pictures) {
    texels += share * layer.width * layer.height;
    for (const float d : layer.distances)
      if (d > 0.0f) distances = {std::min(distances.min, double{d}), std::max(distances.max, double{d})};
  }
  if (!(distances.max > 0.0)) distances = {1.0, 1.0};  // nothing is stored
  LightView view;
  view.projection = LightProjection::perspective;
  view.size = std::max(1, static_cast<int>(std::lround(std::sqrt(texels / 6.0))));
  view.face_count = 6, view.origin = origin, view.seamless = view.reversed = true;
  std::ranges::copy(cube_faces(), view.faces.begin());
  view.set_extent(Vec2(1.0), distances.min / (beside * std::sqrt(3.0)), beside * distances.max);
  return view;
}

/// Each texel has the number of the layer's texel in which its middle lies, as a depth on the ray through that one's middle.
void fill_cube(const DirectionsTest& test, raster::ShadowMap& map) {
  const LightView& view = map.view;
  const int n = view.size;
  map.depth.assign(static_cast<std::size_t>(6 * n) * static_cast<std::size_t>(n), 0.0f);
  for (int face = 0; face < 6; ++face)
    for (int row = 0; row < n; ++row)
      for (int column = 0; column < n; ++column) {
        const Vec3 ray = texel_ray(view, face, column + 0.5, row + 0.5).direction;
        const DirectionPlace place = test.texel_centre(test.place(ray));
        const auto distance = test.distance(place);
        if (!distance) continue;
        const double along = glm::dot(test.direction(place), view.face(face).forward);
        map.depth[map.texel_index(face, column, row)] =
            static_cast<float>(stored_from_depth(view, face, row + 0.5, *distance * along));
      }
}

void turn_rows_of(DistanceLayer& layer) {
  for (int row = 0; row < layer.height / 2; ++row) {
    const auto line = [&](int r) { return layer.distances.begin() + std::ptrdiff_t{r} * layer.width; };
    std::swap_ranges(line(row), line(row + 1), line(layer.height - 1 - row));
  }
}

}  // namespace

DirectionPlace DirectionsTest::texel_centre(DirectionPlace place) const {
  const DistanceLayer& layer = pictures[place.layer];
  place.u = std::clamp(std::floor(place.u), 0.0, layer.width - 1.0) + 0.5;
  place.v = std::clamp(std::floor(place.v), 0.0, layer.height - 1.0) + 0.5;
  return place;
}

std::optional<double> DirectionsTest::distance(const DirectionPlace& place) const {
  const DistanceLayer& layer = pictures[place.layer];
  const DirectionPlace at = texel_centre(place);
  const auto index =
      static_cast<std::size_t>(at.v) * static_cast<std::size_t>(layer.width) + static_cast<std::size_t>(at.u);
  const double distance = layer.distances[index];
  return distance > 0.0 ? std::optional(distance) : std::nullopt;
}

std::optional<double> DirectionsTest::caster(const raster::LightRecord& record,
                                             const raster::MapLookup& lookup) const {
  const auto stored = distance(place_of(*this, record, lookup));
  if (!stored) return std::nullopt;
  return compare::depth_of_distance(record.map.view, lookup.key, *stored);
}

Ray DirectionsTest::exact_ray(const raster::LightRecord& record, const raster::MapLookup& lookup) const {
  return {record.map.view.origin, direction(texel_centre(place_of(*this, record, lookup))), {0.0, infinity}};
}

std::vector<std::optional<double>> DirectionsTest::casters_within(const raster::LightRecord& record,
                                                                  const raster::MapLookup& lookup,
                                                                  double reach) const {
  const DirectionPlace middle = place_of(*this, record, lookup);
  std::vector<std::optional<double>> out;
  for (double v = std::floor(middle.v - reach); v <= middle.v + reach; v += 1.0)
    for (double u = std::floor(middle.u - reach); u <= middle.u + reach; u += 1.0) {
      const auto stored = distance({middle.layer, u, v});
      out.push_back(stored ? std::optional(compare::depth_of_distance(record.map.view, lookup.key, *stored))
                           : std::nullopt);
    }
  return out;
}

std::optional<Ray> DirectionsTest::stored_ray(const LightView& view, TexelKey key, const Vec2& off) const {
  DirectionPlace at =
      texel_centre(place(texel_ray(view, key.face(), key.column() + 0.5, key.row() + 0.5).direction));
  at.u += off.x, at.v += off.y;
  return Ray{view.origin, direction(at), {0.0, infinity}};
}

/// Other orders of rows and layers.
void DirectionsTest::add_suspects(std::vector<TestSuspect>& suspects) const {
  suspects.push_back({"`rows` of the map is the other one",
                      "the renderer reads its map upside down (v runs the other way)",
                      [](raster::LightRecord& record) {
                        for (DistanceLayer& layer : changed_test<DirectionsTest>(record).pictures)
                          turn_rows_of(layer);
                        return true;
                      }});
  if (pictures.size() != 2) return;
  suspects.push_back({"the pictures of map[0] and map[1] are exchanged", "", [](raster::LightRecord& record) {
                        auto& both = changed_test<DirectionsTest>(record).pictures;
                        const bool alike = both[0].width == both[1].width && both[0].height == both[1].height;
                        if (alike) std::swap(both[0].distances, both[1].distances);
                        return alike;
                      }});
}

Expected<LightTurn> read_turn(const Capture& capture, std::size_t i, const Light& light, const World& world,
                              std::string_view what) {
  const Mat4& m = *capture.map[i].clip_from_world;
  const auto wrong = [&](std::string reason) {
    return capture_error(capture, fmt::format("map[{}].clip_from_world", i), std::move(reason));
  };
  for (int k = 0; k < 16; ++k)
    if (!std::isfinite(m[k / 4][k % 4])) return wrong("has numbers that are not finite");
  const Mat3 turn(m);
  const double scale = glm::length(turn[0]);
  const Mat3 square = glm::transpose(turn) * turn;
  bool rigid = scale > 0.0 && m[0][3] == 0.0 && m[1][3] == 0.0 && m[2][3] == 0.0 && m[3][3] == 1.0;
  for (int k = 0; k < 9; ++k) {
    const double wanted = k % 4 == 0 ? scale * scale : 0.0;
    rigid = rigid && std::abs(square[k / 3][k % 3] - wanted) < rigid_slack * scale * scale;
  }
  if (!rigid) return wrong(fmt::format("is no turn and shift: {}", what));
  const LightTurn out{turn / scale, glm::inverse(turn) * -Vec3(m[3])};
  MatrixFace face;
  face.projection = LightProjection::perspective, face.origin = out.origin;
  if (const auto reason = not_of_light(face, capture.map.size(), light, world)) return wrong(*reason);
  return out;
}

Expected<void> check_directions(const Capture& capture, std::string_view what) {
  const auto wrong = [&](const std::string& field, const char* reason) {
    return capture_error(capture, field, fmt::format(fmt::runtime(reason), what));
  };
  if (capture.filter && capture.filter->read != FilterRead::nearest)
    return wrong("filter.read", "is nearest of {}, whose comparisons may be averaged (kind pcf)");
  if (capture.filter && capture.filter->kind > FilterName::pcf)
    return wrong("filter.kind", "is none or pcf of {}");
  if (capture.bias && capture.bias->slope != 0.0)
    return wrong("bias.slope",
                 "is not of {}, whose texels differ in size; constant_depth and normal_offset_world are");
  for (std::size_t i = 0; i < capture.map.size(); ++i)
    if (capture.map[i].select)
      return wrong(fmt::format("map[{}].select", i), "is not of {}: the way to the light chooses");
  return {};
}

Expected<CapturedMap> read_directions(const Capture& capture, const Vec3& origin,
                                      std::shared_ptr<DirectionsTest> test, double share) {
  CapturedMap out;
  out.stored = *capture.map.front().convention;
  if (const auto& range = capture.map.front().range) out.unit_world = std::abs(range->y - range->x);
  for (std::size_t i = 0; i < capture.map.size(); ++i) {
    auto layer = read_distances(capture, i);
    if (!layer) return fail(layer.error());
    test->pictures.push_back(std::move(*layer));
  }
  out.map.view = cube_around(origin, *test, share);
  out.map.format = raster::DepthFormat::d32f_reversed;
  fill_cube(*test, out.map);
  CapturedCasterBias casters = capture.map.front().caster_bias.value_or(CapturedCasterBias{});
  casters.constant_world += casters.constant * out.unit_world, casters.constant = 0.0;
  out.caster_bias.assign(6, casters);
  out.bias.assign(6, capture.bias.value_or(CapturedBias{}));
  out.test = std::move(test);
  return out;
}

}  // namespace gnomon::judge
