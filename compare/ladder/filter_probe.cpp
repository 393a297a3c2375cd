#include "compare/ladder/filter_probe.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "compare/ladder/biased_test.h"
#include "compare/result/option_names.h"
#include "compare/truth/columns.h"
#include "raster/technique_traits.h"
#include "scene/base/parallel.h"
#include "scene/camera.h"

namespace gnomon::compare {
namespace {

constexpr int least_probes = 5, most_probes = 9;  // on a side
constexpr double probe_spacing_texels = 1.5;

/// The receiver's tangent plane as the map's light rays meet it.
class ReceiverPlane {
 public:
  ReceiverPlane(const LadderInput& in, std::size_t pixel)
      : in_(in),
        receiver_(in.traced.receiver.data[pixel]),
        face_(in.record().face.data[pixel]),
        at_(project_to_face(in.record().map.view, face_, receiver_.position)) {}

  Vec2 place() const { return {at_.u, at_.v}; }

  // Of the plane's point on the ray through a place. Uncertain too where the ray does not reach the plane from
  // the front.
  raytrace::PointVisibility visibility(const Vec2& uv) const {
    const LightView& view = in_.record().map.view;
    const Ray ray = texel_ray(view, face_, uv.x, uv.y);
    const double facing = glm::dot(receiver_.normal, ray.direction);
    if (!(facing < 0.0)) return raytrace::PointVisibility::uncertain;
    const double t = glm::dot(receiver_.normal, receiver_.position - ray.origin) / facing;
    if (view.projection == LightProjection::perspective && !(t > 0.0))
      return raytrace::PointVisibility::uncertain;
    raytrace::SurfacePoint there = receiver_;
    there.position = ray.at(t);
    return in_.tracer.centre_visibility(there, in_.light());
  }

 private:
  const LadderInput& in_;
  const raytrace::SurfacePoint& receiver_;
  int face_;
  TexelCoordinate at_;
};

bool any_within_reach(const LadderInput& in, std::size_t pixel, raytrace::PointVisibility wanted) {
  const ReceiverPlane plane(in, pixel);
  const double reach = pixel_reach_texels(in, pixel);
  const int spans = static_cast<int>(std::ceil(std::min(2.0 * reach / probe_spacing_texels, 1e3)));
  const int probes = std::clamp(spans + 1, least_probes, most_probes);
  const auto offset = [&](int i) { return (2.0 * i / (probes - 1) - 1.0) * reach; };
  for (int j = 0; j < probes; ++j)
    for (int i = 0; i < probes; ++i)
      if (plane.visibility(plane.place() + Vec2(offset(i), offset(j))) == wanted) return true;
  return false;
}

// Texels that the pixel covers on its longer side, as a mipmap level (shaders/moment_lookup.glsl). Levels
// beyond the last one are read at the last: 3 above the finest of a cube map.
double pixel_level(const LadderInput& in, std::size_t pixel) {
  const raytrace::SurfacePoint& receiver = in.traced.receiver.data[pixel];
  const LightView& map = in.record().map.view;
  const int face = in.record().face.data[pixel];
  ImageSize size = in.drawn.primitive.size;
  if (in.place.picture_height > 0) size.height = in.place.picture_height;
  const View view = make_view(in.world().scene->camera, size);
  const auto place = [&](double x, double y) {
    const Ray ray = pixel_ray(view, x, y);
    const double t =
        glm::dot(receiver.normal, receiver.position - ray.origin) / glm::dot(receiver.normal, ray.direction);
    const TexelCoordinate at = project_to_face(map, face, ray.at(t));
    return Vec2(at.u, at.v);
  };
  const auto width = static_cast<std::size_t>(size.width);
  const std::size_t column = pixel % width, row = pixel / width;
  const double x = static_cast<double>(column) + 0.5;
  const double y = in.place.first_row + static_cast<double>(row) + 0.5;
  const TexelCoordinate own = project_to_face(map, face, receiver.position);
  const Vec2 here(own.u, own.v), across = place(x + 1.0, y) - here, down = place(x, y + 1.0) - here;
  const double level = 0.5 * std::log2(std::max(glm::dot(across, across), glm::dot(down, down)));
  const double most = in.light().type == LightType::point ? 3.0 : std::floor(std::log2(map.size));
  return level > 0.0 ? std::min(level, most) : 0.0;  // not a number becomes 0
}

/// The exact rays through texels' centres against the receiver's plane. Those of texels that pixels look up are known.
class TrueTexels {
 public:
  TrueTexels(const LowerClimb& lower, const LadderInput& in, std::size_t pixel)
      : lower_(lower),
        in_(in),
        receiver_(in.traced.receiver.data[pixel]),
        face_(in.record().face.data[pixel]),
        at_(project_to_face(in.record().map.view, face_, receiver_.position)) {}

  Vec2 place() const { return {at_.u, at_.v}; }

  /// Lit too where the ray does not reach the plane from the front.
  bool is_lit(int column, int row) const {
    const LightView& view = in_.record().map.view;
    const double plane =
        plane_depth(view, face_, column + 0.5, row + 0.5, receiver_.position, receiver_.normal);
    if (std::isinf(plane)) return true;
    const Ray ray = caster_ray(in_.world(), view, face_, column + 0.5, row + 0.5);
    return !(depth_at(column, row) < plane - plane_rounding(ray, receiver_));
  }

 private:
  /// Returns the depth of the first thing that the ray through a texel's centre meets.
  double depth_at(int column, int row) const {
    const LightView& view = in_.record().map.view;
    if (std::min(column, row) >= 0 && std::max(column, row) < view.size) {
      const auto& keys = lower_.groups.keys;
      const auto key = raytrace::TexelKey::pack(face_, column, row);
      const auto found = std::lower_bound(keys.begin(), keys.end(), key);
      if (found != keys.end() && *found == key)
        return lower_.centres[static_cast<std::size_t>(found - keys.begin())];
    }
    return trace_centre(in_.tracer, view, face_, column, row).depth;
  }

  const LowerClimb& lower_;
  const LadderInput& in_;
  const raytrace::SurfacePoint& receiver_;
  int face_;
  TexelCoordinate at_;
};

/// The k-th of most_probes places along the side of a square that reaches so far around a receiver.
double tap_within(double reach, double at, int k) {
  return at + (2.0 * (k + 0.5) / most_probes - 1.0) * reach;
}

// The k-th of n places along a kernel's side around a receiver at `at`: the centre of the texel there.
double tap_centre(const raster::FilterOptions& filter, double at, int k, int n) {
  const double share = (k + 0.5) / n;
  if (filter.kernel == raster::FilterKernel::box) {
    const double side = 2.0 * std::floor(filter.radius_texels) + 1.0;
    return std::floor(at) - std::floor(filter.radius_texels) + std::floor(share * side) + 0.5;
  }
  const double radius = filter.kernel == raster::FilterKernel::hardware ? 0.5 : filter.radius_texels;
  return std::floor(at + (2.0 * share - 1.0) * radius) + 0.5;
}

}  // namespace

double pixel_reach_texels(const LadderInput& in, std::size_t pixel) {
  const raster::MapOptions& map = in.drawn.options.map;
  const bool levels = raster::uses_moments(map.technique) && map.filter.mipmaps;
  return filter_reach_texels(map, levels ? pixel_level(in, pixel) : 0.0);
}

bool lit_within_reach(const LadderInput& in, std::size_t pixel) {
  return any_within_reach(in, pixel, raytrace::PointVisibility::lit);
}

bool shadowed_within_reach(const LadderInput& in, std::size_t pixel) {
  return any_within_reach(in, pixel, raytrace::PointVisibility::shadowed);
}

double true_average(const LowerClimb& lower, const LadderInput& in, std::size_t pixel) {
  const TrueTexels texels(lower, in, pixel);
  const raster::MapOptions& map = in.drawn.options.map;
  const bool compares = raster::has_kernel(map.technique);
  const bool disc = compares && map.filter.kernel == raster::FilterKernel::vogel;
  const double reach = compares ? 0.0 : pixel_reach_texels(in, pixel);
  const auto texel = [&](double at, int k) {
    const double tap = compares ? tap_centre(map.filter, at, k, most_probes) : tap_within(reach, at, k);
    return static_cast<int>(std::floor(tap));
  };
  std::array<int, most_probes> columns{};
  for (int i = 0; i < most_probes; ++i) columns[static_cast<std::size_t>(i)] = texel(texels.place().x, i);
  int lit = 0, met = 0;
  for (int j = 0; j < most_probes; ++j) {
    const int row = texel(texels.place().y, j);
    int last = columns.front() - 1;
    bool is_lit = false;
    for (int i = 0; i < most_probes; ++i) {
      const double x = 2.0 * (i + 0.5) / most_probes - 1.0, y = 2.0 * (j + 0.5) / most_probes - 1.0;
      if (disc && x * x + y * y > 1.0) continue;
      const int column = columns[static_cast<std::size_t>(i)];
      if (column != last) is_lit = texels.is_lit(column, row), last = column;
      lit += is_lit ? 1 : 0, ++met;
    }
  }
  return static_cast<double>(lit) / met;
}

namespace {

using raster::EdgeFilter;
using raster::FilterKernel;

// The square of texels around the receiver's own, or around the receiver.
double pcf_reach(const raster::FilterOptions& filter) {
  switch (filter.kernel) {
    case FilterKernel::box:
      return std::floor(filter.radius_texels) + 1.0;
    case FilterKernel::hardware:
      return 1.0;
    case FilterKernel::vogel:
    case FilterKernel::optimised:
      return filter.radius_texels + 1.0;
  }
  return 0.0;
}

}  // namespace

std::string_view filter_kind(const raster::MapOptions& map) {
  const EdgeFilter filter = raster::traits_of(map.technique).filter;
  if (filter == EdgeFilter::kernel) return raster::traits_of(map.filter.kernel).name;
  if (filter == EdgeFilter::penumbra) return "penumbra";
  return filter == EdgeFilter::moments ? "moments" : "none";
}

double filter_reach_texels(const raster::MapOptions& map, double level) {
  const EdgeFilter filter = raster::traits_of(map.technique).filter;
  if (filter == EdgeFilter::kernel) return pcf_reach(map.filter);
  if (filter == EdgeFilter::penumbra) return raster::search_radius_texels(map) + 1.0;
  if (filter != EdgeFilter::moments) return 0.0;
  const double side = std::exp2(std::ceil(level));
  return map.filter.blur_radius_texels + side + 0.5 * (side - 1.0);
}

namespace {

constexpr float visible_step = 0.5f / 255.0f;  // half a step of an 8-bit picture

bool shadowed_up_to_bias(const std::array<Image<float>, rung_count>& rungs, std::size_t pixel) {
  for (std::size_t k = 0; k + 1 < rung_count; ++k)
    if (rungs[k].data[pixel] > 0.0f) return false;
  return true;
}

}  // namespace

void BleedingSum::add(const LadderInput& in, const Climb& climb) {
  if (!raster::uses_moments(in.drawn.options.map.technique)) return;
  const std::array<Image<float>, rung_count>& rungs = climb.rungs;
  const Image<Label>& labels = climb.labels;
  const auto width = static_cast<std::size_t>(labels.size.width);
  std::vector<BleedingStats> rows(static_cast<std::size_t>(labels.size.height));
  parallel_for(rows.size(), [&](std::size_t y) {
    for (std::size_t i = y * width; i < (y + 1) * width; ++i) {
      const float bled = rungs[6].data[i];
      if (!is_compared(labels.data[i]) || bled < visible_step || !shadowed_up_to_bias(rungs, i)) continue;
      if (lit_within_reach(in, i)) continue;
      ++rows[y].pixels;
      rows[y].mean += bled;
      rows[y].max = std::max(rows[y].max, double{bled});
    }
  });
  for (const Label label : labels.data) compared_ += is_compared(label) ? 1 : 0;
  BleedingStats& sum = sums_ ? *sums_ : sums_.emplace();
  for (const BleedingStats& row : rows) {
    sum.pixels += row.pixels;
    sum.mean += row.mean;
    sum.max = std::max(sum.max, row.max);
  }
}

void BleedingSum::write_to(LightFigures& out) const {
  out.bleeding = sums_;
  if (sums_ && compared_ > 0) out.bleeding->mean /= static_cast<double>(compared_);
}

}  // namespace gnomon::compare
