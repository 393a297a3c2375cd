// One comparison after another at different settings, each from what the last one left: scene, hierarchy,
// camera rays and truth as long as camera and lights stay; the lower rungs and their columns as long as the
// depth maps stay; and a frame of another constant bias without drawing it at all (docs/design.md, section 3).
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compare/bias/bias_curve.h"
#include "compare/compare.h"
#include "compare/setting.h"

namespace gnomon::studies {

enum class Detail : std::uint8_t { numbers, images };

/// What a sweep's cells cost in all.
struct EngineWork {
  std::uint64_t truths = 0;        ///< times that camera and shadow rays were traced
  std::uint64_t renders = 0;       ///< frames drawn
  std::uint64_t lower_climbs = 0;  ///< lights whose lower rungs were climbed
  std::uint64_t derived = 0;       ///< frames of another constant bias made without drawing
};

/// What the tuner needs of a drawing: its errors at every constant bias, and its times; nothing is climbed.
struct Probe {
  std::uint64_t compared = 0;                 ///< pixels, all lights together
  std::vector<compare::LightFigures> lights;  ///< of each light, as drawn
  /// Holds the gaps of all lights together, as the first light's texel has them where the constant scales; empty where
  /// biases do not follow from gaps.
  compare::GapLists gaps;
  /// The constant bias with the fewest wrong pixels, and each light's figures with it; none where biases do
  /// not follow from gaps.
  std::optional<compare::BestBias> best;
  raster::Bias bias_at_best;  ///< with that constant, in the unit that draws it
  std::vector<compare::LightFigures> lights_at_best;
  double bias_world = 0.0;   ///< the constant bias drawn with, of the first light
  double texel_world = 0.0;  ///< the width that biases in texels are taken in, of the first light
  double raster_ms = 0.0;    ///< median times of the map and the shading passes, all lights
  std::uint64_t map_texels = 0, map_bytes = 0;
  std::uint64_t rays = 0;  ///< of the hybrid
  /// A shader of the user's own decided; `reads_bias`: and it has the bias in it, as every technique has.
  bool custom_shader = false, reads_bias = true;
};

class Engine {
 public:
  /// `world` was made from `scene`, and `renderer` for both; all outlive the engine. The scene's camera and
  /// lights are changed by compare(). `perceptual`: FLIP and SSIM too.
  Engine(Scene& scene, const World& world, raster::Renderer& renderer, bool perceptual);
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  /// The constant biases that the coming settings differ in, so that the numbers of all of them are made
  /// together (bias_axis.h). Empty: none.
  void expect_biases(std::vector<raster::Bias> biases);

  /// From now on a film of each setting is made as well, beginning with its picture: LightComparison::shimmer and
  /// the measure "shimmer".
  void film_with(const compare::FilmPlan& plan);

  /// From now on each setting is judged from all these views by that measure, and holds by the worst. compare() gives
  /// the comparison of the view in which it errs most, with Comparison::views. Of probes the lights are those of all
  /// views, one after the other, gaps and best bias of all pixels, times their means. What is kept from one setting to
  /// the next is kept for each view. Without views: from the setting's own camera.
  void look_from(std::vector<compare::JudgedView> views, const compare::Figure& measure);
  /// From now on compare() with all images also says where errors lie, over all views (ViewErrors::places).
  void map_places() { maps_places_ = true; }

  /// The comparison at a setting, as compare_world would make it, times aside; valid until the next call, and
  /// the caller's to complete (command, seed, machine). A frame that differs from the last drawn one in its
  /// constant bias alone is not drawn: what it would show follows from the gaps. Its times and its picture
  /// (RasterFrame::color) are those of the frame that it was made from. With Detail::numbers the images of
  /// such a frame (visibility, rungs, labels) may be left out.
  Expected<compare::Comparison*> compare(const compare::Setting& setting, Detail detail = Detail::images);

  /// Draws at a setting and measures what `measure` needs (FLIP, edges and flips are left NaN otherwise; where it is
  /// flips, no other bias is looked for). A
  /// comparison that stood before is no longer valid.
  Expected<Probe> probe(const compare::Setting& setting,
                        const compare::Figure& measure = compare::wrong_and_mean());

  /// Draws at a setting for Probe::raster_ms alone. A comparison that stood before is no longer valid.
  Expected<double> time_drawing(const compare::Setting& setting);

  /// Draws at a setting for its times alone, from the view whose times compare() gave (shown_view), and gives each light's;
  /// valid until the next call. Settings one after the other that differ in their constant bias alone share one drawing
  /// until begin_round(). A comparison that stood before is no longer valid.
  Expected<const std::vector<raster::LightRecord>*> time_again(const compare::Setting& setting,
                                                               std::size_t view);
  void begin_round();
  /// Of those that the last comparison was judged from, the one that it shows; 0 without views.
  std::size_t shown_view() const { return shown_; }

  /// Returns the last comparison in small, `width` pixels wide, or as wide as the picture if that is less. It is the ray-traced
  /// picture in grey, with false shadow and missed shadow of any light compared in their two colours.
  Rgb8Image thumbnail(int width) const;

  /// The last comparison's rasterized picture, `width` pixels wide at most; of a derived one that of the
  /// frame that it was made from.
  Rgb8Image drawing(int width) const;

  /// Returns the last comparison's labels, all lights together. A pixel has the label of the first light that is wrong there,
  /// else of the first that is off by less. Else it is right where a light is compared, or says why none is. Codes as below.
  Image<std::uint8_t> class_codes() const;

  /// The last comparison was derived.
  bool last_was_derived() const;
  const EngineWork& work() const;

 private:
  struct Impl;
  struct Kept;
  compare::Setting posed(const compare::Setting& setting, std::size_t view) const;
  Expected<void> compare_view(std::size_t view, const compare::Setting& setting, Detail detail);
  std::unique_ptr<Kept> kept_;
  std::vector<std::unique_ptr<Impl>> impls_;  ///< one for each view
  std::vector<compare::JudgedView> views_;    ///< none: the setting's own camera
  const compare::Figure* measure_ = &compare::wrong_and_mean();
  std::size_t shown_ = 0;  ///< the view that was worst
  bool maps_places_ = false;
};

/// A class code: the label's value, counted from Label::uncertain, and what the error is.
inline constexpr std::uint8_t code_label_mask = 0x1f;
inline constexpr std::uint8_t code_true_shadow = 0x20;   ///< truly in shadow, of the light that counts
inline constexpr std::uint8_t code_false_shadow = 0x40;  ///< drawn darker than the truth
inline constexpr std::uint8_t code_small_error = 0x80;   ///< by one half or less: the pixel is not wrong

}  // namespace gnomon::studies
