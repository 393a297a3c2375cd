#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raytrace/packet/prepare.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <cstddef>
#include <cstring>

#include "raytrace/packet/prepare.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
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

void primary_kernel(const View& view, int x0, int y0, TileRays& rays) {
  alignas(64) double sx[16], sy[16];
  for (int i = 0; i < 16; ++i) {
    sx[i] = (2.0 * (x0 + i + 0.5) / view.size.width - 1.0) * view.tan_half_x;
    sy[i] = (1.0 - 2.0 * (y0 + i + 0.5) / view.size.height) * view.tan_half_y;
  }
  alignas(64) double px[packet_rays], py[packet_rays];
  for (std::size_t p = 0; p < tile_packets; ++p) {
    for (std::size_t i = 0; i < packet_rays; ++i)
      px[i] = sx[4 * (p % 4) + i % 4], py[i] = sy[4 * (p / 4) + i / 4];
    unsigned alive = 0;
    for (std::size_t i = 0; i < packet_rays; i += hn::Lanes(d)) {
      const V x = hn::Load(d, px + i), y = hn::Load(d, py + i);
      V direction[3], out[3];
      for (int a = 0; a < 3; ++a)
        direction[a] =
            hn::MulAdd(y, all(view.up[a]), hn::MulAdd(x, all(view.right[a]), all(view.forward[a])));
      alive |= bits_of(project(direction, rays, 0.0, out)) << i;
      store(out[0], rays.u + p * packet_rays + i), store(out[1], rays.v + p * packet_rays + i);
    }
    rays.alive[p] = static_cast<std::uint16_t>(alive);
  }
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

void shadow_kernel(const Light& light, const Seen& seen, const SurfacePoint* receivers, std::size_t stride,
                   TileRays& rays, ShadowLanes& lanes) {
  const Receivers gather(receivers, stride);
  const bool directional = light.type == LightType::directional;
  for (std::size_t p = 0; p < tile_packets; ++p) {
    const SurfacePoint* packet = receivers + (p / 4 * 4) * stride + p % 4 * 4;
    unsigned present = 0, reached = 0, usable = 0;
    for (std::size_t i = 0; i < packet_rays; ++i) {
      const std::uint32_t primitive = packet[i / 4 * stride + i % 4].primitive;
      rays.own[p * packet_rays + i] = primitive;
      present |= static_cast<unsigned>(primitive != no_id) << i;
    }
    for (std::size_t i = 0; i < packet_rays && present != 0; i += hn::Lanes(d)) {
      V position[3], normal[3], offset[3], out[3];
      for (int a = 0; a < 3; ++a) {
        position[a] = gather.component(packet, i, offsetof(SurfacePoint, position), a);
        normal[a] = gather.component(packet, i, offsetof(SurfacePoint, normal), a);
        offset[a] = hn::Sub(position[a], all(seen.origin[a]));
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
        for (int a = 0; a < 3; ++a) out[a] = dot(offset, seen.axes[a]);
        fits = hn::And(hn::Lt(hn::Max(hn::Abs(out[0]), hn::Abs(out[1])), all(seen.lateral)),
                       hn::Lt(hn::Abs(out[2]), all(8.0 * seen.lateral)));
      } else {
        fits = project(offset, rays, 0x1p-30 * seen.reach, out);
      }
      const V largest = hn::Max(hn::Abs(position[0]), hn::Max(hn::Abs(position[1]), hn::Abs(position[2])));
      usable |= bits_of(hn::And(fits, hn::Lt(largest, all(seen.reach)))) << i;
      const std::size_t at = p * packet_rays + i;
      store(out[0], rays.u + at), store(out[1], rays.v + at), store(out[2], rays.far + at);
    }
    rays.alive[p] = static_cast<std::uint16_t>(present & reached & usable);
    lanes.apart[p] = static_cast<std::uint16_t>(present & reached & ~usable);
    lanes.unreached[p] = static_cast<std::uint16_t>(present & ~reached);
  }
}

}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon::raytrace {
HWY_EXPORT(primary_kernel);
HWY_EXPORT(shadow_kernel);

void prepare_primary(const View& view, int x0, int y0, TileRays& rays) {
  HWY_DYNAMIC_DISPATCH(primary_kernel)(view, x0, y0, rays);
}
void prepare_shadows(const Light& light, const Seen& seen, const SurfacePoint* receivers, std::size_t stride,
                     TileRays& rays, ShadowLanes& lanes) {
  HWY_DYNAMIC_DISPATCH(shadow_kernel)(light, seen, receivers, stride, rays, lanes);
}

}  // namespace gnomon::raytrace
#endif  // HWY_ONCE
