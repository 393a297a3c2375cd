#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/packets/prepare.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <cstddef>
#include <cstring>

#include "raytrace/packets/prepare.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, 8>;
using Half = hn::Rebind<float, D>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;
constexpr D d;
constexpr Half half;

inline V all(double v) {
  return hn::Set(d, v);
}
inline unsigned bits_of(M mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  return bytes[0];
}
/// The order of operations of glm::dot, which decides the same sign.
inline V dot(const V (&a)[3], const Vec3& b) {
  return hn::Add(hn::Add(hn::Mul(a[0], all(b.x)), hn::Mul(a[1], all(b.y))), hn::Mul(a[2], all(b.z)));
}

inline void store(V v, float* at) {
  hn::Store(hn::DemoteTo(half, v), half, at);
}

/// Eight receivers of a quantised tile as seen from the light.
class QuantisedRays {
 public:
  QuantisedRays(const Light& light, const EdgeSetup& setup, const QuantisedTile& tile)
      : tile_(tile), directional_(light.type == LightType::directional), light_(light) {
    for (int a = 0; a < 3; ++a) axes_[a] = setup.axes[a];
    from_light_ = tile.origin - setup.origin;
    // A direction's heights are rounded to floats as well, so that less of their bound is left.
    lateral_ = setup.lateral, height_ = std::min(setup.height, 4.0 * setup.lateral);
    // A component's error moves (u, v) by 1.13 * 2^-24 sqrt(3) extent / depth (1 + |slope|), which is to stay
    // well below what the bounds of raytrace/packets/edge_setup_kernel.cpp leave beside the tests' own
    // rounding: extent <= 0.45 depth.
    least_depth_ = std::max(2.25 * tile.extent, 0x1p-30 * setup.reach);
  }

  void at(std::size_t lane) {
    for (int a = 0; a < 3; ++a) {
      const auto i = static_cast<std::size_t>(a);
      offset_[a] = hn::Add(hn::PromoteTo(d, hn::Load(half, tile_.position[i] + lane)), all(from_light_[a]));
      normal_[a] = hn::PromoteTo(d, hn::Load(half, tile_.normal[i] + lane));
    }
  }

  /// Bits of those that surely face the light, and of those that may.
  void facing(unsigned& surely, unsigned& perhaps) const {
    V cosine, size;
    if (directional_) {
      cosine = dot(normal_, -light_.direction), size = all(glm::dot(glm::abs(light_.direction), Vec3(1.0)));
    } else {
      cosine = hn::Neg(hn::MulAdd(normal_[0], offset_[0],
                                  hn::MulAdd(normal_[1], offset_[1], hn::Mul(normal_[2], offset_[2]))));
      size = hn::Add(hn::Add(hn::Abs(offset_[0]), hn::Abs(offset_[1])),
                     hn::Add(hn::Abs(offset_[2]), all(2.0 * tile_.extent)));
    }
    const V error = hn::Mul(all(0x1p-22), size);  // the roundings of the normal and of the position to floats
    surely = bits_of(hn::Gt(cosine, error));
    perhaps = bits_of(hn::Not(hn::Lt(cosine, hn::Neg(error))));
  }

  /// Stores the rays; bits of those in range.
  unsigned project_to(std::size_t lane, TileRays& rays) const {
    V out[3];
    for (int a = 0; a < 3; ++a)
      out[a] = hn::MulAdd(offset_[0], all(axes_[a].x),
                          hn::MulAdd(offset_[1], all(axes_[a].y), hn::Mul(offset_[2], all(axes_[a].z))));
    M fits;
    if (directional_) {
      fits = hn::And(hn::Lt(hn::Max(hn::Abs(out[0]), hn::Abs(out[1])), all(lateral_)),
                     hn::Lt(hn::Abs(out[2]), all(height_)));
    } else {
      const V inverse = hn::Div(all(1.0), out[2]);
      fits = hn::Gt(out[2], all(least_depth_));
      out[0] = hn::Mul(out[0], inverse), out[1] = hn::Mul(out[1], inverse), out[2] = inverse;
      fits = hn::And(fits, hn::Lt(hn::Max(hn::Abs(out[0]), hn::Abs(out[1])), all(widest_slope)));
    }
    store(out[0], rays.u + lane), store(out[1], rays.v + lane), store(out[2], rays.far + lane);
    return bits_of(fits);
  }

 private:
  const QuantisedTile& tile_;
  bool directional_;
  const Light& light_;
  Vec3 axes_[3], from_light_;
  double lateral_, height_, least_depth_;
  V offset_[3], normal_[3];
};

void quantised_kernel(const Light& light, const EdgeSetup& setup, const QuantisedTile& tile,
                      const LaneMask& asked, TileRays& rays, ShadowLanes& lanes) {
  QuantisedRays some(light, setup, tile);
  for (std::size_t p = 0; p < tile_packets; ++p) {
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
                       const LaneMask& asked, TileRays& rays, ShadowLanes& lanes) {
  HWY_DYNAMIC_DISPATCH(quantised_kernel)(light, setup, tile, asked, rays, lanes);
}

}  // namespace gnomon::raytrace
#endif  // HWY_ONCE
