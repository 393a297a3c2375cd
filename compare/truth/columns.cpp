#include "compare/truth/columns.h"

#include <algorithm>

#include "scene/base/parallel.h"

namespace gnomon::compare {

using raytrace::TexelKey;

namespace {

/// The depth along a face's axis at which what is finite of the world begins.
double first_depth(const World& world, const LightView& view, const LightFace& face) {
  const Aabb& box = world.finite_bounds;
  if (box.empty()) return infinity;
  const Vec3 half = 0.5 * (box.max - box.min);
  return glm::dot(box.center() - view.origin, face.forward) - glm::dot(half, glm::abs(face.forward));
}

}  // namespace

Ray caster_ray(const World& world, const LightView& view, int face_index, double u, double v) {
  Ray ray = texel_ray(view, face_index, u, v);
  if (view.projection == LightProjection::perspective) return ray;
  const LightFace& face = view.face(face_index);
  const double before = face.far_depth - face.near_depth;
  ray.origin += (face.near_depth - before) * ray.direction;
  const double first = first_depth(world, view, face);
  ray.t = {before - std::max(0.0, face.near_depth - first), infinity};
  return ray;
}

TexelCentre trace_centre(const raytrace::Tracer& tracer, const LightView& view, int face, int column,
                         int row) {
  TexelCentre out;
  out.face = face;
  out.ray = caster_ray(tracer.world(), view, face, column + 0.5, row + 0.5);
  out.hit = tracer.closest_hit(out.ray, raytrace::Sides::casting);
  if (out.hit) {
    const Vec3& forward = view.face(face).forward;
    out.depth =
        glm::dot(out.ray.origin - view.origin, forward) + out.hit->t * glm::dot(out.ray.direction, forward);
  }
  return out;
}

TexelCentre trace_centre(const LadderInput& in, TexelKey key) {
  return trace_centre(in.tracer, in.record().map.view, key.face(), key.column(), key.row());
}

std::vector<TexelCentre> trace_centres(const LadderInput& in, const std::vector<TexelKey>& keys) {
  std::vector<TexelCentre> centres(keys.size());
  parallel_for(keys.size(), [&](std::size_t i) { centres[i] = trace_centre(in, keys[i]); });
  return centres;
}

double plane_rounding(const Ray& ray, const raytrace::SurfacePoint& receiver) {
  const double facing = std::abs(glm::dot(receiver.normal, ray.direction));
  const double size =
      glm::length(receiver.position) + glm::length(ray.origin) + glm::length(receiver.position_error);
  return 32.0 * std::numeric_limits<double>::epsilon() * size / facing;
}

bool meets_plane_unhindered(const LadderInput& in, const TexelCentre& centre,
                            const raytrace::SurfacePoint& receiver) {
  if (!centre.hit) return true;
  const double facing = glm::dot(receiver.normal, centre.ray.direction);
  if (!(facing < 0.0)) return false;
  const double t = glm::dot(receiver.normal, receiver.position - centre.ray.origin) / facing;
  const bool ahead = in.record().map.view.projection == LightProjection::orthographic || t > 0.0;
  return ahead && centre.hit->t >= t - plane_rounding(centre.ray, receiver);
}

bool Column::same_sheet(std::uint32_t a, std::uint32_t b) {
  if (a == b) return true;
  const World& world = input_.world();
  if (!world.is_triangle(a) || !world.is_triangle(b)) return false;
  if (!surfaces_.same(a, b)) return false;  // sooner than to look for b on all of a's sheet
  if (!sheets_) sheets_.emplace(world, input_.topology, input_.record().map.view, key_);
  return sheets_->same(a, b);
}

}  // namespace gnomon::compare
