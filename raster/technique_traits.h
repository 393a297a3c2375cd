// What each technique is: one table, which the command line, the comparison, the tuner, the viewer, the manual and the report
// page read. A new technique adds a row here, whose `drawing` says how it draws (passes/technique_pass.h). Which settings it
// reads follows from the row (settings.cpp), and what it alone reads is a row there.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "raster/options.h"

namespace gnomon::raster {

/// What a texel of the technique's map holds.
enum class MapContents : std::uint8_t {
  nearest_depth,   ///< of the surface nearest to the light
  back_depth,      ///< of the nearest surface that faces away from the light
  midpoint_depth,  ///< halfway between the two nearest surfaces
  moments,         ///< the depth's moments, filtered
  pixels,          ///< the list of the pixels that look it up
  sheets,          ///< the connected pieces of surface in its column (docs/design.md, section 3)
  nothing          ///< there is none: rays are cast
};

/// How the visibility of a pixel comes from the map.
enum class ShadowTest : std::uint8_t {
  single,    ///< shadowed iff its gap to one stored depth exceeds the bias
  averaged,  ///< the mean of such tests
  moments,   ///< an upper bound of the share of unshadowed texels
  exact,     ///< against the triangles themselves: no stored depth is compared, and there is no bias
  sampled    ///< the mean of a few rays, denoised; there is no bias
};

/// How wide a texel is, and what the map follows.
enum class TexelShape : std::uint8_t {
  of_light,  ///< the light alone decides: one width, or one that grows with the distance to the light
  cascades,  ///< follows the camera: one width in each of several maps
  warped     ///< follows the camera: a width that grows with the distance to it
};

/// What makes the edges of shadows soft.
enum class EdgeFilter : std::uint8_t {
  none,
  kernel,    ///< a mean over FilterOptions::kernel
  penumbra,  ///< a mean over a width that is searched for, up to FilterOptions::search_radius
  moments    ///< the blur of a map of moments
};

struct TechniqueDrawing;

/// A set of the members of an enumeration of at most 32, a bit for each.
template <class Enum>
class EnumSet {
 public:
  constexpr EnumSet() = default;
  template <class... Members>
  constexpr explicit EnumSet(Members... members) : bits_(((1U << static_cast<unsigned>(members)) | ...)) {}
  constexpr bool has(Enum member) const { return (bits_ >> static_cast<unsigned>(member) & 1U) != 0; }
  constexpr EnumSet operator|(EnumSet other) const { return of_bits(bits_ | other.bits_); }
  constexpr EnumSet without(EnumSet other) const { return of_bits(bits_ & ~other.bits_); }
  bool operator==(const EnumSet&) const = default;

 private:
  static constexpr EnumSet of_bits(std::uint32_t bits) {
    EnumSet set;
    set.bits_ = bits;
    return set;
  }
  std::uint32_t bits_ = 0;
};
using LightTypeSet = EnumSet<LightType>;

struct TechniqueTraits {
  Technique technique;
  std::string_view name;            ///< on the command line and in files
  const TechniqueDrawing* drawing;  ///< private to raster
  MapContents contents = MapContents::nearest_depth;
  int floats_per_texel = 1;  ///< of what the shader looks up; 0: lists of any length
  ShadowTest test = ShadowTest::single;
  EdgeFilter filter = EdgeFilter::none;
  LightTypeSet lights{LightType::directional, LightType::point,
                      LightType::spot};  ///< those that it has a map for
  TexelShape texels = TexelShape::of_light;
  bool soft = false;  ///< draws the penumbra of a light with size; others draw the shadow of its centre
  /// The slope bias where no bias is asked for and the filter has its default plane (default_bias()): what leaves no acne on a
  /// plane. It is without effect where the test is exact.
  double default_slope_bias = 1.0;
};

/// One row for each technique, in the order of the enumeration.
std::span<const TechniqueTraits> all_technique_traits();
const TechniqueTraits& traits_of(Technique technique);

struct FilterKernelTraits {
  FilterKernel kernel;
  std::string_view name;
};
std::span<const FilterKernelTraits> all_filter_kernel_traits();
const FilterKernelTraits& traits_of(FilterKernel kernel);

inline std::string_view technique_name(Technique technique) {
  return traits_of(technique).name;
}

/// Whether a stored depth is compared with the receiver's, with a bias.
inline bool compares_depths(Technique technique) {
  return traits_of(technique).test < ShadowTest::exact;
}

/// Its filter is FilterOptions::kernel.
inline bool has_kernel(Technique technique) {
  return traits_of(technique).filter == EdgeFilter::kernel;
}

/// Few rays for each pixel are cast and denoised: rays.
inline bool samples_rays(Technique technique) {
  return traits_of(technique).test == ShadowTest::sampled;
}

/// Visibility comes from outside OpenGL (ExternalVisibility).
inline bool is_external(Technique technique) {
  const MapContents contents = traits_of(technique).contents;
  return contents == MapContents::sheets || contents == MapContents::nothing;
}

inline bool has_cascades(Technique technique) {
  return traits_of(technique).texels == TexelShape::cascades;
}
/// Two cascades are mixed where one gives way to the next.
inline bool mixes_cascades(const MapOptions& map) {
  return has_cascades(map.technique) && map.cascades.blend > 0.0;
}

/// The map is fitted to what the camera sees.
inline bool follows_camera(Technique technique) {
  return traits_of(technique).texels != TexelShape::of_light;
}

}  // namespace gnomon::raster
