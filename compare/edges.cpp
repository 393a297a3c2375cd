#include "compare/edges.h"

#include <tbb/parallel_for.h>

namespace gnomon::compare {
namespace {

constexpr int window = 3;       // half-width of the gradient's window, pixels
constexpr double step = 0.5;    // of the walk, pixels
constexpr double reach = 64.0;  // of the walk, pixels

struct EdgeSums {
  std::uint64_t edges = 0;
  double texels = 0.0, texels_squared = 0.0, pixels_squared = 0.0;
};

struct EdgeWalk {
  const raster::RasterFrame& drawn;
  const raster::LightRecord& record;
  const Image<float>& truth;
  const Image<Label>& labels;
  const World& world;

  bool usable(int x, int y) const {
    const ImageSize& s = labels.size;
    return x >= 0 && y >= 0 && x < s.width && y < s.height && is_compared(labels.at(x, y));
  }
  bool lit(const Image<float>& image, std::size_t i) const { return image.data[i] > 0.5f; }
  std::uint32_t object(std::size_t i) const { return world.object_of(drawn.primitive.data[i]); }

  // From shadow to light, unit length; zero where the window is balanced.
  Vec2 towards_light(int x, int y) const {
    Vec2 sum(0.0);
    const std::uint32_t own = object(labels.index(x, y));
    for (int dy = -window; dy <= window; ++dy) {
      for (int dx = -window; dx <= window; ++dx) {
        if (!usable(x + dx, y + dy)) continue;
        const std::size_t i = labels.index(x + dx, y + dy);
        if (object(i) == own) sum += Vec2(dx, dy) * (lit(truth, i) ? 1.0 : -1.0);
      }
    }
    const double length = glm::length(sum);
    return length > 0.0 ? sum / length : Vec2(0.0);
  }

  // Walks from the edge into the side that is drawn wrong there, until it is drawn right again; the offset in
  // pixels, or infinity. `end` is the pixel where the walk ended.
  double walk(Vec2 from, Vec2 direction, bool expected_lit, std::uint32_t own, std::size_t& end) const {
    for (double s = 0.5 * step; s <= reach; s += step) {
      const Vec2 p = from + s * direction;
      const int x = static_cast<int>(std::floor(p.x));
      const int y = static_cast<int>(std::floor(p.y));
      if (!usable(x, y)) return infinity;
      const std::size_t i = labels.index(x, y);
      if (object(i) != own || lit(truth, i) != expected_lit) return infinity;
      end = i;
      if (lit(record.visibility, i) == expected_lit) return s - 0.5 * step;
    }
    return infinity;
  }

  // Offset of the drawn edge at a true edge between pixels p (shadowed) and q (lit).
  void measure(int px, int py, int qx, int qy, EdgeSums& sums) const {
    const std::size_t p = labels.index(px, py);
    const std::uint32_t own = object(p);
    const Vec2 normal = towards_light(px, py);
    if (normal == Vec2(0.0)) return;
    const Vec2 middle(0.5 * (px + qx) + 0.5, 0.5 * (py + qy) + 0.5);
    std::size_t end = p;
    double offset = walk(middle, normal, true, own, end);
    if (offset == 0.0) offset = -walk(middle, -normal, false, own, end);
    if (!std::isfinite(offset)) return;
    const Vec2 start_uv = 0.5 * (Vec2(record.texel_uv.at(px, py)) + Vec2(record.texel_uv.at(qx, qy)));
    const double moved = offset == 0.0 ? 0.0 : glm::length(Vec2(record.texel_uv.data[end]) - start_uv);
    const double texels = std::copysign(moved, offset);
    ++sums.edges;
    sums.texels += texels;
    sums.texels_squared += texels * texels;
    sums.pixels_squared += offset * offset;
  }

  void measure_pair(int px, int py, int qx, int qy, EdgeSums& sums) const {
    if (!usable(px, py) || !usable(qx, qy)) return;
    const std::size_t p = labels.index(px, py);
    const std::size_t q = labels.index(qx, qy);
    if (lit(truth, p) == lit(truth, q) || object(p) != object(q)) return;
    if (record.face.data[p] != record.face.data[q]) return;
    if (lit(truth, p))
      measure(qx, qy, px, py, sums);
    else
      measure(px, py, qx, qy, sums);
  }
};

}  // namespace

EdgeStats measure_edges(const raster::RasterFrame& drawn, const raster::LightRecord& record,
                        const Image<float>& truth, const Image<Label>& labels, const World& world) {
  const EdgeWalk walk{drawn, record, truth, labels, world};
  std::vector<EdgeSums> rows(static_cast<std::size_t>(labels.size.height));
  tbb::parallel_for(0, labels.size.height, [&](int y) {
    for (int x = 0; x < labels.size.width; ++x) {
      walk.measure_pair(x, y, x + 1, y, rows[static_cast<std::size_t>(y)]);
      walk.measure_pair(x, y, x, y + 1, rows[static_cast<std::size_t>(y)]);
    }
  });
  EdgeSums all;
  for (const EdgeSums& row : rows) {
    all.edges += row.edges;
    all.texels += row.texels;
    all.texels_squared += row.texels_squared;
    all.pixels_squared += row.pixels_squared;
  }
  EdgeStats stats;
  stats.edges = all.edges;
  if (all.edges == 0) return stats;
  const auto n = static_cast<double>(all.edges);
  stats.mean_texels = all.texels / n;
  stats.rms_texels = std::sqrt(all.texels_squared / n);
  stats.rms_pixels = std::sqrt(all.pixels_squared / n);
  return stats;
}

Detachment measure_detachment(const raytrace::Tracer& tracer, const Light& light,
                              const Image<raytrace::SurfacePoint>& receivers, const Image<Label>& labels) {
  Detachment out;
  double sum = 0.0;
  for (std::size_t i = 0; i < labels.data.size(); ++i) {
    if (labels.data[i] != Label::peter_panning) continue;
    const raytrace::SurfacePoint& x = receivers.data[i];
    const auto occluder = tracer.nearest_occluder(x, light);
    if (!occluder) continue;
    const double sine = glm::length(glm::cross(light_at(light, x.position).to_light, x.normal));
    const double distance = occluder->t * sine;
    ++out.pixels;
    sum += distance;
    out.max_world = std::max(out.max_world, distance);
  }
  if (out.pixels > 0) out.mean_world = sum / static_cast<double>(out.pixels);
  return out;
}

}  // namespace gnomon::compare
