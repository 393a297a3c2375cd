// The world as seen from one point (the eye, a light) or along one direction (a sun). A leaf primitive has
// float numbers for it. By these 16 rays at once are told *surely hit*, *surely missed* or *ambiguous* with a
// handful of fused operations. Rays through a common origin are points d = (u, v, 1) of a projective plane
// across their frame. Rays along a common direction are points (u, v, 1) of the plane across it. In both
// cases a triangle is three edge functions n_k·d and one depth function m·d. Every error, of the floats and
// of the double kernels alike, enters the bounds, so that what is sure here is what the double kernels say.
#pragma once

#include <cstdint>
#include <vector>

#include "raytrace/kernels.h"

namespace gnomon::raytrace {

/// reciprocal depth(d) = m·d grows towards the common origin: 1/depth for a point, the height towards a
/// direction's light.
struct alignas(64) PrimitiveEdges {
  float edge[3][3];           ///< n_k: all three are >= 0 inside; unit length across the ray
  float reciprocal_depth[3];  ///< m
  float edge_error;   ///< all edge functions above it: surely inside; one below minus it: surely outside
  float depth_error;  ///< of the reciprocal depth, the double kernels' own error included
  float depth_floor;  ///< a reciprocal depth at or below it says nothing; -infinity: all do
  std::uint32_t id;   ///< of the primitive
};
static_assert(sizeof(PrimitiveEdges) == 64);

/// The primitives' float numbers are void: its rays go to the double kernels (spheres, masked planes, ...).
inline constexpr std::uint32_t never_sure = 0x80000000u;

struct EdgeSetup {
  std::vector<PrimitiveEdges> planes;  ///< of Structures::planes; their edge functions are not used
  bool directional = false;
  Vec3 origin{0.0};      ///< the common origin; of a direction: the middle of the world
  Vec3 axes[3];          ///< of u, v and depth, orthonormal
  double reach = 0.0;    ///< receivers with a coordinate beyond it are left to the double kernels
  double lateral = 0.0;  ///< of a direction: so are those with |u| or |v| beyond it,
  double height = 0.0;   ///< or with the third coordinate beyond this
  double slack = 0.0;    ///< world units by which boxes are widened against rounding
};

/// What says which packets a primitive may concern. It is a box of (u, v) that holds all rays that do not surely
/// miss it, and a reciprocal depth that is not surely behind none of them.
struct PrimitiveBounds {
  float u_min, u_max, v_min, v_max;  ///< infinite: not known; min above max: no ray
  float nearest;
};

/// Point receivers may lie anywhere within EdgeSetup::reach of the coordinates' origin; `receivers`: whether there
/// are any (shadow rays) or the rays start at the point itself (primary rays). `right` and `depth` are unit and
/// perpendicular.
EdgeSetup edge_setup_from(const Structures& structures, const Vec3& origin, bool receivers, const Vec3& right,
                          const Vec3& depth);
/// `to_light`: any length above zero.
EdgeSetup edge_setup_along(const Structures& structures, const Vec3& to_light);

/// The instruction set in use, as Highway names it.
const char* packet_target();

}  // namespace gnomon::raytrace
