#include "hybrid/soft_shadows.h"

#include "hybrid/tile_shapes.h"

#include "raytrace/precision/error_bounds.h"
#include "raytrace/shading/light_samples.h"
#include "raytrace/shading/light_shaft.h"
#include "raytrace/shading/picture.h"
#include "raytrace/tiles.h"

namespace gnomon::hybrid {
namespace {

using raytrace::PointVisibility;
using raytrace::SurfacePoint;

constexpr int block_pixels = 8;  // a side; blocks share one walk through the edges

/// Receivers may lie 16 times as far as anything finite (light_facing.cpp: the same beside planes).
double reach_of(const World& world, const Light& light) {
  const Aabb& box = world.finite_bounds;
  const double finite =
      box.empty() ? 1.0 : raytrace::max_component(glm::max(glm::abs(box.min), glm::abs(box.max)));
  const double origin =
      light.type == LightType::directional ? 0.0 : raytrace::max_component(glm::abs(light.position));
  return 16.0 * (finite + origin + (box.empty() ? 1.0 : box.diagonal()));
}

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double t = std::clamp(glm::dot(p - a, d) / glm::dot(d, d), 0.0, 1.0);
  return glm::length(p - a - t * d);
}

}  // namespace

SoftLight::SoftLight(const raytrace::Tracer& tracer, const raytrace::Topology& topology, std::uint32_t light)
    : tracer_(tracer),
      index_(light),
      light_(tracer.world().scene->lights[light]),
      reach_(reach_of(tracer.world(), light_)),
      position_error_(raytrace::error_gamma(64) * reach_),
      hull_(light_hull(light_, {tracer.world().middle(), reach_})),
      edges_(tracer.world(), topology, hull_, position_error_) {}

// Some of the light may lie below the receiver's tangent plane.
bool SoftLight::horizon_cuts(const SurfacePoint& point) const {
  for (const Vec3& corner : hull_.corners) {
    const Vec3 d = corner - point.position;
    const double slack = raytrace::error_gamma(16) * glm::dot(glm::abs(d), Vec3(1.0)) + 4.0 * position_error_;
    if (!(glm::dot(point.normal, d) > slack)) return true;
  }
  return false;
}

bool SoftLight::plane_cuts(const Plane& plane, const SurfacePoint& point) const {
  bool above = true, below = true;
  for (const Vec3& corner : hull_.corners) {
    const Vec3 d = corner - plane.point;
    const double slack = raytrace::error_gamma(16) * glm::dot(glm::abs(d), Vec3(1.0)) + 4.0 * position_error_;
    const double height = glm::dot(plane.normal, d);
    above = above && height > slack, below = below && height < -slack;
  }
  if (!above && !below) return true;
  const double own = glm::dot(plane.normal, point.position - plane.point);
  return !(std::abs(own) > 8.0 * position_error_);
}

bool SoftLight::sphere_cuts(const Sphere& sphere, bool own, bool masked, const SurfacePoint& point,
                            const LightCone& cone) const {
  const double light_distance = glm::length(hull_.center - sphere.center);
  const double slack = 8.0 * position_error_;
  const bool light_outside = light_distance - hull_.radius > sphere.radius + slack;
  const bool light_inside = light_distance + hull_.radius < sphere.radius - slack;
  if (own) {
    const bool inner_side = glm::dot(point.normal, point.position - sphere.center) < 0.0;
    // Outside, the horizon tells; inside, every segment stays within or leaves once.
    return masked || (inner_side && !light_outside && !light_inside);
  }
  if (!cone.may_intersect_ball(sphere.center, sphere.radius + slack)) return false;
  const double distance = glm::length(point.position - sphere.center);
  if (masked || !light_outside || !(distance > sphere.radius + slack)) return true;
  for (const Vec3& corner : hull_.corners)
    if (!(distance_to_segment(sphere.center, point.position, corner) < sphere.radius - slack)) return true;
  return false;
}

bool SoftLight::shapes_cut(const SurfacePoint& point, const LightCone& cone) const {
  const World& world = tracer_.world();
  for (std::uint32_t id = world.triangle_count(); id < world.primitive_count(); ++id) {
    const Shape& shape = world.shape(id);
    const bool own = id == point.primitive;
    const bool masked = world.is_masked(id);
    if (const auto* plane = std::get_if<Plane>(&shape.geometry)) {
      if (!own && (masked || plane_cuts(*plane, point))) return true;
    } else if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
      if (sphere_cuts(*sphere, own, masked, point, cone)) return true;
    } else {
      const Sphere ball = ball_around(shape.geometry);
      if (cone.may_intersect_ball(ball.center, ball.radius + 8.0 * position_error_)) return true;
    }
  }
  return false;
}

bool SoftLight::in_penumbra(const SurfacePoint& point, std::span<const std::uint32_t> edges) const {
  if (!(raytrace::max_component(glm::abs(point.position)) < reach_) || horizon_cuts(point)) return true;
  const double margin = 8.0 * position_error_;
  const LightCone cone(point.position, 0.0, hull_);
  if (cone.is_everything() || shapes_cut(point, cone)) return true;
  for (const std::uint32_t i : edges)
    if (edges_.edge(i).may_intersect(cone, margin)) return true;
  return false;
}

/// A block of pixels, its receivers in one ball.
class SoftLight::Block {
 public:
  Block(const SoftLight& soft, const Image<SurfacePoint>& receivers, const Image<Decision>& decisions, int x0,
        int y0, int x1, int y1) {
    Aabb box;
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x)
        if (decisions.at(x, y) != Decision::not_asked) box.grow(receivers.at(x, y).position);
    if (box.empty()) return;
    const LightCone cone(box.center(), 0.5 * box.diagonal() + 8.0 * soft.position_error_, soft.hull_);
    soft.edges_.find(cone, edges_);
  }
  std::span<const std::uint32_t> edges() const { return edges_; }

 private:
  std::vector<std::uint32_t> edges_;
};

SoftCounts SoftLight::find(const Image<SurfacePoint>& receivers, const Image<PointVisibility>& centre,
                           const SoftSamples& samples, Image<Decision>& decisions,
                           Image<float>& visibility) const {
  raytrace::prepare_light_shafts(tracer_, samples.count);
  const raytrace::TileGrid grid{receivers.size};
  std::vector<SoftCounts> tiles(grid.count());
  const auto look = [&](int x, int y, std::span<const std::uint32_t> edges, SoftCounts& counts) {
    const PointVisibility seen_centre = centre.at(x, y);
    const SurfacePoint& point = receivers.at(x, y);
    float& out = visibility.at(x, y);
    out = seen_centre == PointVisibility::shadowed ? 0.0f : 1.0f;
    if (decisions.at(x, y) == Decision::not_asked) return;
    if (seen_centre != PointVisibility::uncertain && !in_penumbra(point, edges)) return;
    const std::size_t pixel = samples.first_pixel + receivers.index(x, y);
    const std::uint64_t key = raytrace::pixel_key(samples.seed, pixel, index_);
    const raytrace::SampledVisibility seen = light_visibility(tracer_, point, light_, samples.count, key);
    out = static_cast<float>(seen.share);
    decisions.at(x, y) = Decision::traced;
    ++counts.penumbra, counts.rays += seen.rays;
  };
  for_each_tile(grid, [&](std::size_t tile, int x0, int y0, int x1, int y1) {
    for (int by = y0; by < y1; by += block_pixels)
      for (int bx = x0; bx < x1; bx += block_pixels) {
        const int ex = std::min(bx + block_pixels, x1), ey = std::min(by + block_pixels, y1);
        const Block block(*this, receivers, decisions, bx, by, ex, ey);
        for (int y = by; y < ey; ++y)
          for (int x = bx; x < ex; ++x) look(x, y, block.edges(), tiles[tile]);
      }
  });
  SoftCounts sum;
  for (const SoftCounts& tile : tiles) sum.penumbra += tile.penumbra, sum.rays += tile.rays;
  return sum;
}

}  // namespace gnomon::hybrid
