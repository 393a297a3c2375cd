// A block of raytrace/packets/view_block.h on the plane at distance one: its rays, its packets, and which of
// them a box may cover.

#if defined(GNOMON_RAYTRACE_PACKETS_BLOCK_PLANE_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)  // once per instruction set: Highway's own pattern
#ifdef GNOMON_RAYTRACE_PACKETS_BLOCK_PLANE_INL_H_
#undef GNOMON_RAYTRACE_PACKETS_BLOCK_PLANE_INL_H_
#else
#define GNOMON_RAYTRACE_PACKETS_BLOCK_PLANE_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>

#include "raytrace/packets/block_traverse-inl.h"
#include "raytrace/packets/lanes-inl.h"
#include "raytrace/packets/packet_grid.h"
#include "raytrace/packets/view_block.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raytrace::HWY_NAMESPACE {
constexpr std::size_t block_side = std::size_t{4} * block_tiles;  // packets
constexpr std::size_t block_packets = block_side * block_side, block_rays = block_packets * packet_rays;

/// A packet's place in BlockHits.
constexpr std::size_t packet_at(std::size_t x, std::size_t y) {
  return ((y / 4 * block_tiles + x / 4) * tile_packets) + y % 4 * 4 + x % 4;
}

/// Packets of the whole picture by columns and rows, both ends included.
struct PacketRect {
  int x0, y0, x1, y1;
};

/// Packets that a box may cover, and how near it comes.
struct BoxPlace {
  PacketRect covered;
  float nearest;
};

class alignas(64) BlockPlane {
 public:
  float u[block_side][packet_rays], v[block_side][packet_rays];  ///< of a column's packets, of a row's
  float u_min, u_max, v_min, v_max;
  PacketAxis columns, rows;  ///< of the whole picture's packets
  PacketRect packets;        ///< the block's

  BlockPlane(const Structures& s, const EdgeSetup& setup, const View& view, const BlockRect& rect)
      : packets{rect.x0 / 4, rect.y0 / 4, (rect.x1 - 1) / 4, (rect.y1 - 1) / 4}, projection_(s, setup) {
    const auto at = [](int pixel, int size, double tan_half) {
      return static_cast<float>((2.0 * (pixel + 0.5) / size - 1.0) * tan_half);
    };
    for (std::size_t packet = 0; packet < block_side; ++packet)
      for (std::size_t k = 0; k < 4; ++k) {
        const int pixel = static_cast<int>(4 * packet + k);
        const float x = at(rect.x0 + pixel, view.size.width, view.tan_half_x);
        const float y = at(rect.y0 + pixel, view.size.height, view.tan_half_y);
        for (std::size_t i = 0; i < 4; ++i) u[packet][4 * i + k] = x, v[packet][4 * k + i] = y;
      }
    u_min = u[0][0], u_max = at(rect.x1 - 1, view.size.width, view.tan_half_x);
    v_min = v[0][0], v_max = at(rect.y1 - 1, view.size.height, view.tan_half_y);
    const auto axis = [](double tan_half, int pixels) {
      const double width = 2.0 * tan_half / pixels, first = 0.5 * width - tan_half;
      return PacketAxis{first, width, pixels};
    };
    columns = axis(view.tan_half_x, view.size.width), rows = axis(view.tan_half_y, view.size.height);
  }

  const Projection& projection() const { return projection_; }

  /// Conservative. A box that is not clear of the eye may cover everything.
  BoxPlace packets_of(const BoxRef& box) const {
    const PrimitiveBounds bounds = projection_.of(box);
    if (bounds.nearest == inf) return {packets, inf};
    const auto range = [&](float low, float high, const PacketAxis& axis, int first, int last, int& begin,
                           int& end) {
      const float start = static_cast<float>(axis.first), per = static_cast<float>(0.25 / axis.width);
      const float most = static_cast<float>(last);
      begin = std::max(first, static_cast<int>(std::min(std::max((low - start) * per, 0.0f), most + 1.0f)));
      end = std::min(last, static_cast<int>(std::min(std::max((high - start) * per, -1.0f), most)));
    };
    PacketRect covered;
    range(bounds.u_min, bounds.u_max, columns, packets.x0, packets.x1, covered.x0, covered.x1);
    range(bounds.v_min, bounds.v_max, rows, packets.y0, packets.y1, covered.y0, covered.y1);
    return {covered, bounds.nearest};
  }

 private:
  Projection projection_;
};

}  // namespace gnomon::raytrace::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // per-target guard
