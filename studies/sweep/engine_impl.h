// The engine's insides: what it keeps from one setting to the next. Parts: engine.cpp (one comparison after
// another), engine_pictures.cpp (a cell in small).
#pragma once

#include <optional>

#include "compare/measure/measure.h"
#include "studies/sweep/bias_axis.h"
#include "studies/sweep/engine.h"

namespace gnomon::studies {

/// What all views of an engine share.
struct Engine::Kept {
  Scene& scene;
  const World& world;
  raster::Renderer& renderer;
  bool perceptual;
  raytrace::Topology topology;
  std::unique_ptr<raytrace::Tracer> tracer{};
  raytrace::Accel accel = raytrace::Accel::bvh;  ///< of the tracer
  std::vector<raster::Bias> expected{};
  std::optional<compare::FilmPlan> film{};
  std::optional<compare::ErrorPlaces>
      places{};  ///< takes the errors of views as they are measured; none: not asked for
  EngineWork work{};
};

/// What the engine keeps of one view.
struct Engine::Impl {
  Kept& kept;
  Scene& scene;
  const World& world;
  raster::Renderer& renderer;
  const bool perceptual;
  const raytrace::Topology& topology;
  std::unique_ptr<raytrace::Tracer>& tracer;
  compare::Comparison comparison;
  std::optional<compare::Setting> truth_of, drawn_for;
  std::optional<compare::Setting> timed_for;  ///< by time_again(), whose drawing the comparison holds
  /// The drawing that the lower climbs were made from, and one climb per light compared.
  std::unique_ptr<raster::RasterFrame> lower_frame;
  std::vector<std::unique_ptr<compare::LowerClimb>> lower;
  std::vector<compare::MapMeasures> map_measures;  ///< as `lower`; empty: not measured yet
  Rgb8Image backdrop;                              ///< the ray-traced picture in grey; empty: not made yet
  bool has_images = false;
  const std::vector<raster::Bias>& expected;
  std::vector<BiasTable> table;     ///< by light; empty: not made yet
  Image<std::uint8_t> right_codes;  ///< class_codes of the table's drawing as if no pixel were wrong
  std::size_t table_place = 0;      ///< of the bias that the comparison's numbers were last taken from it for
  const std::optional<compare::FilmPlan>& film;
  EngineWork& work;
  bool derived = false;

  explicit Impl(Kept& k)
      : kept(k),
        scene(k.scene),
        world(k.world),
        renderer(k.renderer),
        perceptual(k.perceptual),
        topology(k.topology),
        tracer(k.tracer),
        expected(k.expected),
        film(k.film),
        work(k.work) {}

  Expected<void> compare(const compare::Setting& setting, Detail detail);
  Expected<Probe> probe(const compare::Setting& setting, const compare::Figure& measure);
  Expected<double> time_drawing(const compare::Setting& setting);
  Expected<void> time_again(const compare::Setting& setting);
  /// Gaps that sort themselves, the best of all biases, and what the drawing would be wrong by with it.
  void add_gaps_of(Probe& probe, double texel_world, bool scales) const;
  void add_figures_at(const raster::Bias& bias, const compare::Figure& measure, Probe& probe);
  /// Counts the flips of every light of a setting that was traced.
  Expected<std::vector<compare::ShimmerFigures>> count_flips(const compare::Setting& setting) const;

  /// The ray-traced picture in grey between 64 and 232, so that both error colours stand out from it.
  void make_backdrop();
  /// The mean colour of the pixels x0 … x1, y0 … y1 (ends excluded), with the errors' colours. `codes`: those
  /// of a hard test, or null.
  glm::u8vec3 mean_colour(const Image<std::uint8_t>* codes, int x0, int x1, int y0, int y1) const;
  Image<std::uint8_t> class_codes();

 private:
  Image<std::uint8_t> codes_of_images() const;
  /// Returns one light's code at a pixel: with images of the last comparison as it is, without them as if it were right.
  std::uint8_t code_of_light(std::size_t i, std::size_t pixel) const;
  compare::LadderInput input(const raster::RasterFrame& frame, std::size_t i) const;
  /// Returns the figures of every light of the last drawing.
  std::vector<compare::LightFigures> figures(const compare::Figure& measure) const;
  void trace(const compare::Setting& setting);
  Expected<void> draw(const compare::Setting& setting);
  Expected<void> draw_alone(const compare::Setting& setting);
  /// The bias alone, or the images with it.
  void derive(const compare::Setting& setting, Detail detail);
  /// The lower rungs of all lights, kept where the maps are the same as before.
  void climb_lower();
  /// Place of the bias among those expected, or their count.
  std::size_t expected_place(const raster::Bias& bias) const;
  /// The numbers of all expected biases, once per drawing; false where they cannot be made together.
  bool fill_table();
  bool measure_from_table(const raster::Bias& bias);
  Expected<void> measure();
  /// V6 - V0 of the light that is most wrong at a pixel.
  float worst_error(std::size_t pixel) const;
};

}  // namespace gnomon::studies
