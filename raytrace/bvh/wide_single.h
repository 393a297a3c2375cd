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

/// False: refused, the ray has to go another way. `work`: adds what the tree's floats and the planes' tests are.
template <bool masks, class Arithmetic>
bool closest_wide(const Structures& s, const WideTree& tree, const Ray& ray, std::uint32_t skip,
                  std::optional<Hit>& best, WorkCounts* work = nullptr) {
  if (work != nullptr) work->primitives += s.planes.size();
  RayFrame frame;
  if (!masks && skip == no_id) {
    LeafCandidates found;
    if (closest_candidates(tree, ray, found, work) != WideTraversal::refused) {
      std::size_t left = 0;
      for (std::size_t i = 0; i < found.count; ++i)
        if (found.t[i] <= found.t_max) found.leaf[left++] = found.leaf[i];
      if (left == 0 && s.planes.empty()) return true;
      scale_ray(ray, frame), shear_ray(frame);
      if (left == 1 && s.planes.empty()) {
        Hit& hit = best.emplace();
        if (Arithmetic(s, frame).leaf(s, frame, found.leaf[0], hit))
          hit.t /= frame.kernel_t_from_t;
        else
          best.reset();
        return true;
      }
      best = closest_reported<masks, Arithmetic>(s, frame, skip, [&](const RayFrame&, const auto& visit) {
        for (std::size_t i = 0; i < left; ++i) visit(found.leaf[i]);
      });
      return true;
    }
  }
  if (!scale_ray(ray, frame)) return true;
  shear_ray(frame);
  auto traversed = WideTraversal::done;
  best = closest_reported<masks, Arithmetic>(s, frame, skip, [&](const RayFrame& left, const auto& visit) {
    const auto visit_leaf = [&](std::uint32_t leaf, WideRay& limited) {
      if (visit(leaf)) limited.limit(float_above(left.t.max));
      return false;
    };
    traversed = visit_candidates(tree, ray, {.t_above = float_above(left.t.max)}, visit_leaf, work);
  });
  return traversed != WideTraversal::refused;
}

template <bool masks, class Arithmetic>
bool any_wide(const Structures& s, const WideTree& tree, const Ray& ray, bool& found,
              WorkCounts* work = nullptr) {
  RayFrame frame;
  if (!scale_ray(ray, frame)) return true;
  shear_ray(frame);
  const Arithmetic arithmetic(s, frame);
  Hit hit;
  const auto blocks = [&]() {
    if constexpr (masks) return passes_alpha_test(s, frame, hit);
    return true;
  };
  for (const std::uint32_t plane : s.planes) {
    if (work != nullptr) ++work->primitives;
    if (arithmetic.plane(s, frame, plane, hit) && blocks()) return found = true;
  }
  const auto visit = [&](std::uint32_t leaf, WideRay&) {
    return arithmetic.leaf(s, frame, leaf, hit) && blocks();
  };
  const WideTraversal traversed =
      masks ? visit_candidates(tree, ray, {}, visit, work) : visit_ambiguous(tree, ray, visit, work);
  found = traversed == WideTraversal::ended;
  return traversed != WideTraversal::refused;
}

}  // namespace gnomon::raytrace
