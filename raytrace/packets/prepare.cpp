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
using Index = hn::RebindToSigned<D>;
using HalfIndex = hn::Rebind<std::int32_t, D>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;
constexpr D d;
constexpr Half half;
constexpr Index index;
[[maybe_unused]] constexpr HalfIndex half_index;

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

/// Offsets from a point as (u, v, 1 / depth); the mask says which are in range.
inline M project(const V (&offset)[3], const TileRays& rays, double least_depth, V (&out)[3]) {
  const auto k = static_cast<std::size_t>(rays.axis);
  const V depth = hn::Mul(offset[k], all(static_cast<double>(rays.sign)));
  out[2] = hn::Div(all(1.0), depth);
  out[0] = hn::Mul(offset[(k + 1) % 3], out[2]), out[1] = hn::Mul(offset[(k + 2) % 3], out[2]);
  const V slope = hn::Max(hn::Abs(out[0]), hn::Abs(out[1]));
  return hn::And(hn::Gt(depth, all(least_depth)), hn::Lt(slope, all(widest_slope)));
}

inline void store(V v, float* at) {
  hn::Store(hn::DemoteTo(half, v), half, at);
}

/// Fields of eight receivers, gathered.
class Receivers {
 public:
  Receivers(const SurfacePoint* first, std::size_t stride) {
    static_assert(sizeof(SurfacePoint) % sizeof(double) == 0);
    constexpr std::size_t step = sizeof(SurfacePoint) / sizeof(double);
    (void)first;
    for (std::size_t i = 0; i < packet_rays; ++i)
      offsets_[i] = static_cast<std::int64_t>((i / 4 * stride + i % 4) * step);
  }
  /// Component `at` (in doubles from the record's start) of places i … of the packet that starts at `packet`.
  V number(const SurfacePoint* packet, std::size_t i, std::size_t at) const {
    return hn::GatherIndex(d, reinterpret_cast<const double*>(packet) + at, hn::Load(index, offsets_ + i));
  }
  V component(const SurfacePoint* packet, std::size_t i, std::size_t byte_offset, int axis) const {
    return number(packet, i, byte_offset / sizeof(double) + static_cast<std::size_t>(axis));
  }

 private:
  alignas(64) std::int64_t offsets_[packet_rays];
};

void shadow_kernel(const Light& light, const EdgeSetup& setup, const SurfacePoint* receivers,
                   std::size_t stride, TileRays& rays, ShadowLanes& lanes) {
  const Receivers gather(receivers, stride);
  const bool directional = light.type == LightType::directional;
  for (std::size_t p = 0; p < tile_packets; ++p) {
    const SurfacePoint* packet = receivers + (p / 4 * 4) * stride + p % 4 * 4;
    unsigned present = 0, reached = 0, usable = 0;
    for (std::size_t i = 0; i < packet_rays; ++i) {
      const std::uint32_t primitive = packet[i / 4 * stride + i % 4].primitive;
      rays.source[p * packet_rays + i] = primitive;
      present |= static_cast<unsigned>(primitive != no_id) << i;
    }
    for (std::size_t i = 0; i < packet_rays && present != 0; i += hn::Lanes(d)) {
      V position[3], normal[3], offset[3], out[3];
      for (int a = 0; a < 3; ++a) {
        position[a] = gather.component(packet, i, offsetof(SurfacePoint, position), a);
        normal[a] = gather.component(packet, i, offsetof(SurfacePoint, normal), a);
        offset[a] = hn::Sub(position[a], all(setup.origin[a]));
      }
      V cosine;
      if (directional) {
        cosine = dot(normal, -light.direction);
      } else {
        V to_light[3];
        for (int a = 0; a < 3; ++a)
          to_light[a] = hn::Mul(normal[a], hn::Sub(all(light.position[a]), position[a]));
        cosine = hn::Add(hn::Add(to_light[0], to_light[1]), to_light[2]);
      }
      reached |= bits_of(hn::Gt(cosine, all(0.0))) << i;
      M fits;
      if (directional) {
        for (int a = 0; a < 3; ++a) out[a] = dot(offset, setup.axes[a]);
        fits = hn::And(hn::Lt(hn::Max(hn::Abs(out[0]), hn::Abs(out[1])), all(setup.lateral)),
                       hn::Lt(hn::Abs(out[2]), all(setup.height)));
      } else {
        fits = project(offset, rays, 0x1p-30 * setup.reach, out);
      }
      const V largest = hn::Max(hn::Abs(position[0]), hn::Max(hn::Abs(position[1]), hn::Abs(position[2])));
      usable |= bits_of(hn::And(fits, hn::Lt(largest, all(setup.reach)))) << i;
      const std::size_t at = p * packet_rays + i;
      store(out[0], rays.u + at), store(out[1], rays.v + at), store(out[2], rays.far + at);
    }
    rays.alive[p] = static_cast<std::uint16_t>(present & reached & usable);
    lanes.apart[p] = static_cast<std::uint16_t>(present & reached & ~usable);
    lanes.unreached[p] = static_cast<std::uint16_t>(present & ~reached);
    lanes.grazing[p] = 0;
  }
}

/// Eight receivers of a quantised tile as seen from the light.
class QuantisedRays {
 public:
  QuantisedRays(const Light& light, const EdgeSetup& setup, const QuantisedTile& tile, const TileRays& rays)
      : tile_(tile), directional_(light.type == LightType::directional), light_(light) {
    const auto k = static_cast<std::size_t>(directional_ || setup.framed ? 2 : rays.axis);
    axes_[0] = setup.axes[(k + 1) % 3], axes_[1] = setup.axes[(k + 2) % 3];
    axes_[2] = static_cast<double>(directional_ ? 1.0f : rays.sign) * setup.axes[k];
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
  QuantisedRays some(light, setup, tile, rays);
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
HWY_EXPORT(shadow_kernel);
HWY_EXPORT(quantised_kernel);

void prepare_quantised(const Light& light, const EdgeSetup& setup, const QuantisedTile& tile,
                       const LaneMask& asked, TileRays& rays, ShadowLanes& lanes) {
  HWY_DYNAMIC_DISPATCH(quantised_kernel)(light, setup, tile, asked, rays, lanes);
}
void prepare_shadows(const Light& light, const EdgeSetup& setup, const SurfacePoint* receivers,
                     std::size_t stride, TileRays& rays, ShadowLanes& lanes) {
  HWY_DYNAMIC_DISPATCH(shadow_kernel)(light, setup, receivers, stride, rays, lanes);
}

}  // namespace gnomon::raytrace
#endif  // HWY_ONCE
