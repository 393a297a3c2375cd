// How another renderer tests a map that it drew: by stored numbers, and in its own units. What is read and compared differs
// from class to class; what a bias does to it is the same for all.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "compare/result/judged.h"
#include "judge/conventions.h"
#include "raster/frame.h"
#include "raster/map_test.h"
#include "scene/image.h"

namespace gnomon::judge {

struct FrameInput;
struct TestSuspect;

/// Returns the factor >= 0 at the angle with this cosine, which is at least 0; infinite for the tangent of a right angle.
double angle_factor(BiasAngle form, double cosine);

/// A layer's stored numbers, rows as in its picture.
struct LayerNumbers {
  ImageSize size;
  std::vector<float> values;                     ///< of averages the mean that they tell
  std::vector<std::array<float, 4>> averages{};  ///< empty where the layer holds none
};

/// What a test reads that makes a share of the light rather than one comparison.
struct AveragesRead {
  std::array<double, 4> averages{};
  double x = 0.0;  ///< the receiver's own number
  double cosine = 1.0;
};

using RecordChange = std::function<void(raster::LightRecord&)>;
/// Another value of a setting that a test has beside its bias.
struct OtherSetting {
  compare::AdvisedSetting setting;
  std::optional<compare::AdvisedSetting> with{};
  RecordChange change;
  bool about = false;  ///< `change` puts an estimate in the map's place
};
struct OtherSettings {
  /// Makes the map again with the present values; where that draws something else, no other one is tried. May be empty.
  RecordChange as_is{};
  std::vector<OtherSetting> settings{};
};

class CapturedTest : public raster::MapTest {
 public:
  /// World units that 1 of a stored number counts for; gaps and constant bias are differences of stored
  /// numbers times this, as the renderer itself tests.
  double unit_world = 1.0;
  double normal_offset_world = 0.0;  ///< along the receiver's normal; below 0 only where a mistake is tried
  /// By which the offset is multiplied; `none`: it has one length at every angle.
  BiasAngle normal_offset_angle = BiasAngle::none;
  /// By which the constant is multiplied; the product is held within `least` and `most`, stored numbers.
  BiasAngle constant_angle = BiasAngle::none;
  double least = -infinity, most = infinity;
  bool has_angle() const {
    return constant_angle != BiasAngle::none || least != -infinity || most != infinity;
  }
  Stores stores = Stores::depths;
  Vec2 range{0.0, 1.0};  ///< where Stores::depths is not stored: world units that are stored as 0 and as 1
  /// By face, where a picture of the renderer's fills a part of the face alone: columns and rows from the lowest u and v.
  struct Part {
    int column = 0, row = 0, width = 0, height = 0;
    bool holds(int u, int v) const {
      return u >= column && v >= row && u < column + width && v < row + height;
    }
    bool operator==(const Part&) const = default;
  };
  std::vector<Part> parts{};  ///< empty: all of each face
  Part part(const LightView& view, int face) const;
  bool holds(int face, int column, int row) const {
    return parts.empty() || parts[static_cast<std::size_t>(face)].holds(column, row);
  }
  /// By pixel, the face that it looks up, whichever hold its place; no_face: it looks up none and is lit; any_face: the
  /// first that holds it. Empty: any_face for all.
  Image<std::uint8_t> faces{};
  static constexpr std::uint8_t no_face = 255, any_face = 254;
  /// Returns any_face or the one that the pixel looks up, or no_face.
  std::uint8_t face_of(std::size_t pixel) const { return faces.data.empty() ? any_face : faces.data[pixel]; }
  /// By face, what the test has beside the bias of the first: stored numbers, and world units along the normal.
  struct LayerBias {
    double constant = 0.0, normal_offset_world = 0.0;
  };
  std::vector<LayerBias> layers{};
  double constant_beside(int face) const {
    return layers.empty() ? 0.0 : layers[static_cast<std::size_t>(face)].constant;
  }
  /// Returns what the test takes off for a constant: multiplied by the angle's factor and held within its limits.
  double taken_off(double constant, double cosine) const;
  /// Returns the number that a texel stores of a depth along forward, and the depth of a number.
  double number_of(const LightView& view, TexelKey key, double depth) const;
  double depth_of(const LightView& view, TexelKey key, double number) const;

  std::optional<raster::MapLookup> lookup(const raster::LightRecord& record, const raster::Bias& bias,
                                          const raster::MapReceiver& receiver) const override;
  double gap(const raster::LightRecord& record, const raster::Bias& bias, const Vec3& normal,
             const raster::MapLookup& lookup, double caster_depth) const override;
  bool looks_up(std::size_t pixel) const override { return face_of(pixel) != no_face; }
  std::optional<double> reach_texels(const raster::MapOptions& map) const override;
  std::optional<double> stored_per_world(const LightView& view) const override;
  double constant_world(const raster::LightRecord& record, int face, double texel_world,
                        double stored_per_world) const override;

  virtual std::shared_ptr<CapturedTest> clone() const = 0;

  // Where the layers are read.

  /// Reads one, and takes its texels over: that at `place` of the layer's numbers goes into that of `index`
  /// (ShadowMap::texel_index), of `texels` in all.
  virtual Expected<LayerNumbers> read_layer(const Capture& capture, std::size_t layer) const;
  virtual void take(const LayerNumbers& /*numbers*/, std::size_t /*place*/, std::size_t /*index*/,
                    std::size_t /*texels*/) {}
  /// Says what the test reads: settings of the options, words and numbers.
  virtual void describe(raster::MapOptions& map, raster::ForeignPicture& picture) const;

  // What the capture's judge asks.

  /// Puts each texel's own from[i] in the place of texel first + i, beside the record's numbers.
  virtual void reorder(std::size_t /*first*/, std::span<const std::size_t> /*from*/) {}
  /// Of Reads::elsewhere: the depths of all its texels within so many of the one that is looked up, along both axes.
  virtual std::vector<std::optional<double>> casters_within(const raster::LightRecord& record,
                                                            const raster::MapLookup& lookup,
                                                            double /*reach*/) const {
    return {caster(record, lookup)};
  }
  /// The ray of what a texel of the record's map holds, or so many texels beside it; none: that through its middle.
  virtual std::optional<Ray> stored_ray(const LightView& /*view*/, TexelKey /*key*/,
                                        const Vec2& /*off*/) const {
    return std::nullopt;
  }
  /// Of Reads::averages: what a lookup reads, and the light in [0, 1] that this makes for a receiver at x.
  virtual AveragesRead read_averages(const raster::LightRecord& /*record*/,
                                     const raster::MapLookup& /*lookup*/, double /*slope_world*/) const {
    return {};
  }
  virtual double light_of(const std::array<double, 4>& /*averages*/, double /*x*/) const { return 1.0; }
  /// Adds the usual mistakes in what this class reads.
  virtual void add_suspects(std::vector<TestSuspect>& /*suspects*/) const {}
  /// Returns other values of what this class has beside its bias.
  virtual std::vector<OtherSettings> other_settings(const FrameInput& /*input*/,
                                                    const raster::LightRecord& /*record*/) const {
    return {};
  }

 protected:
  CapturedTest() = default;
  CapturedTest(const CapturedTest&) = default;
  CapturedTest& operator=(const CapturedTest&) = default;
};

/// One texel's depth, or one that is read between four.
class DepthsTest final : public CapturedTest {
 public:
  explicit DepthsTest(bool between) : between_(between) {}
  /// Another class' test, read as depths.
  DepthsTest(const CapturedTest& other, bool between) : CapturedTest(other), between_(between) {}

  std::optional<double> caster(const raster::LightRecord& record,
                               const raster::MapLookup& lookup) const override;
  Reads reads() const override { return between_ ? Reads::between : Reads::texel; }
  std::optional<double> reach_texels(const raster::MapOptions& map) const override;
  std::shared_ptr<CapturedTest> clone() const override { return std::make_shared<DepthsTest>(*this); }

 private:
  bool between_;
};

/// One of the four texels around a place, and how much of it is read there: weights add up to 1.
struct WeighedTexel {
  std::size_t index = 0;  ///< ShadowMap::texel_index
  double weight = 0.0;
};
/// A sampler's linear filter: of the texels that the face, or the part of it that is a picture, has not, the nearest ones.
std::array<WeighedTexel, 4> texels_between(const raster::LightRecord& record, const CapturedTest& test,
                                           const TexelCoordinate& at);

/// Returns the test of a captured record. Needs a map.
inline const CapturedTest& captured_test(const raster::LightRecord& record) {
  return static_cast<const CapturedTest&>(*record.foreign->test);
}
/// Returns a copy of it that the record has for its own from here on.
template <class Test = CapturedTest>
Test& changed_test(raster::LightRecord& record) {
  const std::shared_ptr<CapturedTest> own = captured_test(record).clone();
  record.foreign->test = own;
  return static_cast<Test&>(*own);
}

}  // namespace gnomon::judge
