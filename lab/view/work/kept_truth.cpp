#include "lab/view/work/kept_truth.h"

#include <utility>

namespace gnomon::lab {

namespace {

raster::RasterFrame what_is_climbed(const raster::RasterFrame& drawn) {
  const raster::LightRecord& record = drawn.lights.front();
  raster::RasterFrame out;
  out.options = drawn.options;
  out.primitive = drawn.primitive;
  raster::LightRecord& kept = out.lights.emplace_back();
  kept.light = record.light;
  kept.map = record.map;
  kept.texel_uv = record.texel_uv;
  kept.face = record.face;
  return out;
}

}  // namespace

void KeptTruth::keep_for(const Question& question, const raster::RasterFrame& drawn) {
  if (question_ != question) forget(), question_ = question;
  if (lower_ && compare::have_same_lower_climb(drawn_, drawn, 0)) return;
  lower_.reset();
  measures_.clear();
}

void KeptTruth::forget() {
  question_.reset();
  frame_.reset();
  drawn_ = {};
  lower_.reset();
  measures_.clear();
}

raytrace::RayTracedFrame KeptTruth::take_frame() {
  raytrace::RayTracedFrame frame = std::move(*frame_);
  frame_.reset();
  return frame;
}

compare::Climb KeptTruth::climb(const compare::LadderInput& input) {
  if (!lower_) {
    lower_ = std::make_unique<compare::LowerClimb>(input, compare::sort_pixels(input));
    drawn_ = what_is_climbed(input.drawn);
  }
  return compare::climb_up(*lower_, input);
}

void KeptTruth::keep(compare::Comparison& comparison) {
  Image<raytrace::SurfacePoint> receiver = std::exchange(comparison.raytraced.receiver, {});
  frame_ = comparison.raytraced;
  frame_->receiver = std::move(receiver);
  measures_.assign(1, comparison.lights.front());
}

}  // namespace gnomon::lab
