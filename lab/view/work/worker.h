// Ray tracing and comparing beside the window. One thread has its own copy of the scene, so that the window may move
// camera and light while it works. The newest request wins: one that is under way is given up when another comes, unless
// it is uninterruptible. What is there within two seconds is finished, so that dragging shows something.
#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "compare/compare.h"
#include "compare/comparison.h"
#include "compare/result/verdict.h"
#include "compare/truth/shown_materials.h"
#include "lab/view/state/look.h"
#include "lab/view/work/kept_truth.h"
#include "lab/view/work/priority.h"
#include "lab/view/work/turns.h"
#include "scene/base/expected.h"
#include "scene/effects.h"
#include "scene/world.h"

namespace gnomon::lab {

/// One drawn frame, and the scene's camera and lights that it was drawn with.
struct ComparisonRequest {
  std::uint64_t revision = 0;    ///< of the window's state
  bool preview = false;          ///< drawn smaller than the window
  bool uninterruptible = false;  ///< finished although a newer one waits, unless it takes seconds
  raytrace::Precision precision = raytrace::Precision::robust;
  EffectPlan plan;  ///< of these lights
  Camera camera;
  std::vector<Light> lights;
  raster::RasterFrame drawn;  ///< with the records of the one light to compare
};

/// Where the pictures show more than what is compared: places in the list from 1 on, 0 elsewhere. Empty for a scene
/// without mirrors and glass.
struct ShownSurfaces {
  std::vector<compare::ShownMaterial> list;
  Image<std::uint32_t> material;      ///< the surface's own, where it mirrors or transmits
  Image<std::uint32_t> stored_glass;  ///< what its texel holds, where that is other glass
};

struct ComparisonOutcome {
  std::uint64_t revision = 0;
  bool preview = false;
  raytrace::Precision precision = raytrace::Precision::robust;
  Camera camera;
  Light light;  ///< the one compared
  /// Without the receivers, by far its largest part, and without the world, which is the worker's own and may end before.
  compare::Comparison comparison;
  Image<Vec3f> normals;  ///< of the receivers: geometric, on the viewer's side
  ShownSurfaces shown;
  compare::Verdict verdict;
  std::string result;  ///< result.json
  /// A picture of what is compared (Picture::raster: of what was drawn), made when it is first asked for. From any thread.
  const Rgb8Image& picture(Picture view) const;

 private:
  struct Made {
    std::mutex mutex;
    std::array<std::optional<Rgb8Image>, 8> images;
  };
  std::unique_ptr<Made> made_ = std::make_unique<Made>();
};

class CompareWorker {
 public:
  /// Builds the tracer on the worker's thread. `on_finished` is called there whenever an outcome is ready.
  CompareWorker(const Scene& scene, const World& world, const compare::CompareOptions& options,
                std::function<void()> on_finished);
  /// Gives up what is under way and waits for the thread.
  ~CompareWorker();

  bool busy() const;
  /// Gives up what is under way, unless it is uninterruptible.
  void give_up();
  /// Requires that the worker is not busy.
  void start(ComparisonRequest request);
  /// The newest outcome that has not been taken, or why there is none.
  std::optional<Expected<ComparisonOutcome>> take();

 private:
  struct Job;
  bool turn(bool wait);
  compare::CompareOptions options_of(const Job& job) const;
  KeptTruth& kept_for(const Job& job);
  /// Has the rays' frame kept, unless the job is given up.
  void trace(Job& job);
  Expected<ComparisonOutcome> compare(Job& job);
  void prepare_tracer(raytrace::Precision precision);

  std::unique_ptr<Scene> scene_;
  std::unique_ptr<World> world_;
  compare::CompareOptions options_;
  std::function<void()> on_finished_;
  // The thread's own.
  std::unique_ptr<raytrace::Tracer> tracer_;
  std::optional<raytrace::Topology> topology_;
  KeptTruth kept_preview_, kept_;
  raytrace::Precision tracer_precision_ = raytrace::Precision::robust;

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<ComparisonRequest> request_;  ///< waiting for the thread
  std::shared_ptr<Job> job_;                  ///< under way
  std::optional<Expected<ComparisonOutcome>> outcome_;
  bool stop_ = false;
  std::optional<HelpersGiveWay> helpers_;  ///< the thread's own
  Turns turns_;                            ///< last: they start when all else is there
};

// Pictures of what the map says, in the report page's colours: the true shadow, the gap, and the map's texels
// where they lie on the surfaces.

/// Visibility V0 in grey: white lit, black shadowed; dark grey where nothing is compared.
Rgb8Image truth_picture(const compare::LightComparison& light);
/// The gap, from white (none) to the colour of false shadow at gap_scale_texels and of missed shadow at minus
/// as many.
Rgb8Image gap_picture(const raster::LightRecord& record, const compare::LightComparison& light);
inline constexpr double gap_scale_texels = 4.0;
/// The drawn picture in grey under the map's texels, light and dark in turn as on a chess board; each face or
/// cascade in a tint of its own. Texels that would be finer than the pixels are left out.
Rgb8Image texel_picture(const Rgb8Image& drawn, const raster::LightRecord& record,
                        const compare::LightComparison& light);

}  // namespace gnomon::lab
