#include "rays/visibility.h"

#include <fmt/core.h>

#include <map>

#include "raster/bands.h"
#include "rays/frames.h"
#include "raytrace/receiver_tiles.h"
#include "scene/base/parallel.h"

namespace gnomon::rays {
namespace {

using raster::ExternalCosts;
using raster::VisibilityRequest;
using raytrace::PointVisibility;

/// What a light's frames are of.
struct Asked {
  Light light;
  Camera camera;
  ImageSize size, rows_size;
  int first_row = 0;
  std::uint64_t seed = 0;
  raster::RayOptions options;
  bool operator==(const Asked&) const = default;
};

class RayVisibility final : public raster::ExternalVisibility, public raster::ExternalRows {
 public:
  explicit RayVisibility(const World& world) : world_(world) {}

  Expected<void> prepare(const VisibilityRequest& request, bool /*changed*/) override {
    if (!finder_) {
      tracer_.emplace(world_, raytrace::Accel::bvh);
      prepare_single_rays(*tracer_);
      finder_.emplace(*tracer_);
    }
    Kept& kept = kept_[request.light];
    time_run(kept.build, [] {});  // nothing is made for a light
    kept.receivers_ms = kept.cast = kept.denoise = {};
    return {};
  }

  void set_first_row(int row) override { first_row_ = row; }

  Expected<void> find(const VisibilityRequest& request, const Image<std::uint32_t>& primitive,
                      Image<float>& visibility) override {
    const raster::RayOptions& options = request.options.rays;
    if (!(primitive.size == request.camera.size) && has_size(light_of(request)) &&
        (options.denoiser != raster::Denoiser::none || options.count == raster::RayCount::quarter))
      return fail(ErrorKind::usage,
                  fmt::format("technique rays: a denoiser reads across the bands that {} x {} pixels come in "
                              "for want of memory; "
                              "give more (--memory), draw a smaller picture, or ask for --denoiser none",
                              request.camera.size.width, request.camera.size.height));
    Kept& kept = kept_.at(request.light);
    time_run(kept.receivers_ms, [&] {
      silhouette_ = finder_->find(request.camera, first_row_, primitive, receivers_).traced;
      kept.guides = make_guides(*tracer_, request.camera, first_row_, light_of(request), receivers_.points);
    });
    if (has_size(light_of(request)))
      draw_soft(request, kept, visibility);
    else
      draw_hard(request, kept, visibility);
    return {};
  }

  ExternalCosts costs(const VisibilityRequest& request, bool counted) override {
    const Kept& kept = kept_.at(request.light);
    ExternalCosts costs;
    for (const Guide& guide : kept.guides.data) costs.receivers += guide.asked() ? 1 : 0;
    costs.rays = kept.rays, costs.taps = kept.taps;
    costs.all_rays = costs.rays;
    costs.silhouette = silhouette_;
    costs.bytes = kept.history_bytes;
    costs.build = kept.build, costs.receivers_ms = kept.receivers_ms;
    costs.shadow = kept.cast, costs.denoise = kept.denoise;
    if (!counted) return costs;
    if (has_size(light_of(request))) {
      std::uint64_t rays = 0;
      const auto work = count_work(*tracer_, wanted(request, 0), kept.guides, receivers_.points, rays);
      if (rays > 0)
        costs.boxes_per_ray = double(work.boxes) / double(rays),
        costs.primitives_per_ray = double(work.primitives) / double(rays);
    }
    return costs;
  }

 private:
  struct Kept {
    std::optional<Asked> asked;
    Guides guides;
    std::unique_ptr<Denoiser<alone>> before;              // with all frames but the last in its history
    std::unique_ptr<Denoiser<alone>> drawn;               // and with it
    std::optional<int> drawn_frame;                       // of a film
    std::uint64_t rays = 0, taps = 0, history_bytes = 0;  // of the last frame
    Times build, receivers_ms, cast, denoise;
  };

  const Light& light_of(const VisibilityRequest& request) const {
    return world_.scene->lights[request.light];
  }

  RaysWanted wanted(const VisibilityRequest& request, int frame) const {
    return {request.options.rays, request.seed, request.light, static_cast<std::uint32_t>(frame),
            static_cast<std::uint32_t>(first_row_)};
  }

  /// One exact ray to the centre decides.
  void draw_hard(const VisibilityRequest& request, Kept& kept, Image<float>& visibility) {
    centre_ = Image<PointVisibility>(visibility.size, PointVisibility::lit);
    time_run(kept.cast, [&] { kept.rays = trace_shadows(*tracer_, receivers_, light_of(request), centre_); });
    for (std::size_t i = 0; i < centre_.data.size(); ++i)
      visibility.data[i] = centre_.data[i] == PointVisibility::shadowed ? 0.0f : 1.0f;
  }

  void draw_soft(const VisibilityRequest& request, Kept& kept, Image<float>& visibility) {
    const int frame = request.film_frame.value_or(frames_before(request.options.rays));
    if (request.film_frame)
      go_on(request, kept);
    else
      hold_history(request, kept);
    auto denoiser = kept.before->clone();
    LightRays rays;
    time_run(kept.cast,
             [&] { rays = cast_rays(*tracer_, wanted(request, frame), kept.guides, receivers_.points); });
    kept.rays = rays.rays;
    time_run(kept.denoise, [&] {
      kept.taps = denoiser->add({kept.guides, rays, signal_of<alone>(rays, nullptr)}, out_);
    });
    kept.history_bytes = denoiser->history_bytes();
    for (std::size_t i = 0; i < out_.data.size(); ++i) visibility.data[i] = out_.data[i][drawn];
    kept.drawn = std::move(denoiser), kept.drawn_frame = request.film_frame;
  }

  /// A film's history holds the frames before this one, as they were drawn. The same frame may be asked for again.
  void go_on(const VisibilityRequest& request, Kept& kept) {
    if (kept.drawn && kept.drawn_frame == *request.film_frame - 1)
      kept.before = std::move(kept.drawn);
    else if (!(kept.before && kept.drawn_frame == request.film_frame))
      kept.before = make_denoiser<alone>(request.options.rays, kept.guides.size);
    kept.asked.reset();
  }

  /// Casts the frames before the last, unless they are those that are held.
  void hold_history(const VisibilityRequest& request, Kept& kept) {
    const raster::RayOptions& options = request.options.rays;
    Asked asked{light_of(request),
                world_.scene->camera,
                request.camera.size,
                kept.guides.size,
                first_row_,
                request.seed,
                options};
    if (kept.before && kept.asked == asked) return;
    kept.before = make_denoiser<alone>(options, kept.guides.size);
    for (int frame = 0; frame < frames_before(options); ++frame) {
      const LightRays rays = cast_rays(*tracer_, wanted(request, frame), kept.guides, receivers_.points);
      kept.before->add({kept.guides, rays, signal_of<alone>(rays, nullptr)}, out_);
    }
    kept.asked = std::move(asked);
  }

  const World& world_;
  std::optional<raytrace::Tracer> tracer_;
  std::optional<raytrace::ReceiverFinder> finder_;
  std::map<std::uint32_t, Kept> kept_;  // by light
  raytrace::Receivers receivers_;       // of the last frame
  Image<PointVisibility> centre_;
  Image<Signal<alone>> out_;
  std::uint64_t silhouette_ = 0;
  int first_row_ = 0;
};

}  // namespace

std::shared_ptr<raster::ExternalVisibility> make_visibility(const World& world) {
  return std::make_shared<RayVisibility>(world);
}

}  // namespace gnomon::rays
