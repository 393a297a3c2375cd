#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "hybrid/classify.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <bit>

#include "hybrid/light_sheets.h"
#include "raytrace/mask_bits-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::hybrid::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;
using F = hn::CappedTag<float, raytrace::packet_rays>;
using I = hn::RebindToSigned<F>;
using V = hn::Vec<F>;
using Index = hn::Vec<I>;
using M = hn::Mask<F>;
constexpr F f;
constexpr I index;
constexpr hn::RebindToUnsigned<F> ids;
using raytrace::packet_rays;
using raytrace::QuantisedTile;

inline unsigned bits_of(M mask) {
  return raytrace::HWY_NAMESPACE::mask_bits(f, mask);
}
inline V all(double v) {
  return hn::Set(f, static_cast<float>(v));
}
inline double sum_of_magnitudes(const Vec3& v) {
  return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

/// A linear function of a receiver's place in its picture tile, in floats. Its error, of the receiver's own
/// rounding too, is below `rounding` times `size`.
struct Local {
  V x, y, z;
  double size;  // no value is larger
  Local(const Vec3& n, double extent)
      : x(all(n.x)), y(all(n.y)), z(all(n.z)), size(sum_of_magnitudes(n) * extent) {}
  V at(const V (&p)[3]) const { return hn::MulAdd(x, p[0], hn::MulAdd(y, p[1], hn::Mul(z, p[2]))); }
};
/// Bounds the rounding of the coefficient, the position (1.13, raytrace/quantised_tile.h) and three operations: 2^-24 each.
constexpr double rounding = 6.0 * 0x1p-24;

/// The sheets as one picture tile looks at them. Everything counts from the tile's origin, where it is known
/// in double: texels from its texel, reciprocal depth from its reciprocal depth. On a perspective map a texel
/// coordinate is a quotient U / w; less its value c at the origin it is (U - c w) / w, small over small again.
class Classifier {
 public:
  Classifier(const LightSheets& sheets, const Light& light, const QuantisedTile& tile)
      : sheets_(sheets),
        grid_(sheets.grid()),
        tile_(tile),
        directional_(light.type == LightType::directional),
        light_direction_(light.direction),
        from_light_(tile.origin - light.position),
        perspective_(grid_.perspective),
        face_(face_of(grid_, tile)),
        tile_texels_(sheets.is_built() ? sheets.texels_from(grid_.tile_index(face_, 0, 0)) : nullptr),
        origin_(grid_.point(face_, tile.origin)),
        base_u_(origin_.u / origin_.w),
        base_v_(origin_.v / origin_.w),
        texel_u_(std::floor(base_u_)),
        texel_v_(std::floor(base_v_)),
        u_(face().u - (perspective_ ? base_u_ : 0.0) * face().w, tile.extent),
        v_(face().v - (perspective_ ? base_v_ : 0.0) * face().w, tile.extent),
        w_(face().w, tile.extent) {
    const Vec3 largest = glm::max(glm::abs(tile.bounds.min), glm::abs(tile.bounds.max));
    usable_ = raytrace::max_component(largest) < grid_.bounds.reach;
    usable_ = usable_ && (!perspective_ || origin_.w > 2.0 * grid_.near_limit);
    // Perspective: what lies less deep is left to doubles.
    least_depth_ = perspective_ ? std::max(0.5 * origin_.w, origin_.w - 2.0 * w_.size) : 1.0;
    // What a column is wider (texel_slack) holds the error of u and v. It is that of U - c w, of w (its constant's, no
    // more than two, and a sum's), of the quotient's two operations, of a last sum.
    const double by_depth = perspective_ ? rounding * w_.size / least_depth_ + 6.0 * 0x1p-24 : 0.0;
    const double size = std::max(u_.size, v_.size) / least_depth_;
    const double lateral = grid_.grid_error / least_depth_ + size * (rounding + by_depth + 0x1p-24) + 0x1p-22;
    usable_ = usable_ && lateral < texel_slack;
    // 1 / w - 1 / w0 = -(w - w0) / (w w0)
    reciprocal_depth_scale_ = perspective_ ? 1.0 / (least_depth_ * origin_.w) : 1.0;
    slack_ =
        4.0 * rounding * w_.size * reciprocal_depth_scale_ + 0x1p-22 * std::abs(origin_.reciprocal_depth);
  }

  // In passes over the tile, so that what one pass finds comes from memory before the next one reads it.
  void run(TileClasses& out) {
    out.lit.fill(0), out.shadowed.fill(0), out.ambiguous.fill(0);
    out_ = &out;
    for (std::size_t p = 0; p < raytrace::tile_packets; ++p) {
      const unsigned present = tile_.present[p];
      unsigned unreached = 0, asked = 0;
      for (std::size_t i = 0; i < packet_rays && present != 0; i += hn::Lanes(f)) {
        const unsigned here = present >> i & ((1u << hn::Lanes(f)) - 1);
        lane_ = p * packet_rays + i;
        for (std::size_t a = 0; a < 3; ++a) local_[a] = hn::Load(f, tile_.position[a] + lane_);
        unsigned surely = 0, perhaps = 0;
        facing(surely, perhaps);
        unreached |= (here & ~perhaps) << i;
        if (usable_ && (here & surely) != 0) asked |= find_texels(here & surely) << i;
      }
      out.unreached[p] = static_cast<std::uint16_t>(unreached);
      asked_[p] = static_cast<std::uint16_t>(asked);
    }
    fetch();
    for (std::size_t p = 0; p < raytrace::tile_packets; ++p)
      for (std::size_t i = 0; i < packet_rays && asked_[p] != 0; i += hn::Lanes(f)) {
        lane_ = p * packet_rays + i;
        judge(static_cast<unsigned>(asked_[p]) >> i & ((1u << hn::Lanes(f)) - 1));
      }
    judge_in_parts();
    for (std::size_t p = 0; p < raytrace::tile_packets; ++p)
      out.open[p] = static_cast<std::uint16_t>(
          tile_.present[p] & ~(out.unreached[p] | out.lit[p] | out.shadowed[p] | out.ambiguous[p]));
  }

 private:
  static int face_of(const SheetGrid& grid, const QuantisedTile& tile) {
    return grid.perspective && grid.view.face_count == 6 ? cube_face(tile.origin - grid.view.origin) : 0;
  }
  const GridFace& face() const { return grid_.faces[static_cast<std::size_t>(face_)]; }

  /// Bits of those that surely face the light, and of those that may.
  void facing(unsigned& surely, unsigned& perhaps) const {
    V cosine, size;
    constexpr hn::Rebind<std::int16_t, decltype(f)> units;
    const auto normal = [&](std::size_t a) {
      return hn::ConvertTo(f, hn::PromoteTo(index, hn::Load(units, tile_.normal[a] + lane_)));
    };
    if (directional_) {
      cosine = hn::Neg(hn::MulAdd(
          normal(0), all(light_direction_.x),
          hn::MulAdd(normal(1), all(light_direction_.y), hn::Mul(normal(2), all(light_direction_.z)))));
      size = all(sum_of_magnitudes(light_direction_));
    } else {
      V offset[3];
      for (int a = 0; a < 3; ++a) offset[a] = hn::Add(local_[a], all(from_light_[a]));
      cosine = hn::Neg(
          hn::MulAdd(normal(0), offset[0], hn::MulAdd(normal(1), offset[1], hn::Mul(normal(2), offset[2]))));
      size = hn::Add(hn::Add(hn::Abs(offset[0]), hn::Abs(offset[1])),
                     hn::Add(hn::Abs(offset[2]), all(2.0 * tile_.extent)));
    }
    constexpr double roundings = 0x1p-21;  // eight of them at most, in parts of the normal's length
    const V error = hn::Mul(all(raytrace::normal_error + roundings * double{raytrace::normal_units}), size);
    surely = bits_of(hn::Gt(cosine, error));
    perhaps = bits_of(hn::Not(hn::Lt(cosine, hn::Neg(error))));
  }

  /// Stores the texels that a vector's receivers look up, and their places there; bits of those on the map.
  unsigned find_texels(unsigned asked) {
    V u = u_.at(local_), v = v_.at(local_), deeper = w_.at(local_);
    if (perspective_) {
      const V depth = hn::Add(deeper, all(origin_.w)), inverse = hn::Div(all(1.0), depth);
      asked &= bits_of(hn::Gt(depth, all(least_depth_ * (1.0 + 0x1p-20))));
      u = hn::Mul(u, inverse), v = hn::Mul(v, inverse);
      deeper = hn::Mul(deeper, hn::Mul(inverse, all(origin_.reciprocal_depth)));
    }
    // From the corner of the origin's texel.
    u = hn::Add(u, all(base_u_ - texel_u_)), v = hn::Add(v, all(base_v_ - texel_v_));
    const V row = hn::Floor(v), column = hn::Floor(u);
    const V x = hn::Add(column, all(texel_u_)), y = hn::Add(row, all(texel_v_));  // whole numbers: exact
    const unsigned inside =
        bits_of(hn::And(hn::Ge(hn::Min(x, y), all(0.0)), hn::Lt(hn::Max(x, y), all(grid_.view.size))));
    if ((asked & ~inside) != 0 && sheets_.lone_plane() != no_id) look_beside(asked & ~inside, x, y);
    asked &= inside;
    if (!sheets_.is_built()) add(out_->ambiguous, asked);
    if (asked == 0 || !sheets_.is_built()) return 0;
    hn::Store(hn::Neg(deeper), f, reciprocal_depths_ + lane_);
    hn::Store(hn::Sub(u, hn::Add(column, all(0.5))), f, from_middle_u_ + lane_);
    hn::Store(hn::Sub(v, hn::Add(row, all(0.5))), f, from_middle_v_ + lane_);
    const M on_map = raytrace::HWY_NAMESPACE::mask_from_bits(f, asked);
    const Index texel_x = hn::ConvertTo(index, hn::IfThenElseZero(on_map, x));
    const Index texel_y = hn::ConvertTo(index, hn::IfThenElseZero(on_map, y));
    constexpr int tile_shift = 5;
    static_assert(1 << tile_shift == tile_texels);
    const Index in_row = hn::Set(index, tile_texels - 1);
    hn::Store(hn::Add(hn::ShiftLeft<tile_shift>(hn::And(texel_y, in_row)), hn::And(texel_x, in_row)), index,
              texel_ + lane_);
    const Index tile_x = hn::ShiftRight<tile_shift>(texel_x), tile_y = hn::ShiftRight<tile_shift>(texel_y);
    hn::Store(hn::Add(hn::Mul(tile_y, hn::Set(index, grid_.tiles)), tile_x), index, sheet_ + lane_);
    return asked;
  }

  /// Whole texels beside the map, on the plane that is alone there (LightSheets::lone_plane).
  void look_beside(unsigned asked, V x, V y) {
    const M far = hn::Or(hn::Lt(hn::Min(x, y), all(-1.0)), hn::Gt(hn::Max(x, y), all(grid_.view.size)));
    const auto own = hn::Load(ids, tile_.source + lane_);
    const M on_plane = hn::RebindMask(f, hn::Eq(own, hn::Set(ids, sheets_.lone_plane())));
    add(out_->lit, asked & bits_of(hn::And(far, on_plane)));
  }

  const SheetTile& sheet_at(std::size_t lane) const {
    return sheets_.tile(grid_.tile_index(face_, 0, 0) + static_cast<std::size_t>(sheet_[lane]));
  }

  /// The texels' bounds: many loads on the way at once, where a gather would wait for sixteen.
  void fetch() {
    for (std::size_t p = 0; p < raytrace::tile_packets; ++p)
      for (unsigned left = asked_[p]; left != 0; left &= left - 1) {
        const std::size_t lane = p * packet_rays + static_cast<std::size_t>(std::countr_zero(left));
        const auto texel = static_cast<std::size_t>(texel_[lane]);
        if (const PackedBounds* texels = tile_texels_[sheet_[lane]]) {
          bounds_[lane] = texels[texel];
          continue;
        }
        bounds_[lane] = sheet_at(lane).uniform;
        constexpr float to_middle = 0.5f * tile_texels - 0.5f;
        const auto column = texel % tile_texels, row = texel / tile_texels;
        from_middle_u_[lane] += static_cast<float>(column) - to_middle;
        from_middle_v_[lane] += static_cast<float>(row) - to_middle;
      }
  }

  /// Where receivers lie in what their bounds are of, from its middle, and how much nearer than the origin.
  struct Places {
    V u, v, reciprocal_depth;
  };
  struct Told {
    unsigned lit, dark;
  };
  /// A vector of receivers, their bounds from here on.
  Told tell(const PackedBounds* bounds, const Places& at) const {
    static_assert(sizeof(PackedBounds) == 2 * sizeof(std::uint32_t));
    hn::Vec<decltype(ids)> first, second;
    hn::LoadInterleaved2(ids, &bounds->lit_above_slope_u, first, second);
    const auto of_slope = hn::Set(ids, PackedBounds::slope_mask);
    const auto bound = [&](auto packed) { return hn::BitCast(f, hn::AndNot(of_slope, packed)); };
    const auto slope = [](auto packed) {
      return hn::BitCast(f, hn::ShiftLeft<PackedBounds::slope_shift>(packed));
    };
    const V by_u = hn::Mul(slope(first), at.u), by_v = hn::Mul(slope(second), at.v);
    // The products' rounding, beside what widens the bounds (texel_slack times the slopes).
    const V slack = hn::MulAdd(hn::Add(hn::Abs(by_u), hn::Abs(by_v)), all(0x1p-21), all(slack_));
    const V value = hn::Add(hn::Sub(at.reciprocal_depth, hn::Add(by_u, by_v)), all(origin_.reciprocal_depth));
    return {bits_of(hn::Gt(hn::Sub(value, slack), bound(first))),
            bits_of(hn::Lt(hn::Add(value, slack), bound(second)))};
  }

  void judge(unsigned asked) {
    const Told told =
        tell(&bounds_[lane_], {hn::Load(f, from_middle_u_ + lane_), hn::Load(f, from_middle_v_ + lane_),
                               hn::Load(f, reciprocal_depths_ + lane_)});
    const unsigned lit = asked & told.lit, dark = asked & told.dark;
    add(out_->lit, lit), add(out_->shadowed, dark);
    for (unsigned left = asked & ~(lit | dark); left != 0; left &= left - 1)
      postpone(lane_ + static_cast<std::size_t>(std::countr_zero(left)));
  }

  /// Some texels are known in parts.
  void postpone(std::size_t lane) {
    const SheetTile& sheet = sheet_at(lane);
    if (sheet.parts.empty()) {
      set(out_->ambiguous, lane);
      return;
    }
    const auto texel = static_cast<std::uint32_t>(texel_[lane]);
    __builtin_prefetch(sheet.parts.place(
        SheetTile::part_at(texel, in_texel(from_middle_u_[lane]), in_texel(from_middle_v_[lane]))));
    left_[left_count_++] = static_cast<std::uint8_t>(lane);
  }

  void judge_in_parts() {
    const std::size_t count = find_parts();
    for (std::size_t k = 0; k < count; k += hn::Lanes(f)) {
      const Told told = tell(&bounds_[k], {hn::Load(f, from_middle_u_ + k), hn::Load(f, from_middle_v_ + k),
                                           hn::Load(f, reciprocal_depths_ + k)});
      for (std::size_t i = 0; i < std::min(hn::Lanes(f), count - k); ++i)
        set((told.lit >> i & 1) != 0    ? out_->lit
            : (told.dark >> i & 1) != 0 ? out_->shadowed
                                        : out_->ambiguous,
            left_[k + i]);
    }
  }

  /// Puts what is known of those left side by side, each in the place of one that came before; returns how
  /// many.
  std::size_t find_parts() {
    std::size_t count = 0;
    for (std::size_t k = 0; k < left_count_; ++k) {
      const std::uint8_t lane = left_[k];
      const float u = in_texel(from_middle_u_[lane]), v = in_texel(from_middle_v_[lane]);
      const std::uint32_t part = SheetTile::part_at(static_cast<std::uint32_t>(texel_[lane]), u, v);
      const PackedBounds* found = sheet_at(lane).parts.find(part);
      if (found == nullptr) {
        set(out_->ambiguous, lane);
        continue;
      }
      from_middle_u_[count] = SheetTile::from_middle_of_part(u, part % parts_per_side);
      from_middle_v_[count] = SheetTile::from_middle_of_part(v, part / parts_per_side % parts_per_side);
      reciprocal_depths_[count] = reciprocal_depths_[lane], bounds_[count] = *found;
      left_[count++] = lane;
    }
    return count;
  }

  static float in_texel(float from_middle) { return from_middle + 0.5f; }
  static void set(LaneMask& bits, std::size_t lane) {
    bits[lane / packet_rays] |= static_cast<std::uint16_t>(1u << (lane % packet_rays));
  }
  /// A vector's bits.
  void add(LaneMask& bits, unsigned more) const {
    bits[lane_ / packet_rays] |= static_cast<std::uint16_t>(more << (lane_ % packet_rays));
  }

  const LightSheets& sheets_;
  const SheetGrid& grid_;
  const QuantisedTile& tile_;
  bool directional_, usable_ = false;
  Vec3 light_direction_, from_light_;
  bool perspective_;
  int face_;
  const PackedBounds* const* tile_texels_;  // of the face
  ProjectedPoint origin_;
  double base_u_, base_v_, texel_u_, texel_v_;
  Local u_, v_, w_;
  double least_depth_, reciprocal_depth_scale_, slack_;
  V local_[3];            // of the vector at work
  std::size_t lane_ = 0;  // where it starts
  TileClasses* out_ = nullptr;
  LaneMask asked_;                                      // those on the map
  std::array<std::uint8_t, raytrace::tile_rays> left_;  // lanes to be judged in parts
  std::size_t left_count_ = 0;
  alignas(64) float reciprocal_depths_[raytrace::tile_rays];  // less the origin's
  alignas(64) float from_middle_u_[raytrace::tile_rays], from_middle_v_[raytrace::tile_rays];  // of the texel
  alignas(64) PackedBounds bounds_[raytrace::tile_rays];
  alignas(64) std::int32_t texel_[raytrace::tile_rays], sheet_[raytrace::tile_rays];  // in its tile; the tile
};

void classify_kernel(const LightSheets& sheets, const Light& light, const QuantisedTile& tile,
                     TileClasses& out) {
  Classifier(sheets, light, tile).run(out);
}

}  // namespace
}  // namespace gnomon::hybrid::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gnomon::hybrid {
HWY_EXPORT(classify_kernel);

void classify_tile(const LightSheets& sheets, const Light& light, const raytrace::QuantisedTile& tile,
                   TileClasses& out) {
  HWY_DYNAMIC_DISPATCH(classify_kernel)(sheets, light, tile, out);
}

}  // namespace gnomon::hybrid
#endif  // HWY_ONCE
