// The two verbs for one ray through the wide tree: candidates by floats, answers by the arithmetic of choice.
// They are those of the plain traversal, bit for bit.
#pragma once

#include "raytrace/bvh/wide_traverse.h"
#include "raytrace/kernels.h"

namespace gnomon::raytrace {

/// Null: not there (yet); counts the ray.
inline const WideTree* wide_tree(const Structures& s) {
  return s.wide != nullptr ? s.wide->for_ray(s.bvh, *s.world) : nullptr;
}

/// What the wide tree says of a ray. refused: nothing, the ray has to go another way.
enum class WideAnswer : std::uint8_t { refused, nothing, hit };

inline WideAnswer hit_or_nothing(bool is_hit) {
  return is_hit ? WideAnswer::hit : WideAnswer::nothing;
}

/// The closest hit among candidates and planes.
template <class Arithmetic>
[[gnu::noinline]] WideAnswer closest_found(const Structures& s, const Ray& ray, LeafCandidates& found,
                                           Hit& best) {
  std::size_t left = 0;
  for (std::size_t i = 0; i < found.count; ++i)
    if (found.t[i] <= found.t_max) found.leaf[left++] = found.leaf[i];
  RayFrame frame;
  if (!scale_ray(ray, frame)) return WideAnswer::nothing;
  shear_ray(frame);
  if (left == 1 && s.planes.empty()) {
    if (!Arithmetic(s, frame).leaf(s, frame, found.leaf[0], best)) return WideAnswer::nothing;
    best.t /= frame.kernel_t_from_t;
    return WideAnswer::hit;
  }
  const auto closest =
      closest_reported<false, Arithmetic>(s, frame, no_id, [&](const RayFrame&, const auto& visit) {
        for (std::size_t i = 0; i < left; ++i) visit(found.leaf[i]);
      });
  if (closest) best = *closest;
  return hit_or_nothing(closest.has_value());
}

/// Each candidate decided as it is found.
template <bool masks, class Arithmetic>
[[gnu::noinline]] WideAnswer closest_visited(const Structures& s, const WideTree& tree, const Ray& ray,
                                             std::uint32_t skip, Hit& best, WorkCounts* work) {
  RayFrame frame;
  if (!scale_ray(ray, frame)) return WideAnswer::nothing;
  shear_ray(frame);
  auto traversed = WideTraversal::done;
  const auto closest =
      closest_reported<masks, Arithmetic>(s, frame, skip, [&](const RayFrame& left, const auto& visit) {
        const auto visit_leaf = [&](std::uint32_t leaf, WideRay& limited) {
          if (visit(leaf)) limited.limit(float_above(left.t.max));
          return false;
        };
        traversed = visit_candidates(tree, ray, {.t_above = float_above(left.t.max)}, visit_leaf, work);
      });
  if (traversed == WideTraversal::refused) return WideAnswer::refused;
  if (closest) best = *closest;
  return hit_or_nothing(closest.has_value());
}

/// `work`: adds what the tree's floats and the planes' tests are.
template <bool masks, class Arithmetic>
[[gnu::noinline]] WideAnswer closest_wide(const Structures& s, const WideTree& tree, const Ray& ray,
                                          std::uint32_t skip, Hit& best, WorkCounts* work = nullptr) {
  if (work != nullptr) work->primitives += s.planes.size();
  if (!masks && skip == no_id) {
    LeafCandidates found;
    if (closest_candidates(tree, ray, found, work) != WideTraversal::refused) {
      const bool is_empty = found.count == 0 && s.planes.empty();
      return is_empty ? WideAnswer::nothing : closest_found<Arithmetic>(s, ray, found, best);
    }
  }
  return closest_visited<masks, Arithmetic>(s, tree, ray, skip, best, work);
}

/// Whether a primitive blocks a ray, by the arithmetic of choice. The ray is made ready for it when the first is
/// asked for: of most rays the floats know enough.
template <bool masks, class Arithmetic>
class Blockers {
 public:
  Blockers(const Structures& s, const Ray& ray) : s_(s), ray_(ray) {}
  /// `surely`: the floats know that the ray hits it.
  bool leaf(std::uint32_t leaf, bool surely) {
    if (surely && !(masks && s_.world->is_masked(s_.bvh.id_at(leaf)))) return true;
    return is_ready() && arithmetic_->leaf(s_, frame_, leaf, hit_) && is_opaque_there();
  }
  bool plane(std::uint32_t plane) {
    return is_ready() && arithmetic_->plane(s_, frame_, plane, hit_) && is_opaque_there();
  }

 private:
  /// Returns false where the ray hits nothing.
  bool is_ready() {
    if (!arithmetic_ && scale_ray(ray_, frame_)) shear_ray(frame_), arithmetic_.emplace(s_, frame_);
    return arithmetic_.has_value();
  }
  bool is_opaque_there() {
    if constexpr (masks) return casts_shadow(s_, hit_.primitive) && passes_alpha_test(s_, frame_, hit_);
    return true;
  }

  const Structures& s_;
  const Ray& ray_;
  RayFrame frame_;
  std::optional<Arithmetic> arithmetic_;
  Hit hit_;
};

/// The leaves and the planes one by one.
template <bool masks, class Arithmetic>
bool any_among(const Structures& s, const Ray& ray, std::span<const std::uint32_t> leaves) {
  Blockers<masks, Arithmetic> blockers(s, ray);
  return std::any_of(leaves.begin(), leaves.end(),
                     [&](std::uint32_t i) { return blockers.leaf(i, false); }) ||
         std::any_of(s.planes.begin(), s.planes.end(), [&](std::uint32_t id) { return blockers.plane(id); });
}

template <bool masks, class Arithmetic>
WideAnswer any_wide(const Structures& s, const WideTree& tree, const Ray& ray, WorkCounts* work = nullptr) {
  Blockers<masks, Arithmetic> blockers(s, ray);
  for (const std::uint32_t plane : s.planes) {
    if (work != nullptr) ++work->primitives;
    if (blockers.plane(plane)) return WideAnswer::hit;
  }
  const auto visit = [&](std::uint32_t leaf, bool surely) { return blockers.leaf(leaf, surely); };
  const WideTraversal traversed = visit_blockers(tree, ray, visit, work);
  return traversed == WideTraversal::refused ? WideAnswer::refused
                                             : hit_or_nothing(traversed == WideTraversal::ended);
}

}  // namespace gnomon::raytrace
