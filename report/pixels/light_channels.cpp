// Numbers are exact (labels, faces, decisions) or rounded to a step that is written beside them:
// - Map positions go to 1/256 texel downwards, so that the texel stays the same.
// - Visibilities go to 1/25200, which is exact for filters of up to 7 x 7 samples.
// - Distances, depths and gaps go to a power of two of about 2^-22 of the map's depth range.
// - A gap so rounded stays on its side of every bias of the curve. So what these biases draw is exact.
#include "report/pixels/page_data.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "compare/bias/bias_curve.h"
#include "compare/result/option_names.h"
#include "compare/result/output_parts.h"
#include "compare/result/result_parts.h"
#include "report/page.h"
#include "scene/base/parallel.h"

namespace gnomon::report {
namespace {

using compare::LightComparison;
using compare::vector3;

using Json = nlohmann::ordered_json;

constexpr std::size_t most_map_texels = std::size_t{1} << 21;  // larger maps are reduced
constexpr std::uint32_t nothing_stored = 0xffffffffu, endless = 0x80000000u;

double depth_step(const LightView& view) {
  const Interval range = view.depth_range();
  return std::exp2(std::ceil(std::log2(range.max - range.min)) - 22.0);
}

// --- the map ---

struct MapNumbers {
  int step = 1;  ///< of a reduced map: one number is the nearest depth of step x step texels
  std::size_t side = 0;
  std::vector<std::uint32_t> depths;  ///< above the near depth, in depth steps
};

int reduction(const LightView& view) {
  int step = 1;
  const auto texels = [&view](int s) {
    const auto side = static_cast<std::size_t>((view.size + s - 1) / s);
    return static_cast<std::size_t>(view.face_count) * side * side;
  };
  while (texels(step) > most_map_texels) ++step;
  return step;
}

MapNumbers map_numbers(const raster::ShadowMap& map) {
  MapNumbers out{reduction(map.view), 0, {}};
  const raster::ShadowMap small = out.step == 1 ? raster::ShadowMap{} : compare::reduced_map(map, out.step);
  const std::vector<float>& depth = out.step == 1 ? map.depth : small.depth;
  const LightView& view = out.step == 1 ? map.view : small.view;
  const double unit = depth_step(view), near_depth = view.depth_range().min;
  out.side = static_cast<std::size_t>(view.size);
  out.depths.resize(depth.size());
  parallel_for(depth.size(), [&](std::size_t i) {
    const double stored = depth[i];
    const auto face = static_cast<int>(i / (out.side * out.side));
    const double v = static_cast<double>(i / out.side % out.side) + 0.5;
    out.depths[i] = holds_caster(view, stored)
                        ? rounded((depth_from_stored(view, face, v, stored) - near_depth) / unit)
                        : nothing_stored;
  });
  return out;
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

// --- one light's pixels ---

/// Whether all is lit or in shadow, with nothing between.
bool is_hard(const Image<float>& visibility) {
  return std::ranges::all_of(visibility.data, [](float v) { return v == 0.0f || v == 1.0f; });
}

void add_ladder(Channels& channels, const LightComparison& light) {
  const std::size_t n = light.labels.data.size();
  std::array<bool, compare::rung_count> hard{};
  parallel_for(compare::rung_count, [&](std::size_t k) { hard[k] = is_hard(light.rungs[k]); });
  const PackOptions some{2}, all_or_nothing{.bytes = 1, .unit = static_cast<std::uint32_t>(visibility_steps)};
  channels.add("label", n, {1},
               [&light](std::size_t i) { return static_cast<std::uint32_t>(light.labels.data[i]); });
  for (std::size_t k = 0; k < compare::rung_count; ++k) {
    const std::string name = fmt::format("V{}", k);
    if (k > 0 && light.rungs[k].data == light.rungs[k - 1].data) {
      channels.add_same(name, fmt::format("V{}", k - 1));
      continue;
    }
    // Most pixels stay on the way down as they were.
    const Image<float>* above = k > 0 ? &light.rungs[k - 1] : nullptr;
    channels.add(
        name, n, hard[k] && (k == 0 || hard[k - 1]) ? all_or_nothing : some,
        [&light, k, above](std::size_t i) {
          const auto steps = [i](const Image<float>& v) {
            return rounded(visibility_steps * double{v.data[i]});
          };
          return steps(light.rungs[k]) - (above != nullptr ? steps(*above) : 0u);
        },
        above != nullptr ? fmt::format("V{}", k - 1) : std::string());
  }
}

LookupNumbers lookup_of(const raster::LightRecord& record) {
  const std::size_t n = record.distance.data.size();
  const double step = depth_step(record.map.view);
  LookupNumbers out{std::vector<std::uint32_t>(n), std::vector<std::uint32_t>(n),
                    std::vector<std::uint32_t>(n)};
  parallel_for(n, [&](std::size_t i) {
    out.u[i] = integer(std::floor(position_steps * double{record.texel_uv.data[i].x}));
    out.v[i] = integer(std::floor(position_steps * double{record.texel_uv.data[i].y}));
    out.distance[i] = rounded(double{record.distance.data[i]} / step);
  });
  return out;
}

// What the gap should be, from the numbers that the page has, by operations that IEEE 754 fixes to the last
// bit: the page's twin (page/src/expected_gaps.ts) comes out the same.
class ExpectedGaps {
 public:
  ExpectedGaps(const raster::LightRecord& record, const raster::Bias& bias, const LookupNumbers& lookup,
               const MapNumbers& map, const PixelSurfaces& surfaces)
      : view_(record.map.view),
        face_(record.face),
        bias_(bias),
        lookup_(lookup),
        map_(map),
        surfaces_(surfaces),
        depth_step_(depth_step(view_)),
        near_steps_(view_.depth_range().min / depth_step_) {}

  std::uint32_t operator()(std::size_t i) const {
    const double size = position_steps * view_.size;
    const double u = signed_value(lookup_.u[i]), v = signed_value(lookup_.v[i]);
    if (u < 0.0 || v < 0.0 || u >= size || v >= size) return endless;
    const int face = face_.data[i];
    const auto cell = [this](double p) {
      return static_cast<std::size_t>(std::floor(p / position_steps / map_.step));
    };
    const std::uint32_t depth =
        map_.depths[(static_cast<std::size_t>(face) * map_.side + cell(v)) * map_.side + cell(u)];
    if (depth == nothing_stored) return endless;
    const bool perspective = view_.projection == LightProjection::perspective;
    const LightFace& f = view_.face(face);
    const double x = perspective ? (2.0 * u / size - 1.0) * f.half_extent.x : 0.0;
    const double y = perspective ? (2.0 * v / size - 1.0) * f.half_extent.y : 0.0;
    const double along = std::sqrt(1.0 + x * x + y * y), distance = signed_value(lookup_.distance[i]);
    const double stored = (near_steps_ + depth) * along;
    const double gap = distance - stored + tilt(f, i, x, y) * (perspective ? distance : 1.0 / depth_step_);
    return std::abs(gap) < 1e9 ? integer(std::floor(gap + 0.5)) : endless;
  }

 private:
  static double signed_value(std::uint32_t number) { return static_cast<std::int32_t>(number); }

  /// What slope bias and receiver plane make of the tilt of the pixel's surface, (x, y) along right and up
  /// from the face's axis. It is per unit of distance of a perspective map.
  double tilt(const LightFace& f, std::size_t i, double x, double y) const {
    if (bias_.slope == 0.0 && !bias_.receiver_plane) return 0.0;
    const Vec3 normal = surfaces_.normal(i);
    const auto across = [&](const Vec3& axis) {
      return normal.x * axis.x + normal.y * axis.y + normal.z * axis.z;
    };
    const double right = across(f.right), up = across(f.up), ahead = across(f.forward) + x * right + y * up;
    if (!(ahead < 0.0))
      return std::numeric_limits<double>::infinity();  // the bias of what faces away has no bound
    const double by_u = right * f.half_extent.x / view_.size / ahead,
                 by_v = up * f.half_extent.y / view_.size / ahead;
    const auto to_centre = [](std::uint32_t number) {
      const double texels = (signed_value(number) + 0.5) / position_steps;
      return std::floor(texels) + 0.5 - texels;
    };
    const double plane =
        bias_.receiver_plane ? 2.0 * (by_u * to_centre(lookup_.u[i]) + by_v * to_centre(lookup_.v[i])) : 0.0;
    return 0.0 - bias_.slope * (std::abs(by_u) + std::abs(by_v)) - plane;
  }

  const LightView& view_;
  const Image<std::uint8_t>& face_;
  const raster::Bias& bias_;
  const LookupNumbers& lookup_;
  const MapNumbers& map_;
  const PixelSurfaces& surfaces_;
  double depth_step_, near_steps_;
};

// In depth steps, upwards, but downwards where a bias of the curve lies between: `biases` ascending.
std::uint32_t gap_number(double gap, double step, const std::vector<float>& biases) {
  if (!std::isfinite(gap)) return gap < 0.0 ? endless : integer(gap);
  double number = std::ceil(gap / step);
  const auto bias = std::lower_bound(biases.begin(), biases.end(), gap);
  if (bias != biases.end() && *bias < number * step) number -= 1.0;
  return integer(number);
}

std::vector<float> curve_biases(const LightComparison& light, double used) {
  std::vector<float> biases{static_cast<float>(used)};
  for (const compare::BiasCurvePoint& point : light.bias_curve)
    biases.push_back(static_cast<float>(point.bias));
  std::sort(biases.begin(), biases.end());
  return biases;
}

void add_lookup(Channels& channels, const LightComparison& light, const raster::LightRecord& record,
                const raster::Bias& bias, const std::shared_ptr<const MapNumbers>& map,
                const PixelSurfaces& surfaces) {
  const std::size_t n = light.labels.data.size();
  const double step = depth_step(record.map.view);
  const auto lookup = std::make_shared<const LookupNumbers>(lookup_of(record));
  const auto predicted = std::make_shared<const LookupNumbers>(
      predicted_lookups(surfaces, record.map.view, record.face, *lookup, step));
  channels.add("face", n, {1}, [&record](std::size_t i) { return std::uint32_t{record.face.data[i]}; });
  channels.add("u", n, {4}, [lookup, predicted](std::size_t i) { return lookup->u[i] - predicted->u[i]; });
  channels.add("v", n, {4}, [lookup, predicted](std::size_t i) { return lookup->v[i] - predicted->v[i]; });
  channels.add("distance", n, {4},
               [lookup, predicted](std::size_t i) { return lookup->distance[i] - predicted->distance[i]; });
  const auto biases =
      std::make_shared<const std::vector<float>>(curve_biases(light, record.bias_constant_world));
  channels.add(
      "gap", n, {4, From::surface},
      [&record, lookup, map, biases, step, expected = ExpectedGaps(record, bias, *lookup, *map, surfaces)](
          std::size_t i) { return gap_number(record.gap.data[i], step, *biases) - expected(i); },
      "expected gap");
}

// The metrics' maps: in hundredths, with -128 where no window of SSIM fits.
void add_metrics(Channels& channels, const LightComparison& light) {
  const std::size_t n = light.flip_map.data.size();
  if (n == 0) return;
  channels.add("flip", n, {1},
               [&light](std::size_t i) { return rounded(100.0 * double{light.flip_map.data[i]}); });
  channels.add("ssim", n, {1}, [&light](std::size_t i) {
    const double value = light.ssim_map.data[i];
    return std::isnan(value) ? integer(-128.0) : rounded(100.0 * value);
  });
}

void add_decisions(Channels& channels, const raster::LightRecord& record) {
  if (!record.external || record.external->decision.data.empty()) return;
  const auto& decision = record.external->decision.data;
  channels.add("decision", decision.size(), {1},
               [&decision](std::size_t i) { return std::uint32_t{decision[i]}; });
}

// Glass that the map stores in the texel that a pixel looks up, other than the pixel's own surface.
void add_stored_glass(Channels& channels, const LightComparison& light) {
  const auto& places = light.stored_glass.data;
  if (places.empty()) return;
  channels.add("stored_glass", places.size(), {2, From::previous},
               [&places](std::size_t i) { return places[i]; });
}

}  // namespace

nlohmann::ordered_json light_data(const PageInput& in, std::size_t index, Packer& packer,
                                  const PixelSurfaces& surfaces) {
  const compare::Comparison& c = in.comparison;
  const LightComparison& light = c.lights[index];
  const raster::LightRecord& record = compare::drawn_record(c, light);
  const raster::MapOptions& options = c.raster.options.map;
  const raster::Bias& bias = options.bias;
  const auto map = std::make_shared<const MapNumbers>(map_numbers(record.map));
  Channels channels(packer, &surfaces.sources);
  add_ladder(channels, light);
  add_lookup(channels, light, record, bias, map, surfaces);
  add_metrics(channels, light);
  add_decisions(channels, record);
  add_stored_glass(channels, light);
  compare::Json map_json{{"step", map->step}};
  map_json.update(packer.add({4, From::previous}, [map] { return map->depths; }));
  return {
      {"name", shown_light_name(c, index)},
      {"view", view_json(record.map.view)},
      {"map_known", c.raster.has_map()},
      {"technique", compare::drawn_technique(c)},
      {"gaps_decide", compare::biases_follow_from_gaps(c.raster)},
      {"compares_depths", compare::compares_depths(c)},
      {"sized", has_size(compare::light_of(c, light))},
      {"as_cast", options.rays.denoiser == raster::Denoiser::none},
      {"bias",
       {{"constant", compare::draws_bias(c) ? record.bias_constant_world : 0.0},
        {"slope", bias.slope},
        {"normal_offset", bias.normal_offset_texels},
        {"receiver_plane", bias.receiver_plane},
        {"adaptive", bias.adaptive ? compare::Json(record.rounding.adaptive_epsilon_world) : compare::Json()},
        {"scales", raster::scales_bias(options)}}},
      {"texel_world", light.bias_texel_world},
      {"depth_step", depth_step(record.map.view)},
      {"channels", channels.json()},
      {"map", std::move(map_json)}};
}

}  // namespace gnomon::report
