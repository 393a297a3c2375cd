#include "hybrid/visibility.h"

#include <atomic>
#include <map>

#include "hybrid/hard_shadows.h"
#include "hybrid/soft_shadows.h"
#include "raster/bands.h"
#include "scene/base/parallel.h"

namespace gnomon::hybrid {
namespace {

using raster::ExternalCosts;
using raster::VisibilityRequest;
using raytrace::PointVisibility;
using raytrace::Tracer;

bool same(const LightView& a, const LightView& b) {
  const auto same_face = [](const LightFace& p, const LightFace& q) {
    return p.right == q.right && p.up == q.up && p.forward == q.forward && p.center == q.center &&
           p.half_extent == q.half_extent && p.warp == q.warp;
  };
  bool faces = a.face_count == b.face_count;
  for (std::size_t i = 0; faces && i < static_cast<std::size_t>(a.face_count); ++i)
    faces = same_face(a.faces[i], b.faces[i]);
  return faces && a.projection == b.projection && a.size == b.size && a.origin == b.origin;
}

class HybridVisibility final : public raster::ExternalVisibility, public raster::ExternalRows {
 public:
  explicit HybridVisibility(const World& world) : world_(world) {}

  Expected<void> prepare(const VisibilityRequest& request, bool changed) override {
    return whole_or_forgotten([&] { return prepare_whole(request, changed); });
  }

  void set_first_row(int row) override { first_row_ = row; }

  Expected<void> find(const VisibilityRequest& request, const Image<std::uint32_t>& primitive,
                      Image<float>& visibility) override {
    return whole_or_forgotten([&] { return find_whole(request, primitive, visibility); });
  }

  ExternalCosts costs(const VisibilityRequest& request, bool counted) override {
    const Kept& kept = kept_.at(request.light);
    ExternalCosts costs;
    costs.receivers = counts_.asked;
    costs.surely_lit = counts_.lit, costs.surely_shadowed = counts_.shadowed;
    costs.rays = counts_.rays, costs.all_rays = counts_.asked;
    costs.silhouette = silhouette_;
    costs.bytes = kept.cache->bytes();
    if (kept.soft) {
      costs.penumbra = soft_counts_.penumbra;
      costs.rays += soft_counts_.rays;
      costs.all_rays = counts_.asked * static_cast<std::uint64_t>(samples_of(request));
      costs.bytes += kept.soft->bytes();
    }
    costs.build_later_ms = kept.cache->sheets.stats().refine_ms;
    costs.build = kept.build, costs.receivers_ms = kept.receivers_ms, costs.shadow = kept.shadow;
    if (!counted) return costs;
    costs.decision = Image<std::uint8_t>(decision_.size);
    for (std::size_t i = 0; i < decision_.data.size(); ++i)
      costs.decision.data[i] = static_cast<std::uint8_t>(decision_.data[i]);
    count_tests(kept.cache->light, costs);
    return costs;
  }

 private:
  struct Kept {
    std::optional<LightCache> cache;
    Sheets when = Sheets::at_once;
    std::optional<SoftLight> soft;  // of a light with size
    Times build, receivers_ms, shadow;
  };

  /// What was half made when the work was left is made again by the next one.
  template <class Work>
  Expected<void> whole_or_forgotten(const Work& work) {
    try {
      return work();
    } catch (...) {
      kept_.clear();
      throw;
    }
  }

  Expected<void> prepare_whole(const VisibilityRequest& request, bool changed) {
    start();
    Kept& kept = kept_[request.light];
    const Light& light = world_.scene->lights[request.light];
    const bool same_light = kept.cache && kept.cache->light == light;
    if (same_light && same(kept.cache->sheets.view(), request.map)) {
      if (!changed) return {};
    } else {
      // One picture shows what sheets can tell; of a light that moves from frame to frame only speed counts.
      kept.when = kept.cache && !request.analysis ? Sheets::when_they_pay : Sheets::at_once;
      kept.build = {};
    }
    time_run(kept.build, [&] {
      kept.cache.emplace(*tracer_, *topology_, light, request.map, kept.when);
      if (changed || !same_light) kept.soft.reset();  // it does not depend on the map
      if (has_size(light) && !kept.soft) kept.soft.emplace(*tracer_, *topology_, request.light);
    });
    kept.receivers_ms = kept.shadow = {};
    return {};
  }

  Expected<void> find_whole(const VisibilityRequest& request, const Image<std::uint32_t>& primitive,
                            Image<float>& visibility) {
    Kept& kept = kept_.at(request.light);
    time_run(kept.receivers_ms,
             [&] { silhouette_ = finder_->find(request.camera, first_row_, primitive, receivers_).traced; });
    if (!(decision_.size == primitive.size)) decision_ = Image<Decision>(primitive.size);
    const double refined_before = kept.cache->sheets.stats().refine_ms;
    time_run(kept.shadow, [&] {
      counts_ = trace_hard_shadows(*tracer_, *kept.cache, receivers_, centre_, &decision_);
      if (kept.soft) {
        const std::size_t first_pixel = receivers_.points.index(0, first_row_);
        soft_counts_ =
            kept.soft->find(receivers_.points, centre_, {samples_of(request), request.seed, first_pixel},
                            decision_, visibility);
        return;
      }
      for (std::size_t i = 0; i < centre_.data.size(); ++i)
        visibility.data[i] = centre_.data[i] == PointVisibility::shadowed ? 0.0f : 1.0f;
    });
    charge_to_build(kept, kept.cache->sheets.stats().refine_ms - refined_before);
    return {};
  }

  // Sheets that a frame has looked at closely stay so while the light stands still.
  static void charge_to_build(Kept& kept, double refined_ms) {
    kept.shadow.runs.back() -= refined_ms;
    for (double& run : kept.build.runs) run += refined_ms;
  }

  void start() {
    if (finder_) return;
    tracer_.emplace(world_, raytrace::Accel::bvh);
    topology_.emplace(world_);
    finder_.emplace(*tracer_);
  }

  int samples_of(const VisibilityRequest& request) const {
    return request.shadow_samples > 0 ? request.shadow_samples
                                      : world_.scene->lights[request.light].shadow_samples;
  }

  // To the light's centre: what single rays through the hierarchy would test, for those cast and for all.
  void count_tests(const Light& light, ExternalCosts& costs) const {
    std::atomic<std::uint64_t> cast = 0, all = 0;
    parallel_for(receivers_.points.size.height, [&](int y) {
      raytrace::WorkCounts cast_here, all_here;
      for (int x = 0; x < receivers_.points.size.width; ++x) {
        const Decision decision = decision_.at(x, y);
        if (decision == Decision::not_asked) continue;
        raytrace::WorkCounts work;
        static_cast<void>(tracer_->occluded(tracer_->shadow_ray(receivers_.points.at(x, y), light), work));
        all_here.primitives += work.primitives;
        if (decision == Decision::traced) cast_here.primitives += work.primitives;
      }
      cast += cast_here.primitives, all += all_here.primitives;
    });
    costs.triangle_tests = cast, costs.all_triangle_tests = all;
  }

  const World& world_;
  std::optional<Tracer> tracer_;
  std::optional<raytrace::Topology> topology_;
  std::optional<raytrace::ReceiverFinder> finder_;
  std::map<std::uint32_t, Kept> kept_;  // by light
  raytrace::Receivers receivers_;       // of the last frame
  Image<PointVisibility> centre_;
  Image<Decision> decision_;
  ShadowCounts counts_;
  SoftCounts soft_counts_;
  std::uint64_t silhouette_ = 0;
  int first_row_ = 0;
};

}  // namespace

std::shared_ptr<raster::ExternalVisibility> make_visibility(const World& world) {
  return std::make_shared<HybridVisibility>(world);
}

}  // namespace gnomon::hybrid
