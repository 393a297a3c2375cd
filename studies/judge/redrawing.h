// What another renderer would have drawn on its own map with other numbers in its test: rung V6 of a capture, evaluated in
// double precision. What the description explains of the picture is drawn anew; what it does not explain stays as it was
// drawn, right or wrong.
#pragma once

#include <optional>
#include <vector>

#include "compare/comparison.h"
#include "studies/judge/captured_frame.h"
#include "studies/judge/filter_kernel.h"

namespace gnomon::compare {

/// Is what a drawing leaves, over all pixels that were looked at.
struct Redrawn {
  double wrong_fraction = 0.0, mean_absolute = 0.0;  ///< as of ErrorStats
  /// Means of how far pixels that change may be off what is drawn: those that the description does not explain, and those whose
  /// filter is known in kind alone.
  double unexplained = 0.0, of_kernel = 0.0;
};

/// Is the record of a test with other numbers, and that of the layers that take over where two blend.
struct TestedRecord {
  raster::LightRecord own;
  std::optional<raster::LightRecord> next;

  template <class Change>
  void change(const Change& change) {
    change(own);
    if (next) change(*next);
  }
};

class Redrawing {
 public:
  /// `drawn`: the capture's frame; `constant_world`: the constant that it was drawn with. All parts must outlive this.
  Redrawing(const FrameInput& in, const raster::RasterFrame& drawn, const LightComparison& light,
            double constant_world);

  /// Tells whether the filter is known well enough to draw anything again.
  bool is_known() const { return known_; }
  /// Tells whether each lookup compares once, so that every constant follows from the gaps.
  bool compares_once() const { return kernel_.shape == FilterKernel::Shape::one && !reads_moments_; }
  const TestedRecord& as_drawn() const { return drawn_; }

  /// Which pixels are looked at: all that are compared, or a sample of some 10,000; of one face alone, or of all (below 0).
  struct Pixels {
    bool sample = false;
    int face = -1;
  };
  /// Returns what each constant, world units, leaves beside the record's other numbers.
  std::vector<Redrawn> redraw(const TestedRecord& record, const std::vector<double>& constants_world,
                              const Pixels& pixels) const;
  Redrawn redraw(const TestedRecord& record, double constant_world) const;
  /// Returns constants between which what is drawn changes, ascending, in world units: some of the gaps of lit pixels and of
  /// shadowed ones, or where moments are read some parts and multiples of a texel.
  std::vector<double> telling_constants(const TestedRecord& record, const Pixels& pixels) const;

 private:
  struct Pixel {
    std::uint32_t index = 0;
    float now = 0.0f;        ///< the light that the test as described makes
    std::uint8_t shift = 0;  ///< by which rounding moves the lookup (shifts)
    bool explained = false;  ///< the picture shows what the test draws
  };
  struct Tap {
    double gap = 0.0, weight = 0.0;
  };
  struct MomentsRead {
    std::array<double, 4> averages{};
    double x = 0.0, cosine = 1.0, share = 0.0;
    int face = 0;
  };
  struct Reading {
    bool known = true;  ///< false: the place lies outside the map
    double lit = 0.0;   ///< the share of the light that no map is asked for
    std::vector<Tap> taps{};
    std::vector<MomentsRead> moments{};
    FilterKernel kernel{};
    std::vector<double> weights{};  ///< scratch

    void clear() { known = true, lit = 0.0, taps.clear(), moments.clear(); }
  };

  Reading empty_reading() const { return {.kernel = kernel_}; }
  void take_layers();
  void fit_kernel();
  void look_at_picture();
  void doubt_neighbours();
  Pixel look_at(std::uint32_t index, Reading& reading) const;
  void read(const TestedRecord& record, std::uint32_t index, int shift, Reading& reading) const;
  bool read_layer(const raster::LightRecord& record, std::uint32_t index, int shift, double share,
                  Reading& reading) const;
  double light(const raster::LightRecord& record, const Reading& reading, double constant_world) const;
  double redrawn_light(const Pixel& pixel, double light, Redrawn& sum) const;
  bool is_asked(const Pixel& pixel, std::size_t place, const Pixels& pixels) const;

  const FrameInput& in_;
  const raster::RasterFrame& frame_;
  const LightComparison& light_;
  double constant_world_, slack_world_;
  TestedRecord drawn_;
  Image<float> next_share_, faded_;  ///< by pixel, in [0, 1]; empty where nothing blends, or fades
  bool reads_moments_ = false, known_ = true, exact_ = true;
  FilterKernel kernel_{};
  double kernel_error_ = 0.0;  ///< of partly lit pixels, mean
  std::size_t sample_step_ = 1;
  std::vector<Pixel> pixels_;
};

}  // namespace gnomon::compare
