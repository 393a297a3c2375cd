// A test that reads moments: what its channels and its filter's keys say, the usual mistakes in them, and other values of them.
#pragma once

#include "judge/captured_test.h"
#include "judge/moments.h"

namespace gnomon::judge {

class MomentsTest final : public CapturedTest {
 public:
  using Texel = std::array<float, 4>;
  MomentFormula formula;
  std::vector<Texel> texels{};  ///< as ShadowMap::depth, whose numbers are these texels' means

  /// Takes the filter's keys over.
  explicit MomentsTest(const Capture& capture);

  /// The depth up to which receivers have half of the light at least, of moments read between the four texels around the
  /// lookup; none where all have it.
  std::optional<double> caster(const raster::LightRecord& record,
                               const raster::MapLookup& lookup) const override;
  Reads reads() const override { return Reads::averages; }
  std::shared_ptr<CapturedTest> clone() const override { return std::make_shared<MomentsTest>(*this); }

  /// In the channels R, G, B, A as many as its kind has. Errors (bad input) name picture and field: a channel that is missing,
  /// or numbers that are not finite.
  Expected<LayerNumbers> read_layer(const Capture& capture, std::size_t layer) const override;
  void take(const LayerNumbers& numbers, std::size_t place, std::size_t index, std::size_t count) override;
  void describe(raster::MapOptions& map, raster::ForeignPicture& picture) const override;

  void reorder(std::size_t first, std::span<const std::size_t> from) override;
  Interval averaged_depths(const raster::LightRecord& record, TexelKey key) const override;
  AveragesRead read_averages(const raster::LightRecord& record, const raster::MapLookup& lookup,
                             double slope_world) const override;
  double light_of(const Averages& averages, double x) const override { return formula.light(averages, x); }
  void add_suspects(std::vector<TestSuspect>& suspects) const override;
  std::vector<OtherSettings> other_settings(const FrameInput& input,
                                            const raster::LightRecord& record) const override;

 private:
  std::size_t channels() const;
  Averages between(const raster::LightRecord& record, const TexelCoordinate& at) const;
};

}  // namespace gnomon::judge
