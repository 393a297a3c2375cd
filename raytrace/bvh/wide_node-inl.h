// A node's children against one ray, sixteen at once, whatever the instruction set's width, and the stack of
// those that the ray may intersect.

#if defined(GNOMON_RAYTRACE_BVH_WIDE_NODE_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)  // once per instruction set: Highway's own pattern
#ifdef GNOMON_RAYTRACE_BVH_WIDE_NODE_INL_H_
#undef GNOMON_RAYTRACE_BVH_WIDE_NODE_INL_H_
#else
#define GNOMON_RAYTRACE_BVH_WIDE_NODE_INL_H_
#endif

#include "raytrace/bvh/wide_leaf-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
namespace {

/// In which order children are visited: the nearest first, for a ray that ends where it hits something; or as they come, without
/// what sorting costs, for one of which any hit will do.
enum class Order : std::uint8_t { nearest_first, any };

/// Children that the ray may yet intersect, the next one last.
struct Stack {
  // Deeper ones lie above. Of each depth there are the children of two nodes at most, but for one child; a
  // leaf with too many corners may have been halved thrice; the last store may write sixteen.
  static constexpr std::size_t most = (2 * node_lanes - 1) * (Bvh::max_depth + 4) + node_lanes;
  std::uint32_t child[most];
  float near[most];  ///< in Order::any unused
};

using Bytes = hn::CappedTag<std::uint8_t, node_lanes>;
inline constexpr Bytes byte_lanes;

/// A node's children as the ray visits them, or the other way round.
inline constexpr bool sorts_nearest_first = lanes == node_lanes;

/// Where in a node rays of an octant find what they need.
struct OctantPlaces {
  std::size_t near_row[3], far_row[3];  // bytes
  std::size_t order_row;
  alignas(16) std::uint8_t turn[node_lanes];  // places in that row, from the first to the last or back
};
constexpr OctantPlaces places_of(unsigned octant) {
  OctantPlaces places{};
  constexpr std::size_t row = sizeof(WideNode::bounds[0]);
  for (std::size_t a = 0; a < 3; ++a) {
    places.near_row[a] = row * ((octant >> a & 1u) != 0 ? 3 + a : a);
    places.far_row[a] = row * (2 * a + 3) - places.near_row[a];
  }
  places.order_row = octant < 4 ? octant : 7 - octant;
  const std::uint8_t turned = (octant < 4) != sorts_nearest_first ? node_lanes - 1 : 0;
  for (std::uint8_t i = 0; i < node_lanes; ++i) places.turn[i] = i ^ turned;
  return places;
}
inline constexpr OctantPlaces octant_places[8] = {places_of(0), places_of(1), places_of(2), places_of(3),
                                                  places_of(4), places_of(5), places_of(6), places_of(7)};

/// The ray in every lane.
struct SpreadRay {
  V inverse[3], near[3], far[3], t_min;
  const OctantPlaces& places;
  explicit SpreadRay(const WideRay& ray) : t_min(all(ray.t_min)), places(octant_places[ray.octant]) {
    for (std::size_t a = 0; a < 3; ++a) {
      inverse[a] = all(ray.inverse[a]), near[a] = all(ray.near[a]), far[a] = all(ray.far[a]);
    }
  }

  template <class Tag>
  HWY_INLINE hn::Vec<Tag> order(Tag tag, const WideNode& node) const {
    return hn::TableLookupBytes(hn::Load(tag, node.order[places.order_row]), hn::Load(tag, places.turn));
  }
};

/// Where the ray enters and leaves the boxes from the i-th on.
HWY_INLINE void intersect_boxes(const WideNode& node, const SpreadRay& ray, std::size_t i, V t_max, V& near,
                                V& far) {
  const char* bounds = reinterpret_cast<const char*>(node.bounds) + i * sizeof(float);
  const auto at = [&](std::size_t row, V inverse, V constant) {
    return hn::MulAdd(hn::Load(f, reinterpret_cast<const float*>(bounds + row)), inverse, constant);
  };
  near = hn::Max(hn::Max(at(ray.places.near_row[0], ray.inverse[0], ray.near[0]),
                         at(ray.places.near_row[1], ray.inverse[1], ray.near[1])),
                 hn::Max(at(ray.places.near_row[2], ray.inverse[2], ray.near[2]), ray.t_min));
  far = hn::Min(hn::Min(at(ray.places.far_row[0], ray.inverse[0], ray.far[0]),
                        at(ray.places.far_row[1], ray.inverse[1], ray.far[1])),
                hn::Min(at(ray.places.far_row[2], ray.inverse[2], ray.far[2]), t_max));
}

/// Children by bits, as they stand in the node; the last on top.
HWY_INLINE void push_unsorted(const WideNode& node, unsigned bits, Stack& stack, std::size_t& size) {
  if constexpr (lanes == node_lanes) {
    std::uint8_t hit_bits[8] = {};
    std::memcpy(hit_bits, &bits, sizeof bits);
    hn::StoreU(hn::Compress(hn::Load(ids, node.child), hn::LoadMaskBits(ids, hit_bits)), ids,
               stack.child + size);
    size += static_cast<std::size_t>(std::popcount(bits));
  } else {
    for (; bits != 0; bits &= bits - 1) stack.child[size++] = node.child[std::countr_zero(bits)];
  }
}

/// The children of a node whose boxes the ray may intersect, by bits; where vectors hold a whole node.
template <Order order, bool whole = lanes == node_lanes>
struct IntersectedChildren {
  V near, far;
  unsigned bits;
  HWY_INLINE IntersectedChildren(const WideNode& node, const SpreadRay& ray, float t_max) {
    intersect_boxes(node, ray, 0, all(t_max), near, far);
    bits = mask_bits(f, hn::Le(near, far));
  }

  /// All onto the stack, the next one on top.
  HWY_INLINE void push(const WideNode& node, const SpreadRay& ray, Stack& stack, std::size_t& size) const {
    if constexpr (order == Order::any)
      push_unsorted(node, bits, stack, size);
    else if (bits != 0)
      Sorted(*this, node, ray).push(stack, size, 0);
  }
  /// Takes the next child off into `next`; false: there is none.
  HWY_INLINE bool take(const WideNode& node, const SpreadRay& ray, Stack& stack, std::size_t& size,
                       std::uint32_t& next) const {
    if (bits == 0) return false;
    if (order == Order::any || (bits & (bits - 1)) == 0) {
      next = node.child[std::countr_zero(bits)];
      push_unsorted(node, bits & (bits - 1), stack, size);
      return true;
    }
    const Sorted sorted(*this, node, ray);
    next = hn::GetLane(sorted.child);
    sorted.push(stack, size, 1);
    return true;
  }

 private:
  /// Nearest first.
  struct Sorted {
    hn::Vec<U> child;
    V near;
    std::uint32_t count;
    HWY_INLINE Sorted(const IntersectedChildren& hit, const WideNode& node, const SpreadRay& ray)
        : count(static_cast<std::uint32_t>(std::popcount(hit.bits))) {
      const auto places = hn::PromoteTo(ids, ray.order(hn::Rebind<std::uint8_t, F>(), node));
      const auto in_order = [&](V v) { return hn::TableLookupLanes(v, hn::IndicesFromVec(f, places)); };
      const V entered = in_order(hit.near);
      const M is_hit = hn::Le(entered, in_order(hit.far));
      child = hn::Compress(hn::TableLookupLanes(hn::Load(ids, node.child), hn::IndicesFromVec(ids, places)),
                           hn::RebindMask(ids, is_hit));
      near = hn::Compress(entered, is_hit);
    }
    /// The last first; without the first `but`.
    HWY_INLINE void push(Stack& stack, std::size_t& size, std::uint32_t but) const {
      const auto back =
          hn::And(hn::Sub(hn::Set(ids, count - 1), hn::Iota(ids, 0)), hn::Set(ids, node_lanes - 1));
      hn::StoreU(hn::TableLookupLanes(child, hn::IndicesFromVec(ids, back)), ids, stack.child + size);
      hn::StoreU(hn::TableLookupLanes(near, hn::IndicesFromVec(f, back)), f, stack.near + size);
      size += count - but;
    }
  };
};

/// Where they do not.
template <Order order>
struct IntersectedChildren<order, false> {
  alignas(64) float near[node_lanes];
  unsigned bits = 0;
  HWY_INLINE IntersectedChildren(const WideNode& node, const SpreadRay& ray, float t_max) {
    for (std::size_t i = 0; i < node_lanes; i += lanes) {
      V in, out;
      intersect_boxes(node, ray, i, all(t_max), in, out);
      hn::Store(in, f, near + i);
      bits |= mask_bits(f, hn::Le(in, out)) << i;
    }
  }

  HWY_INLINE void push(const WideNode& node, const SpreadRay& ray, Stack& stack, std::size_t& size) const {
    if constexpr (order == Order::any)
      push_unsorted(node, bits, stack, size);
    else if (bits != 0)
      Sorted(*this, node, ray).push(stack, size);
  }
  HWY_INLINE bool take(const WideNode& node, const SpreadRay& ray, Stack& stack, std::size_t& size,
                       std::uint32_t& next) const {
    if (bits == 0) return false;
    if (order == Order::any || (bits & (bits - 1)) == 0) {
      next = node.child[std::countr_zero(bits)];
      push_unsorted(node, bits & (bits - 1), stack, size);
      return true;
    }
    Sorted sorted(*this, node, ray);
    next = sorted.pop_nearest();
    sorted.push(stack, size);
    return true;
  }

 private:
  /// Farthest first: bit i of `left` is for the child `place[i]`.
  struct Sorted {
    const IntersectedChildren& hit;
    const WideNode& node;
    alignas(16) std::uint8_t place[node_lanes];
    unsigned left = 0;
    HWY_INLINE Sorted(const IntersectedChildren& intersected, const WideNode& of, const SpreadRay& ray)
        : hit(intersected), node(of) {
      if constexpr (hn::MaxLanes(byte_lanes) == node_lanes) {
        const auto places = ray.order(byte_lanes, node);
        std::uint8_t hit_bits[8] = {};
        std::memcpy(hit_bits, &hit.bits, sizeof hit.bits);
        const auto is_hit = hn::VecFromMask(byte_lanes, hn::LoadMaskBits(byte_lanes, hit_bits));
        left = mask_bits(byte_lanes, hn::MaskFromVec(hn::TableLookupBytes(is_hit, places)));
        hn::Store(places, byte_lanes, place);
      } else {
        for (std::size_t i = 0; i < node_lanes; ++i) {
          place[i] = node.order[ray.places.order_row][ray.places.turn[i]];
          left |= (hit.bits >> place[i] & 1u) << i;
        }
      }
    }
    HWY_INLINE std::uint32_t pop_nearest() {
      const unsigned nearest = std::bit_floor(left);
      left ^= nearest;
      return node.child[place[std::countr_zero(nearest)]];
    }
    HWY_INLINE void push(Stack& stack, std::size_t& size) const {
      for (unsigned rest = left; rest != 0; rest &= rest - 1, ++size) {
        const std::size_t lane = place[std::countr_zero(rest)];
        stack.child[size] = node.child[lane], stack.near[size] = hit.near[lane];
      }
    }
  };
};

/// The children of a node, as above, over those of one that comes after it. Together, for a ray that waits
/// for memory and for one step after the other; and a ray that intersects nothing visits both anyhow.
template <Order order>
HWY_INLINE bool visit_children_of_two(const WideNode& node, const WideNode& after, const SpreadRay& ray,
                                      float t_max, Stack& stack, std::size_t& size, std::uint32_t& next) {
  const IntersectedChildren<order> hit(node, ray, t_max), hit_after(after, ray, t_max);
  hit_after.push(after, ray, stack, size);
  return hit.take(node, ray, stack, size, next);
}

}  // namespace
}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target guard
