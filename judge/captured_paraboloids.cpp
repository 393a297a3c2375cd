#include "judge/captured_paraboloids.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "compare/ladder/paraboloids.h"
#include "judge/capture_pictures.h"

namespace gnomon::compare {
namespace {

using raster::CapturedParaboloid;

constexpr double rigid_slack = 1e-4;  ///< floats, some of them sums of a few
/// Of the nearest and farthest distance, what the cube's near and far plane leave beside them; its corners lie sqrt(3) times as
/// far as its planes.
constexpr double beside = 2.0;

/// A half's turn and where it looks from, or why the matrix is no such thing.
struct Half {
  Mat3 half_from_world{1.0};
  Vec3 origin{0.0};
};

tl::expected<Half, std::string> take_half_apart(const Mat4& m) {
  for (int i = 0; i < 16; ++i)
    if (!std::isfinite(m[i / 4][i % 4]))
      return tl::unexpected<std::string>("has numbers that are not finite");
  const Mat3 turn(m);
  const double scale = glm::length(turn[0]);
  const Mat3 square = glm::transpose(turn) * turn;
  bool rigid = scale > 0.0 && m[0][3] == 0.0 && m[1][3] == 0.0 && m[2][3] == 0.0 && m[3][3] == 1.0;
  for (int i = 0; i < 9; ++i) {
    const double wanted = i % 4 == 0 ? scale * scale : 0.0;
    rigid = rigid && std::abs(square[i / 3][i % 3] - wanted) < rigid_slack * scale * scale;
  }
  if (!rigid)
    return tl::unexpected<std::string>(
        "is no turn and shift: a half's matrix is the light's view without a projection, z along the half's "
        "axis");
  return Half{turn / scale, glm::inverse(turn) * -Vec3(m[3])};
}

Expected<std::vector<Half>> read_halves(const Capture& capture, const Light& light, const World& world) {
  std::vector<Half> halves;
  for (std::size_t i = 0; i < capture.map.size(); ++i) {
    const std::string field = fmt::format("map[{}].clip_from_world", i);
    const auto half = take_half_apart(*capture.map[i].clip_from_world);
    if (!half) return capture_error(capture, field, half.error());
    MatrixFace face;
    face.projection = LightProjection::perspective, face.origin = half->origin;
    if (const auto reason = not_of_light(face, capture.map.size(), light, world))
      return capture_error(capture, field, *reason);
    halves.push_back(*half);
  }
  const auto axis = [&](std::size_t i) { return glm::transpose(halves[i].half_from_world)[2]; };
  if (glm::dot(axis(0), axis(1)) > rigid_slack - 1.0)
    return capture_error(capture, "map[1].clip_from_world", "does not look the opposite way of map[0]");
  return halves;
}

/// The layer's distances, world units, rows from its bottom.
Expected<CapturedParaboloid> read_half(const Capture& capture, std::size_t i, const Half& half) {
  const CapturedLayer& layer = capture.map[i];
  const std::string field = fmt::format("map[{}].depth", i);
  ImageSize picture;
  const auto channel = read_layer_numbers(capture, i, picture);
  if (!channel) return fail(channel.error());
  const CapturedRect rect = layer.rect.value_or(CapturedRect{0, 0, picture.width, picture.height});
  CapturedParaboloid out{half.half_from_world, rect.width, rect.height};
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
  if (bad > 0) return capture_error(capture, field, fmt::format("{} texels are not numbers", bad));
  return out;
}

/// A cube around the light, whose depths hold all distances.
LightView cube_around(const Vec3& origin, const std::vector<CapturedParaboloid>& halves) {
  Interval distances{infinity, 0.0};
  double texels = 0.0;
  for (const CapturedParaboloid& half : halves) {
    texels += 0.25 * pi * half.width * half.height;  // of the disc
    for (const float d : half.distances)
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

/// Each texel has the number of the paraboloid's texel in which its middle lies, as a depth on the ray through that one's middle.
void fill_cube(const std::vector<CapturedParaboloid>& halves, raster::ShadowMap& map) {
  const LightView& view = map.view;
  const int n = view.size;
  map.depth.assign(static_cast<std::size_t>(6 * n) * static_cast<std::size_t>(n), 0.0f);
  for (int face = 0; face < 6; ++face)
    for (int row = 0; row < n; ++row)
      for (int column = 0; column < n; ++column) {
        const Vec3 ray = texel_ray(view, face, column + 0.5, row + 0.5).direction;
        const ParaboloidPlace place = texel_centre(halves, paraboloid_place(halves, ray));
        const auto distance = paraboloid_distance(halves, place);
        if (!distance) continue;
        const double along = glm::dot(paraboloid_direction(halves, place), view.face(face).forward);
        map.depth[map.texel_index(face, column, row)] =
            static_cast<float>(stored_from_depth(view, face, row + 0.5, *distance * along));
      }
}

void turn_rows_of(CapturedParaboloid& half) {
  for (int row = 0; row < half.height / 2; ++row) {
    const auto line = [&](int r) { return half.distances.begin() + std::ptrdiff_t{r} * half.width; };
    std::swap_ranges(line(row), line(row + 1), line(half.height - 1 - row));
  }
}

}  // namespace

Expected<void> check_paraboloids(const Capture& capture, const Light& light, const World& world) {
  const auto halves = read_halves(capture, light, world);
  if (!halves) return fail(halves.error());
  return {};
}

Expected<CapturedMap> read_paraboloids(const Capture& capture, const Light& light, const World& world) {
  const auto halves = read_halves(capture, light, world);
  if (!halves) return fail(halves.error());
  CapturedMap out;
  out.stored = StoredDepth::paraboloid;
  if (const auto& range = capture.map.front().range) out.unit_world = std::abs(range->y - range->x);
  for (std::size_t i = 0; i < halves->size(); ++i) {
    auto half = read_half(capture, i, (*halves)[i]);
    if (!half) return fail(half.error());
    out.paraboloids.push_back(std::move(*half));
  }
  out.map.view = cube_around(halves->front().origin, out.paraboloids);
  out.map.format = raster::DepthFormat::d32f_reversed;
  fill_cube(out.paraboloids, out.map);
  CapturedCasterBias casters = capture.map.front().caster_bias.value_or(CapturedCasterBias{});
  casters.constant_world += casters.constant * out.unit_world, casters.constant = 0.0;
  out.caster_bias.assign(6, casters);
  out.bias.assign(6, capture.bias.value_or(CapturedBias{}));
  return out;
}

void add_paraboloid_suspects(const raster::CapturedTest& test, std::vector<TestSuspect>& suspects) {
  if (test.paraboloids.empty()) return;
  const auto halves = [](raster::LightRecord & record) -> auto& {
    return record.captured->test->paraboloids;
  };
  suspects.push_back({"`rows` of the map is the other one",
                      "the renderer reads its map upside down (v runs the other way)",
                      [=](raster::LightRecord& record) {
                        for (CapturedParaboloid& half : halves(record)) turn_rows_of(half);
                        return true;
                      }});
  suspects.push_back(
      {"the pictures of map[0] and map[1] are exchanged", "", [=](raster::LightRecord& record) {
         auto& both = halves(record);
         const bool alike = both[0].width == both[1].width && both[0].height == both[1].height;
         if (alike) std::swap(both[0].distances, both[1].distances);
         return alike;
       }});
}

}  // namespace gnomon::compare
