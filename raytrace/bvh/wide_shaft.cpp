#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/bvh/wide_shaft.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "raytrace/bvh/wide_instances.h"
#include "raytrace/bvh/wide_leaf-inl.h"
#include "raytrace/bvh/wide_shaft.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
namespace {

// A point of the shaft is at or above a lower plane b of an axis only if o + t high >= b. At or below an
// upper one only if o + t low <= b. Each bounds t from one side, which side by the sign of high or low. The
// floats are those of a ray's slabs with another direction for the upper planes than for the lower ones, and
// so are their errors (raytrace/bvh/wide_ray.h).
struct SpreadShaft {
  V inverse[6], constant[6];  // by the rows of WideNode::bounds
  bool enters[6];             // t is at least this, otherwise at most
  V end;
};

/// False: the bounds would not hold.
bool spread(const WideTree& tree, const Shaft& shaft, SpreadShaft& to) {
  const double size = std::max(max_component(glm::abs(shaft.low)), max_component(glm::abs(shaft.high)));
  const float r = tree.reach;
  if (!(size >= 0x1p-60 && size <= 0x1p60)) return false;
  constexpr float narrowest = 0x1p-40f;
  for (std::size_t row = 0; row < 6; ++row) {
    const int a = static_cast<int>(row % 3);
    const bool lower = row < 3;  // a lower plane
    const double o = shaft.origin[a] - tree.center[row % 3];
    if (!(std::abs(o) <= 0x1p60)) return false;
    const auto origin = static_cast<float>(o);
    const auto widest =
        static_cast<float>((lower ? shaft.high[a] : shaft.low[a]) / size) + (lower ? 0x1p-20f : -0x1p-20f);
    const float direction =
        std::abs(widest) < narrowest ? (lower ? narrowest : -narrowest) : widest;  // wider, too
    const float inverse = 1.0f / direction;
    const float slack = 0x1p-20f * std::abs(inverse) * (r + std::abs(origin));
    to.enters[row] = lower == (direction > 0.0f);
    to.inverse[row] = all(inverse);
    to.constant[row] = all(-origin * inverse + (to.enters[row] ? -slack : slack));
  }
  to.end = all(shaft.endless ? FLT_MAX : static_cast<float>(size) * WideRay::widening);
  return true;
}

/// The children whose boxes the shaft may intersect, by bits.
HWY_INLINE unsigned intersected_children(const WideNode& node, const SpreadShaft& shaft) {
  unsigned hit = 0;
  for (std::size_t i = 0; i < node_lanes; i += lanes) {
    V near = hn::Zero(f), far = shaft.end;
    for (std::size_t row = 0; row < 6; ++row) {
      const V t = hn::MulAdd(hn::Load(f, node.bounds[row] + i), shaft.inverse[row], shaft.constant[row]);
      if (shaft.enters[row])
        near = hn::Max(near, t);
      else
        far = hn::Min(far, t);
    }
    hit |= mask_bits(f, hn::Le(near, far)) << i;
  }
  return hit;
}

/// The shaft in the space of an instance's mesh, or one around it. Where has_bounds() holds for shaft_to_spare, the norms of the
/// matrix and its inverse multiply to at most 2^18, so that directions are right to 2^-30 of their size; spread() widens them
/// by 2^-20.
Shaft placed(const WideInstance& instance, const Shaft& shaft) {
  const Mat3& m = instance.object_from_world;
  const Mat3 sizes(glm::abs(m[0]), glm::abs(m[1]), glm::abs(m[2]));
  const Vec3 center = m * (0.5 * (shaft.low + shaft.high)), half = sizes * (0.5 * (shaft.high - shaft.low));
  return {m * (shaft.origin - instance.translation), center - half, center + half, shaft.endless};
}

/// Finds the leaves of a tree whose first leaf primitive is `first`; false: floats do not bound it, or they are too many.
bool find_in_tree(const WideTree& tree, std::uint32_t first, const Shaft& given, ShaftLeaves& found) {
  SpreadShaft shaft;
  if (!spread(tree, given, shaft)) return false;
  std::array<std::uint32_t, (node_lanes - 1) * (Bvh::max_depth + 4) + node_lanes> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const WideNode& node = tree.nodes[stack[--size]];
    for (unsigned hit = intersected_children(node, shaft); hit != 0; hit &= hit - 1) {
      const WideChild child{node.child[std::countr_zero(hit)]};
      if (!child.is_leaf()) {
        stack[size++] = child.index();
      } else if (child.is_instance()) {
        const WideInstance& instance = tree.instances[child.index()];
        if (!has_bounds(instance, error_in_world(given.origin, 0.0), shaft_to_spare) ||
            !find_in_tree(*instance.mesh, instance.first_leaf, placed(instance, given), found))
          return false;
      } else {
        const LeafTriangles& leaf = tree.leaves[child.index()].triangles;
        if (!found.add({first + leaf.first(), leaf.last() + 1})) return false;
      }
    }
  }
  return true;
}

bool shaft_kernel(const WideTree& tree, const Shaft& shaft, ShaftLeaves& found) {
  return find_in_tree(tree, 0, shaft, found);
}

}  // namespace
}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon::raytrace {
HWY_EXPORT(shaft_kernel);

bool leaves_in_shaft(const WideTree& tree, const Shaft& shaft, ShaftLeaves& found) {
  return !tree.plain && HWY_DYNAMIC_DISPATCH(shaft_kernel)(tree, shaft, found);
}

}  // namespace gnomon::raytrace
#endif  // HWY_ONCE
