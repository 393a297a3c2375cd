// A map whose layers hold distances from the light, each texel that of a direction. The record's own map is a cube beside
// them, for the exact side of the ladder. A layout says where a direction is looked up, and which direction a place has.
#pragma once

#include "judge/captured_map.h"
#include "judge/captured_test.h"

namespace gnomon::judge {

/// A place on one of the layers, texels from its lowest x and y.
struct DirectionPlace {
  std::size_t layer = 0;
  double u = 0.0, v = 0.0;
};

struct DistanceLayer {
  int width = 0, height = 0;  ///< texels
  std::vector<float>
      distances{};  ///< from the light, world units, rows from the lowest y on; 0: nothing is stored
};

class DirectionsTest : public CapturedTest {
 public:
  std::vector<DistanceLayer> pictures{};

  /// Returns where a unit direction from the light is looked up.
  virtual DirectionPlace place(const Vec3& direction) const = 0;
  /// Returns the unit direction of a place, which may lie beside its layer.
  virtual Vec3 direction(const DirectionPlace& place) const = 0;

  /// Returns the middle of the place's texel, or of its layer's nearest one.
  DirectionPlace texel_centre(DirectionPlace place) const;
  /// Returns the distance from the light, world units, in the texel of a place or the layer's nearest one; none where nothing
  /// is stored.
  std::optional<double> distance(const DirectionPlace& place) const;

  std::optional<double> caster(const raster::LightRecord& record,
                               const raster::MapLookup& lookup) const override;
  Reads reads() const override { return Reads::elsewhere; }
  Ray exact_ray(const raster::LightRecord& record, const raster::MapLookup& lookup) const override;
  std::vector<std::optional<double>> casters_within(const raster::LightRecord& record,
                                                    const raster::MapLookup& lookup,
                                                    double reach) const override;
  std::optional<Ray> stored_ray(const LightView& view, TexelKey key, const Vec2& off) const override;
  void add_suspects(std::vector<TestSuspect>& suspects) const override;
};

/// The light's view without a projection.
struct LightTurn {
  Mat3 turn{1.0};  ///< of directions from the world's axes: a turn, or one that mirrors
  Vec3 origin{0.0};
};
/// Takes a layer's matrix apart. Errors (bad input): it is no turn and shift, and `what` says what it should be; it is not the
/// light's.
Expected<LightTurn> read_turn(const Capture& capture, std::size_t layer, const Light& light,
                              const World& world, std::string_view what);

/// What a capture of directions cannot say; `what`: "paraboloids".
Expected<void> check_directions(const Capture& capture, std::string_view what);

/// Reads the layers into `test`, whose layout is set, and makes the cube. It has about as many texels as tell anything, a share
/// of all, each with the number of the texel in which its middle lies. Errors (bad input): a picture that cannot be read;
/// numbers that are not finite.
Expected<CapturedMap> read_directions(const Capture& capture, const Vec3& origin,
                                      std::shared_ptr<DirectionsTest> test, double share);

}  // namespace gnomon::judge
