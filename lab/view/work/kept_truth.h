// What one comparison of the lab keeps for the next one of as large a picture. The rays' frame is kept while camera, lights and
// precision stay. The lower climb is kept while the map stays, too. A bias that is dragged costs neither.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "compare/comparison.h"
#include "compare/ladder/ladder.h"
#include "compare/measure/sums.h"
#include "scene/scene.h"

namespace gnomon::lab {

class KeptTruth {
 public:
  /// What the rays' frame depends on, beside the tracer.
  struct Question {
    Camera camera;
    std::vector<Light> lights;
    std::uint32_t light = 0;            ///< the one compared
    raytrace::RaytraceOptions options;  ///< without a token to stop by
    bool operator==(const Question&) const = default;
  };

  /// Forgets what is no answer to this question, or was climbed on another map than this drawing's.
  void keep_for(const Question& question, const raster::RasterFrame& drawn);
  void forget();

  bool has_frame() const { return frame_.has_value(); }
  void take_traced(raytrace::RayTracedFrame frame) { frame_ = std::move(frame); }
  /// Requires has_frame(). The caller hands it back by keep().
  raytrace::RayTracedFrame take_frame();
  compare::Climb climb(const compare::LadderInput& input);
  /// What was measured on the one light's map; empty where it is not known.
  const std::vector<compare::MapMeasures>& measures() const { return measures_; }
  /// Takes the receivers of a finished comparison, and copies the rest of its frame.
  void keep(compare::Comparison& comparison);

 private:
  std::optional<Question> question_;
  std::optional<raytrace::RayTracedFrame> frame_;
  raster::RasterFrame drawn_;  ///< what have_same_lower_climb() reads of the one that was climbed
  std::unique_ptr<compare::LowerClimb> lower_;
  std::vector<compare::MapMeasures> measures_;
};

}  // namespace gnomon::lab
