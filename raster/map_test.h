// How a light's map is looked up and tested. Who compares asks this and nothing else, so that a map of another renderer is one
// more implementation (judge). Depths are along forward of the face that is looked up. Gaps are world units along the
// receiver's own light ray.
#pragma once

#include <cstdint>
#include <optional>

#include "scene/light_map/light_view.h"
#include "scene/light_map/texel_key.h"

namespace gnomon::raster {

struct Bias;
struct LightRecord;
struct MapOptions;

/// A receiver in the world, and the pixel that shows it; both directions are unit vectors.
struct MapReceiver {
  Vec3 position, normal, to_light;
  std::size_t pixel = 0;
};

/// Where the biased test looks: the receiver's own place, or that of its normal offset.
struct MapLookup {
  TexelKey key;
  TexelCoordinate at;
  Vec3 position;
  double cosine = 1.0;  ///< of the angle between the receiver's normal and the light, in [0, 1]
};

class MapTest {
 public:
  virtual ~MapTest() = default;

  /// Returns where a receiver is looked up; none outside the map.
  virtual std::optional<MapLookup> lookup(const LightRecord& record, const Bias& bias,
                                          const MapReceiver& receiver) const = 0;
  /// Returns the depth that the receiver is compared with; none where nothing is stored.
  virtual std::optional<double> caster(const LightRecord& record, const MapLookup& lookup) const = 0;
  /// Returns the gap to a caster on the light ray through the looked-up texel's centre.
  virtual double gap(const LightRecord& record, const Bias& bias, const Vec3& normal, const MapLookup& lookup,
                     double caster_depth) const = 0;
  /// Whether a pixel looks the map up; one that does not is lit.
  virtual bool looks_up(std::size_t /*pixel*/) const { return true; }

  /// What caster() is made of.
  enum class Reads : std::uint8_t {
    texel,     ///< the number of the texel that is looked up
    between,   ///< a mean of several texels, for which no one depth of the scene stands
    averages,  ///< a texel's averages, among which its own depth may be
    elsewhere  ///< the number of a texel that the record's map has not: exact_ray() is its own
  };
  virtual Reads reads() const { return Reads::texel; }
  /// Returns the ray that tells what an exact map would hold there; of Reads::elsewhere alone.
  virtual Ray exact_ray(const LightRecord& /*record*/, const MapLookup& /*lookup*/) const { return {}; }

  /// Returns the depths that a texel's own may be, as far as its averages tell; of Reads::averages alone.
  virtual Interval averaged_depths(const LightRecord& /*record*/, TexelKey /*key*/) const { return {}; }

  /// Returns how far from a receiver, along either axis, the centre of a texel lies that it is compared with; none where the
  /// filter has no fixed reach or compares no single depth.
  virtual std::optional<double> reach_texels(const MapOptions& map) const = 0;
  /// Returns the stored numbers that one world unit of depth counts for at every depth; none where the view says it.
  virtual std::optional<double> stored_per_world(const LightView& /*view*/) const { return std::nullopt; }
  /// Returns the constant bias that was drawn with on a face, of receivers and casters together, world units. `texel_world`: the
  /// width of the face's texels; `stored_per_world`: stored numbers in a world unit of its depths.
  virtual double constant_world(const LightRecord& record, int face, double texel_world,
                                double stored_per_world) const = 0;
};

}  // namespace gnomon::raster
