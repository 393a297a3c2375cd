// What the user chooses about the shadow map. Each field has a unit, a range and a default; the command line
// binds to these structs.
#pragma once

#include <cstdint>

#include "scene/image.h"

namespace gnomon::raster {

enum class Backend : std::uint8_t { automatic, osmesa, egl };
/// app/options.cpp offers those that are finished.
enum class Technique : std::uint8_t {
  hard,
  pcf,
  pcss,
  vsm,
  esm,
  evsm,
  msm,
  second_depth,
  midpoint,
  csm,
  lispsm,
  cube,
  izb,
  hybrid
};
enum class DepthFormat : std::uint8_t { d16, d24, d32f };
/// Which triangles the map leaves out, by their winding as the light sees it; of a shape, which side.
enum class Cull : std::uint8_t { none, front, back };

enum class BiasUnit : std::uint8_t {
  world,  ///< world units along the light ray
  texel   ///< multiples of the texel's world width, taken at the scene's centre for a perspective map
};

/// A hard test shadows a receiver iff its gap (distance to the light minus the stored distance, along the
/// receiver's own light ray, in world units) exceeds constant + slope * (depth slope over the texel).
struct Bias {
  double constant = 1.0;  ///< in `unit`; finite; default 1 texel
  BiasUnit unit = BiasUnit::texel;
  /// Finite; in multiples of h_u |dz/du| + h_v |dz/dv| with h half a texel and z the depth of the receiver's
  /// plane, taken as half the difference of that plane's depths across the texel: 1 leaves no acne on a
  /// plane. Infinite where the plane is edge-on to a ray of the texel: such a receiver is lit.
  double slope = 0.0;
  /// >= 0; the receiver is moved along its normal by this times the texel's world width times sin(angle
  /// between normal and light) (Holbein 2010).
  double normal_offset_texels = 0.0;
  bool receiver_plane = false;  ///< compare with the receiver's plane at the texel's centre (Isidoro 2006)
  bool operator==(const Bias&) const = default;
};

struct MapOptions {
  Technique technique = Technique::hard;
  int size = 1024;  ///< texels on a side, >= 1, at most the context's limit
  DepthFormat depth_format = DepthFormat::d32f;
  Cull cull = Cull::none;
  Bias bias;
  bool operator==(const MapOptions&) const = default;
};

struct RasterOptions {
  ImageSize size{1280, 720};
  MapOptions map;
  int runs = 3;  ///< timed repetitions of each pass after one warm-up; 0: render once, untimed
  bool analysis =
      true;  ///< also hand on the per-pixel records and the map's primitive ids (compare needs them)
  bool operator==(const RasterOptions&) const = default;
};

}  // namespace gnomon::raster
