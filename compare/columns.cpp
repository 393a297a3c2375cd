#include "compare/columns.h"

#include <algorithm>

#include "scene/parallel.h"

namespace gnomon::compare {

using raytrace::TexelKey;

Ray caster_ray(const LightView& view, int face_index, double u, double v) {
  Ray ray = texel_ray(view, face_index, u, v);
  if (view.projection == LightProjection::perspective) return ray;
  const LightFace& face = view.face(face_index);
  const double before = face.far_depth - face.near_depth;
  ray.origin += (face.near_depth - before) * ray.direction;
  ray.t = {before, infinity};
  return ray;
}

TexelCentre trace_centre(const LadderInput& in, TexelKey key) {
  const LightView& view = in.record.map.view;
  TexelCentre out;
  out.face = key.face();
  out.ray = caster_ray(view, key.face(), key.column() + 0.5, key.row() + 0.5);
  out.hit = in.tracer.closest_hit(out.ray);
  if (out.hit) {
    const Vec3& forward = view.face(out.face).forward;
    out.depth =
        glm::dot(out.ray.origin - view.origin, forward) + out.hit->t * glm::dot(out.ray.direction, forward);
  }
  return out;
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
  const bool ahead = in.record.map.view.projection == LightProjection::orthographic || t > 0.0;
  return ahead && centre.hit->t >= t - plane_rounding(centre.ray, receiver);
}

namespace {

// A triangle faces the light when its right-hand normal points against the light rays; shapes are met on the
// side that does.
bool triangle_faces_light(const LadderInput& in, std::uint32_t primitive) {
  const auto [a, b, c] = in.world.corners(primitive);
  const LightView& view = in.record.map.view;
  const bool orthographic = view.projection == LightProjection::orthographic;
  const Vec3 along = orthographic ? view.faces[0].forward : a - view.origin;
  return glm::dot(glm::cross(b - a, c - a), along) < 0.0;
}

// The lower rungs hang on sheets where the centre ray is stopped before the receiver's tangent plane, and by
// another triangle than the receiver's.
bool is_stopped_before(const LadderInput& in, const TexelCentre& centre, std::uint32_t pixel) {
  const raytrace::SurfacePoint& receiver = in.traced.receiver.data[pixel];
  return centre.hit && centre.hit->primitive != receiver.primitive &&
         in.world.is_triangle(receiver.primitive) && in.world.is_triangle(centre.hit->primitive) &&
         !meets_plane_unhindered(in, centre, receiver);
}

}  // namespace

bool Column::faces_light(std::uint32_t primitive) const {
  return !input_->world.is_triangle(primitive) || triangle_faces_light(*input_, primitive);
}

bool Column::same_sheet(std::uint32_t a, std::uint32_t b) const {
  if (a == b) return true;
  if (input_ == nullptr || !input_->world.is_triangle(a) || !input_->world.is_triangle(b)) return false;
  const std::size_t sheet = raytrace::sheet_of(*sheets_, a, faces_light(a));
  return sheet < sheets_->size() && sheet == raytrace::sheet_of(*sheets_, b, faces_light(b));
}

ColumnSet::ColumnSet(const LadderInput& in, const TexelGroups& groups,
                     const std::vector<TexelCentre>& centres)
    : input_(in),
      groups_(groups),
      batch_of_group_(groups.keys.size(), no_id),
      kept_(groups.keys.size()),
      surfaces_(in.world, in.topology) {
  std::vector<char> needed(groups.keys.size(), 0);
  const auto mark = [&](const auto& is_needed) {
    parallel_for(groups.keys.size(), [&](std::size_t g) {
      for (const std::uint32_t pixel : groups[g]) needed[g] |= static_cast<char>(is_needed(g, pixel));
    });
  };
  const auto stopped = [&](std::size_t g, std::uint32_t pixel) {
    return is_stopped_before(in, centres[g], pixel);
  };
  mark(stopped);
  if (std::find(needed.begin(), needed.end(), 1) == needed.end()) return;
  surfaces_.prepare();
  std::fill(needed.begin(), needed.end(), 0);
  // Triangles of two surfaces that nowhere hang together share no sheet.
  mark([&](std::size_t g, std::uint32_t pixel) {
    return stopped(g, pixel) &&
           surfaces_.same(in.traced.receiver.data[pixel].primitive, centres[g].hit->primitive);
  });
  add(needed);
}

void ColumnSet::add(const std::vector<char>& marked) {
  std::vector<TexelKey> keys;
  for (std::size_t g = 0; g < marked.size(); ++g) {
    if (!marked[g] || batch_of_group_[g] != no_id) continue;
    batch_of_group_[g] = static_cast<std::uint32_t>(lists_.size());
    keys.push_back(groups_.keys[g]);
  }
  if (!keys.empty())
    lists_.push_back(raytrace::build_texel_lists(input_.tracer, input_.record.map.view, std::move(keys)));
}

Column::Sheets ColumnSet::find(std::size_t group) const {
  const TexelKey key = groups_.keys[group];
  const raytrace::TexelLists& lists = lists_[batch_of_group_[group]];
  return std::make_shared<const std::vector<raytrace::Sheet>>(raytrace::find_sheets(
      input_.world, input_.topology, input_.record.map.view, key, lists[lists.find(key)]));
}

Column ColumnSet::column(std::size_t group) const {
  if (batch_of_group_[group] == no_id) return Column();
  const Column::Sheets& kept = kept_[group];
  return Column(input_, groups_.keys[group], kept ? kept : find(group), surfaces_);
}

Column ColumnSet::kept_column(std::size_t group) {
  if (batch_of_group_[group] == no_id) return Column();
  if (!kept_[group]) kept_[group] = find(group);
  return Column(input_, groups_.keys[group], kept_[group], surfaces_);
}

}  // namespace gnomon::compare
