// What another renderer would have drawn on its own map with other numbers in its test: rung V6 of a capture, evaluated in
// double precision. What the description explains of the picture is drawn again; what it does not explain stays as it was
// drawn, right or wrong.
#pragma once

#include <optional>
#include <vector>

#include "compare/comparison.h"
#include "judge/captured_frame.h"
#include "judge/filter_kernel.h"

namespace gnomon::judge {

/// Is what a drawing leaves, over all pixels that were looked at.
struct Redrawn {
  double wrong_fraction = 0.0, mean_absolute = 0.0;  ///< as of ErrorStats
  /// Means of how far pixels that change may be off what is drawn: those that the description does not explain, and those whose
  /// filter is known in kind alone.
  double unexplained = 0.0, of_kernel = 0.0;
  /// By how much the two figures differ at most from those of other filters that fit the picture alike.
  double wrong_spread = 0.0, mean_spread = 0.0;

  double most_mean() const { return mean_absolute + mean_spread; }
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
  /// Takes over what the other record is tested by.
  void take_tests(const TestedRecord& other) {
    own.foreign->test = other.own.foreign->test;
    if (next) next->foreign->test = other.next->foreign->test;
  }
};

class Redrawing {
  using Reads = CapturedTest::Reads;

 public:
  static constexpr std::size_t shift_count = 5;  ///< places of a lookup that rounding reaches

  /// `drawn`: the capture's frame; `constant_world`: the constant that it was drawn with. All parts must outlive this.
  Redrawing(const FrameInput& in, const raster::RasterFrame& drawn, const compare::LightComparison& light,
            double constant_world);

  /// Tells whether the filter is known well enough to draw anything again.
  bool is_known() const { return known_; }
  /// Tells whether each lookup compares once, so that every constant follows from the gaps.
  bool compares_once() const {
    return fits_.front().kernel.shape == FilterKernel::Shape::one && reads_ != Reads::averages;
  }
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
  /// Returns constants between which what is drawn changes, ascending, in world units. They are some of the gaps of lit
  /// pixels and of shadowed ones. Where averages are read they are some parts and multiples of a texel.
  std::vector<double> telling_constants(const TestedRecord& record, const Pixels& pixels) const;

 private:
  struct Pixel {
    std::uint32_t index = 0;
    float now = 0.0f;        ///< the light that the test as described makes
    std::uint8_t shift = 0;  ///< by which rounding moves the lookup (shifts)
    bool explained = false;  ///< the picture shows what the test draws
  };
  /// A filter that comes near to the picture, and what it makes of the pixels.
  struct Fit {
    FilterKernel kernel{};
    double error = 0.0;           ///< of partly lit pixels, mean
    std::vector<Pixel> pixels{};  ///< of the best one all, of others a sample
    std::size_t step = 1;         ///< from one pixel of a sample to the next
  };
  struct Tap {
    double gap = 0.0, weight = 0.0;
  };
  /// Averages, how much of the light they make, and which face's constant goes with them.
  struct SharedRead {
    AveragesRead read{};
    double share = 0.0;
    int face = 0;
  };
  struct Reading {
    bool known = true;  ///< false: the place lies outside the map
    double lit = 0.0;   ///< the share of the light that no map is asked for
    std::vector<Tap> taps{};
    std::vector<SharedRead> averages{};
    FilterKernel kernel{};
    std::vector<double> weights{};  ///< scratch

    void clear() { known = true, lit = 0.0, taps.clear(), averages.clear(); }
  };

  static constexpr double light_rounding = 0.02;  ///< five steps of eight bits
  static constexpr std::size_t pixels_at_a_time = 256;
  static bool is_partly_lit(double light) { return light > light_rounding && light < 1.0 - light_rounding; }
  void take_layers();
  std::vector<Fit> tried_kernels() const;
  void fit_kernel();
  void look_outside();
  void look_at_picture(Fit& fit) const;
  void look_at_sample(Fit& fit) const;
  void doubt_neighbours(Fit& fit) const;
  Pixel look_at(std::uint32_t index, double kernel_error, Reading& reading) const;
  void read(const TestedRecord& record, std::uint32_t index, int shift, Reading& reading) const;
  bool read_layer(const raster::LightRecord& record, std::uint32_t index, int shift, double share,
                  Reading& reading) const;
  double light(const raster::LightRecord& record, const Reading& reading, double constant_world) const;
  double redrawn_light(const Pixel& pixel, double light, double kernel_error, Redrawn& sum) const;
  std::vector<Redrawn> redraw(const Fit& fit, const TestedRecord& record,
                              const std::vector<double>& constants_world, const Pixels& pixels) const;
  bool is_asked(const Fit& fit, std::size_t place, const Pixels& pixels) const;

  const FrameInput& in_;
  const raster::RasterFrame& frame_;
  const compare::LightComparison& light_;
  double constant_world_, slack_world_;
  TestedRecord drawn_;
  Image<float> next_share_, faded_;  ///< by pixel, in [0, 1]; empty where nothing blends, or fades
  Reads reads_ = Reads::texel;
  bool known_ = true, exact_ = true;
  double outside_light_ = 1.0;  ///< what is drawn outside the map
  bool outside_is_told_ = false;
  std::vector<Fit> fits_;  ///< the best one first
};

}  // namespace gnomon::judge
