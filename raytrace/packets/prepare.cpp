#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/packets/prepare.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <cstddef>
#include <cstring>

#include "raytrace/packets/double_lanes-inl.h"
#include "raytrace/packets/shadow_block.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
namespace {
using namespace doubles;
using Half = hn::Rebind<float, D>;
constexpr Half half;

inline V load(const float* at) {
  return hn::PromoteTo(d, hn::Load(half, at));
}
inline V load(const std::int16_t* at) {
  constexpr hn::Rebind<std::int32_t, D> whole;
  return hn::PromoteTo(d, hn::PromoteTo(whole, hn::Load(Units(), at)));
}
inline void store(V v, float* at) {
  hn::Store(hn::DemoteTo(half, v), half, at);
}

/// Eight receivers of a quantised tile as seen from the light.
class QuantisedRays {
 public:
  QuantisedRays(const Light& light, const EdgeSetup& setup, const QuantisedTile& tile)
      : tile_(tile), directional_(light.type == LightType::directional), light_(light) {
    for (std::size_t k = 0; k < 3; ++k) axes_[k] = all(setup.axes[k]);
    from_light_ = all(tile.origin - setup.origin);
    // A direction's heights are rounded to floats as well, so that less of their bound is left.
    lateral_ = setup.lateral, height_ = std::min(setup.height, 4.0 * setup.lateral);
    // A component's error moves (u, v) by 1.13 * 2^-24 sqrt(3) extent / depth (1 + |slope|). That is to stay
    // well below what the bounds of raytrace/packets/edge_setup_kernel.cpp leave beside the tests' own
    // rounding: extent <= 0.45 depth.
    least_depth_ = std::max(2.25 * tile.extent, 0x1p-30 * setup.reach);
  }

  void at(std::size_t lane) {
    const auto at = [lane](const auto(&rows)[3][tile_rays]) {
      return V3{load(rows[0] + lane), load(rows[1] + lane), load(rows[2] + lane)};
    };
    offset_ = plus(at(tile_.position), from_light_), normal_ = at(tile_.normal);
  }

  /// Bits of those that surely face the light, and of those that may.
  void facing(unsigned& surely, unsigned& perhaps) const {
    V cosine, size;
    if (directional_) {
      cosine = dot(normal_, all(-light_.direction));
      size = all(glm::dot(glm::abs(light_.direction), Vec3(1.0)));
    } else {
      cosine = hn::Neg(fused_dot(normal_, offset_));
      const V3 distance = size_of(offset_);
      size = hn::Add(hn::Add(distance.x, distance.y), hn::Add(distance.z, all(2.0 * tile_.extent)));
    }
    const V error = hn::Mul(all(normal_error), size);
    surely = bits_of(hn::Gt(cosine, error));
    perhaps = bits_of(hn::Not(hn::Lt(cosine, hn::Neg(error))));
  }

  /// Stores the rays; bits of those in range.
  unsigned project_to(std::size_t lane, TileRays& rays) const {
    V u = fused_dot(offset_, axes_[0]), v = fused_dot(offset_, axes_[1]), far = fused_dot(offset_, axes_[2]);
    const auto widest = [&] { return hn::Max(hn::Abs(u), hn::Abs(v)); };
    M fits;
    if (directional_) {
      fits = hn::And(hn::Lt(widest(), all(lateral_)), hn::Lt(hn::Abs(far), all(height_)));
    } else {
      fits = hn::Gt(far, all(least_depth_));
      far = hn::Div(all(1.0), far), u = hn::Mul(u, far), v = hn::Mul(v, far);
      fits = hn::And(fits, hn::Lt(widest(), all(widest_slope)));
    }
    store(u, rays.u + lane), store(v, rays.v + lane), store(far, rays.far + lane);
    return bits_of(fits);
  }

 private:
  const QuantisedTile& tile_;
  bool directional_;
  const Light& light_;
  V3 axes_[3], from_light_;
  double lateral_, height_, least_depth_;
  V3 offset_, normal_;  ///< the normal in units
};

void quantised_kernel(const Light& light, const EdgeSetup& setup, const QuantisedTile& tile,
                      const QuantisedTile* next, const LaneMask& asked, TileRays& rays, ShadowLanes& lanes) {
  QuantisedRays some(light, setup, tile);
  for (std::size_t p = 0; p < tile_packets; ++p) {
    if (next != nullptr) prefetch(*next, p);
    unsigned reached = 0, perhaps = 0, usable = 0;
    const unsigned present = tile.present[p] & asked[p];
    for (std::size_t i = 0; i < packet_rays && present != 0; i += hn::Lanes(d)) {
      const std::size_t lane = p * packet_rays + i;
      some.at(lane);
      unsigned surely_faces = 0, may_face = 0;
      some.facing(surely_faces, may_face);
      reached |= surely_faces << i, perhaps |= may_face << i;
      usable |= some.project_to(lane, rays) << i;
    }
    std::memcpy(rays.source + p * packet_rays, tile.source + p * packet_rays,
                packet_rays * sizeof tile.source[0]);
    rays.alive[p] = static_cast<std::uint16_t>(present & perhaps & usable);
    lanes.apart[p] = static_cast<std::uint16_t>(present & perhaps & ~usable);
    lanes.unreached[p] = static_cast<std::uint16_t>(present & ~perhaps);
    lanes.grazing[p] = static_cast<std::uint16_t>(present & perhaps & ~reached);
  }
}

}  // namespace
}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon::raytrace {
HWY_EXPORT(quantised_kernel);

void prepare_quantised(const Light& light, const EdgeSetup& setup, const QuantisedTile& tile,
                       const QuantisedTile* next, const LaneMask& asked, TileRays& rays, ShadowLanes& lanes) {
  HWY_DYNAMIC_DISPATCH(quantised_kernel)(light, setup, tile, next, asked, rays, lanes);
}

}  // namespace gnomon::raytrace
#endif  // HWY_ONCE
