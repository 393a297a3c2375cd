// Keeps every picture of the window up to date with its setup: the rasterizer at once, on the caller's thread;
// rays and comparison beside it, first at a quarter of the picture's width and height, then in full; in full at once while the
// rays of the whole picture are known. Knows no window: any OpenGL context will do. All pictures but those of map_pictures.h
// are made by compare's own code.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "app/session.h"
#include "lab/view/state/state.h"
#include "lab/view/work/shadow_times.h"
#include "lab/view/work/worker.h"
#include "raster/renderer.h"

namespace gnomon::lab {

/// What is to be drawn.
struct DrawOrder {
  std::uint64_t revision = 0;
  Setup setup;
};

/// The picture of the shadow map, and what it was drawn with.
struct LivePicture {
  std::uint64_t revision = 0;  ///< 0: nothing is drawn yet
  std::shared_ptr<const Rgb8Image> picture;
  Camera camera;
  Light light;
  LightView map;  ///< of the light that is compared
  /// Corners of what the frozen camera sees, in the order of face_corners; none: it is the view's own.
  std::optional<std::array<Vec3, 8>> map_camera;
  double bias_world = 0.0, texel_world = 0.0;
  double raster_ms = 0.0;  ///< with reading it back
};

class Studio {
 public:
  /// `on_finished` is called from another thread when it is worth calling compare() again. While something is drawn, `overtaken`
  /// says whether it is worth its end (interruptible.h); where it is not, draw() and compare() return an error.
  static Expected<std::unique_ptr<Studio>> create(std::unique_ptr<raster::Context> context,
                                                  std::shared_ptr<const app::LoadedScene> loaded,
                                                  const compare::CompareOptions& options,
                                                  const std::string& shader_folder,
                                                  std::function<void()> on_finished,
                                                  std::function<bool()> overtaken);

  /// Draws the live picture where the revision is another. Error: this cannot be drawn.
  Expected<void> draw(const DrawOrder& order);

  /// Takes what is finished and starts what is next, for an order that was drawn. Error, once: a comparison
  /// failed.
  Expected<void> compare(const DrawOrder& order);

  const LivePicture& live() const { return live_; }
  /// The newest; null where there is none yet.
  std::shared_ptr<const ComparisonOutcome> outcome() const { return outcome_; }
  /// The times of the newest revision that was looked at for long enough; null where there is none yet, or nothing but the
  /// processor draws.
  std::shared_ptr<const ShadowTimes> shadow_times() const { return shadow_timer_.times(); }
  const GivenScene& given() const { return given_; }
  const raster::ContextInfo& context_info() const { return renderer_->info(); }

 private:
  /// What the rays of a picture depend on.
  struct RaysOf {
    Camera camera;
    std::vector<Light> lights;
    std::uint32_t light = 0;
    raytrace::Precision precision = raytrace::Precision::robust;
    ImageSize size;
    bool operator==(const RaysOf&) const = default;
  };

  Studio(std::unique_ptr<raster::Renderer> renderer, std::shared_ptr<const app::LoadedScene> loaded,
         const compare::CompareOptions& options, std::function<void()> on_finished,
         std::function<bool()> overtaken);
  raster::RasterOptions raster_options(const Setup& setup, ImageSize size) const;
  Expected<raster::RasterFrame> render(const Setup& setup, const raster::RasterOptions& options);
  Expected<void> receive_outcome();
  Expected<void> start_next(const DrawOrder& order);
  Expected<void> time_in_software(const DrawOrder& order);
  Expected<void> time_shadows(const DrawOrder& order);
  EffectPlan plan_of(const Setup& setup) const;
  void encode_live();

  std::shared_ptr<const app::LoadedScene> loaded_;
  compare::CompareOptions options_;
  GivenScene given_;
  std::unique_ptr<raster::Renderer> renderer_;
  std::function<bool()> overtaken_;

  LivePicture live_;
  ColorImage live_color_;
  std::optional<double> exposure_;

  ShadowTimer shadow_timer_;

  std::uint64_t started_revision_ = 0;  ///< of the newest request
  bool started_full_ = false;
  RaysOf started_rays_;
  std::optional<RaysOf> known_rays_;                  ///< that the worker has of the whole picture
  std::shared_ptr<const ComparisonOutcome> outcome_;  ///< the newest
  CompareWorker worker_;                              ///< last: its thread ends first
};

}  // namespace gnomon::lab
