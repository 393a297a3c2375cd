// One ray through the wide tree, compiled once per instruction set. What is found are candidates: no hit of
// the tests in double is ever missing among them (raytrace/bvh/wide_ray.h says why), and few others are
// there.
#pragma once

#include <array>
#include <limits>

#include "raytrace/bvh/wide_ray.h"
#include "scene/base/parallel.h"
#include "scene/math.h"

namespace gnomon::raytrace {

struct WorkCounts;   // raytrace/tracer.h: given one, a traversal adds what it tests in floats
struct LastBlocker;  // raytrace/tracer.h

/// Positions in leaf order, each with a lower bound of its t (-infinity: none is known).
struct LeafCandidates {
  static constexpr std::size_t most = 32;
  std::array<std::uint32_t, most> leaf;
  std::array<float, most> t;
  std::size_t count = 0;
  float t_max = 0.0;  ///< none is later
};

/// refused: nothing was done, the ray has to go another way. ended: by a visitor or a sure hit.
enum class WideTraversal : std::uint8_t { refused, done, ended };

/// All that may be the closest hit: those before the least t where there surely is one. Every primitive must
/// count (no masks). `refused` also where there would be too many.
WideTraversal closest_candidates(const WideTree& tree, const Ray& ray, LeafCandidates& found,
                                 WorkCounts* work = nullptr);

/// Near ones first, roughly. The visitor may limit the ray, and returns true to end the traversal.
using CandidateVisitor = FunctionRef<bool(std::uint32_t leaf, WideRay& ray)>;
struct TraversalLimits {
  float t_above = std::numeric_limits<float>::infinity();  ///< none from here on; in the units of RayFrame
  double origin_error = 0.0;  ///< how far the ray's true origin may lie from its own, along any axis
  double beyond = 0.0;        ///< how far past its end the ray is followed; in its own units
  double frame_t = 0.0;  ///< RayFrame's units of t, where they are not those of this ray's own frame; else 0
};
WideTraversal visit_candidates(const WideTree& tree, const Ray& ray, const TraversalLimits& limits,
                               CandidateVisitor visit, WorkCounts* work = nullptr);
/// Receives leaves in any order; `surely`: the leaf is a triangle that the ray surely hits in range.
using BlockerVisitor = FunctionRef<bool(std::uint32_t leaf, bool surely)>;
WideTraversal visit_blockers(const WideTree& tree, const Ray& ray, BlockerVisitor visit,
                             WorkCounts* work = nullptr);

/// All that the ray may intersect, but for the triangle `skip` (a primitive's id); ended: one is surely hit.
/// `refused` also where there would be too many. `last`: null, or tried first and updated.
WideTraversal ambiguous_candidates(const WideTree& tree, const Ray& ray, const TraversalLimits& limits,
                                   std::uint32_t skip, LeafCandidates& found, LastBlocker* last);

}  // namespace gnomon::raytrace
