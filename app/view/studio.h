// Keeps every picture of the window up to date with its state: the rasterizer at once, on the caller's
// thread; rays and comparison beside it, first at a quarter of the window's width and height, then in full.
// Knows no window: any OpenGL context will do. All pictures but the first are made by compare's own code.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "app/session.h"
#include "app/view/state.h"
#include "app/view/worker.h"
#include "raster/renderer.h"

namespace gnomon::app {

/// The numbers beside the pictures. They are of the state shown, or of the newest one that is finished.
struct Readings {
  double bias_world = 0.0, texel_world = 0.0;
  double raster_ms = 0.0;  ///< the live picture, with reading it back
  struct Compared {
    bool current = false;  ///< of the state as it is now
    bool preview = false;
    double wrong_fraction = 0.0;
    double map_ms = 0.0, shade_ms = 0.0;  ///< full size only; 0 in a preview
    double exact_shadows_ms = 0.0;
    double mean_absolute = 0.0;  ///< mean error of visibility
  };
  std::optional<Compared> compared;
};

class Studio {
 public:
  /// `loaded` must outlive the studio, which moves its scene's camera and lights. `on_finished` is called
  /// from another thread when it is worth calling compare() again.
  static Expected<std::unique_ptr<Studio>> create(std::unique_ptr<raster::Context> context,
                                                  const LoadedScene& loaded,
                                                  const compare::CompareOptions& options,
                                                  const std::string& shader_folder,
                                                  std::function<void()> on_finished);

  /// Draws the live picture where the state has changed, and sets the state's measures. Error: this cannot be
  /// drawn.
  Expected<void> draw(ViewState& state);

  /// Takes what is finished and starts what is next, for a state that was drawn. Error, once: a comparison
  /// failed.
  Expected<void> compare(const ViewState& state);

  /// The full comparison of this state is finished.
  bool is_done(const ViewState& state) const;

  /// Never empty after the first draw(); the live picture stands in for those that are not there yet.
  const Rgb8Image& picture(Picture picture) const;
  Readings readings(const ViewState& state) const;
  const raster::ContextInfo& context_info() const { return renderer_->info(); }

 private:
  Studio(std::unique_ptr<raster::Renderer> renderer, const LoadedScene& loaded,
         const compare::CompareOptions& options, std::function<void()> on_finished);
  Expected<raster::RasterFrame> render(const Setup& setup, ImageSize size, bool analysis, int runs);
  Expected<void> take_outcome();
  Expected<void> start_next(const ViewState& state);
  void encode_live();

  const LoadedScene& loaded_;
  compare::CompareOptions options_;
  std::unique_ptr<raster::Renderer> renderer_;

  std::uint64_t drawn_revision_ = 0;  ///< of the live picture
  raster::RasterFrame live_;
  double live_ms_ = 0.0, texel_world_ = 0.0;
  std::optional<double> exposure_;
  Rgb8Image live_picture_;

  std::uint64_t started_revision_ = 0;  ///< of the newest request
  bool started_full_ = false;
  std::optional<ComparisonOutcome> outcome_;  ///< the newest
  CompareWorker worker_;                      ///< last: its thread ends first
};

}  // namespace gnomon::app
