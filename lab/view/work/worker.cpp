#include "lab/view/work/worker.h"

#include <fmt/core.h>

#include <exception>
#include <stop_token>

#include "compare/result/outputs.h"
#include "scene/base/interruptible.h"
#include "scene/base/threads.h"
#include "scene/base/timing.h"

namespace gnomon::lab {

/// What is under way: one turn traces, the next compares, so that on one thread it can be given up in between. With
/// threads tracing is cut short between two tiles, and comparing in any loop once it has taken seconds; the tracer is always built whole.
struct CompareWorker::Job {
  ComparisonRequest request;
  std::stop_source given_up;
  bool traced = false;
  Stopwatch begun;
  bool may_be_soon_there() const { return begun.elapsed_ms() < 2000.0; }
};

namespace {

/// A world of the thread's own scene, which holds the meshes; with instances kept where the other one keeps them.
World world_like(const World& other, const Scene& scene) {
  return make_world(scene, other.keeps_instances() ? InstanceChoice::automatic : InstanceChoice::flatten);
}

Rgb8Image draw(const compare::Comparison& comparison, Picture view) {
  const compare::LightComparison& light = comparison.lights.front();
  const raster::LightRecord& record = comparison.raster.lights.front();
  switch (view) {
    case Picture::raster:
      return compare::raster_picture(comparison);
    case Picture::raytrace:
      return compare::raytraced_picture(comparison);
    case Picture::difference:
      return compare::difference_picture(comparison, light);
    case Picture::labels:
      return compare::label_picture(light);
    case Picture::truth:
      return truth_picture(light);
    case Picture::gap:
      return gap_picture(record, light);
    case Picture::texels:
      return texel_picture(compare::raster_picture(comparison), record, light);
    case Picture::depth:
      break;
  }
  return compare::depth_map_picture(record.map);
}

ShownSurfaces shown_surfaces(const raytrace::Tracer& tracer, const compare::Comparison& comparison) {
  const compare::ShownMaterials materials(*comparison.world);
  ShownSurfaces shown;
  if (materials.empty()) return shown;
  const auto& receiver = comparison.raytraced.receiver;
  const raster::LightRecord& record = comparison.raster.lights.front();
  shown.list = materials.list();
  shown.material = Image<std::uint32_t>(receiver.size);
  for (std::size_t i = 0; i < receiver.data.size(); ++i)
    shown.material.data[i] = materials.of(receiver.data[i].primitive);
  shown.stored_glass = compare::stored_glass(tracer, record, comparison.raster.options.map, receiver);
  return shown;
}

}  // namespace

const Rgb8Image& ComparisonOutcome::picture(Picture view) const {
  const std::lock_guard lock(made_->mutex);
  std::optional<Rgb8Image>& made = made_->images[static_cast<std::size_t>(view)];
  if (!made) made = draw(comparison, view);
  return *made;
}

CompareWorker::CompareWorker(const Scene& scene, const World& world, const compare::CompareOptions& options,
                             std::function<void()> on_finished)
    : scene_(std::make_unique<Scene>(scene)),
      world_(std::make_unique<World>(world_like(world, *scene_))),
      options_(options),
      on_finished_(std::move(on_finished)),
      turns_({[this] {
                give_way(comparing_gives_way);
                helpers_.emplace(comparing_gives_way);
              },
              [this](bool wait) { return turn(wait); }, [this] { helpers_.reset(); }}) {}

CompareWorker::~CompareWorker() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
    if (job_) job_->given_up.request_stop();
  }
  wake_.notify_one();
}

bool CompareWorker::busy() const {
  const std::lock_guard lock(mutex_);
  return request_ || job_;
}

void CompareWorker::give_up() {
  const std::lock_guard lock(mutex_);
  if (request_ && !request_->uninterruptible) request_.reset();
  if (job_ && (!job_->request.uninterruptible || !job_->may_be_soon_there())) job_->given_up.request_stop();
}

void CompareWorker::start(ComparisonRequest request) {
  {
    const std::lock_guard lock(mutex_);
    request_ = std::move(request);
  }
  wake_.notify_one();
}

std::optional<Expected<ComparisonOutcome>> CompareWorker::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(outcome_, std::nullopt);
}

bool CompareWorker::turn(bool wait) {
  std::shared_ptr<Job> job;
  {
    std::unique_lock lock(mutex_);
    if (wait) wake_.wait(lock, [this] { return stop_ || request_ || job_; });
    if (stop_ || !(request_ || job_)) return !stop_;
    if (!job_) {
      job_ = std::make_shared<Job>();
      job_->request = *std::exchange(request_, std::nullopt);
    }
    job = job_;
  }
  std::optional<Expected<ComparisonOutcome>> outcome;
  try {
    if (!job->traced)
      trace(*job);
    else if (!job->given_up.stop_requested())
      outcome = compare(*job);
  } catch (const Interrupted&) {
    kept_for(*job).forget();
  } catch (const std::exception& error) {
    outcome = fail(unforeseen(error));
  }
  if (!outcome && !job->given_up.stop_requested()) return true;  // compared at the next turn
  {
    const std::lock_guard lock(mutex_);
    job_.reset();
    if (outcome) outcome_ = std::move(outcome);
  }
  on_finished_();
  return true;
}

void CompareWorker::prepare_tracer(raytrace::Precision precision) {
  if (tracer_ && tracer_precision_ == precision) return;
  tracer_.reset();
  kept_preview_.forget(), kept_.forget();
  if (!topology_) topology_.emplace(*world_);
  tracer_ = std::make_unique<raytrace::Tracer>(*world_, options_.accel, precision);
  tracer_precision_ = precision;
}

compare::CompareOptions CompareWorker::options_of(const Job& job) const {
  compare::CompareOptions options = options_;
  options.raster = job.request.drawn.options;
  options.raytrace.size = options.raster.size;
  return options;
}

KeptTruth& CompareWorker::kept_for(const Job& job) {
  return job.request.preview ? kept_preview_ : kept_;
}

void CompareWorker::trace(Job& job) {
  const ComparisonRequest& request = job.request;
  prepare_tracer(request.precision);
  scene_->camera = request.camera;
  scene_->lights = request.lights;
  const std::vector<std::uint32_t> lights{request.drawn.lights.front().light};
  raytrace::RaytraceOptions options = options_of(job).raytrace;
  KeptTruth& kept = kept_for(job);
  kept.keep_for({scene_->camera, scene_->lights, lights.front(), options}, request.drawn);
  if (!kept.has_frame()) {
    options.stop = job.given_up.get_token();
    auto traced = raytrace::trace_frame(*tracer_, request.plan, scene_->camera, lights, options);
    if (job.given_up.stop_requested()) return;
    traced.options.stop = {};
    kept.take_traced(std::move(traced));
  }
  job.traced = true;
}

Expected<ComparisonOutcome> CompareWorker::compare(Job& job) {
  ComparisonRequest& request = job.request;
  ComparisonOutcome outcome;
  outcome.revision = request.revision;
  outcome.preview = request.preview;
  outcome.precision = request.precision;
  outcome.camera = request.camera;
  const std::vector<std::uint32_t> lights{request.drawn.lights.front().light};
  outcome.light = scene_->lights[lights.front()];
  const compare::CompareOptions options = options_of(job);
  KeptTruth& kept = kept_for(job);
  const compare::FrameSource frames{
      [&](const PictureRows&) { return Expected<raster::RasterFrame>(std::move(request.drawn)); },
      [&](const PictureRows&) { return Expected<raytrace::RayTracedFrame>(kept.take_frame()); },
      [&](const compare::LadderInput& input) { return kept.climb(input); }};
  compare::Comparison& comparison = outcome.comparison;
  compare::Plan plan = compare::plan_of(*tracer_, lights, options);
  plan.topology = &*topology_, plan.maps = kept.measures();
  // What is soon there is kept for the next one.
  const Interruptible measuring([&job] { return job.given_up.stop_requested() && !job.may_be_soon_there(); });
  const auto measured = compare::measure(comparison, plan, frames);
  if (!measured) {
    kept.forget();
    return fail(measured.error());
  }
  comparison.plan = request.plan;
  outcome.verdict = compare::verdict_on(comparison, comparison.lights.front());
  outcome.normals = Image<Vec3f>(comparison.raytraced.receiver.size);
  for (std::size_t i = 0; i < outcome.normals.data.size(); ++i)
    outcome.normals.data[i] = Vec3f(comparison.raytraced.receiver.data[i].normal);
  outcome.shown = shown_surfaces(*tracer_, comparison);
  outcome.result = compare::result_json(comparison);
  kept.keep(comparison);
  comparison.world = nullptr;
  return outcome;
}

}  // namespace gnomon::lab
