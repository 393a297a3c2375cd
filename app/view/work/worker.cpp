#include "app/view/work/worker.h"

#include <fmt/core.h>

#include <exception>
#include <stop_token>

#include "compare/result/outputs.h"
#include "scene/base/threads.h"

namespace gnomon::app {

/// What is under way. Only tracing is ever cut short, between two tiles: the tracer and the light's structures
/// are always built whole.
struct CompareWorker::Job {
  bool preview = false;
  std::stop_source given_up;
};

namespace {

/// A world of the thread's own scene, which holds the meshes; with instances kept where the other one keeps them.
World world_like(const World& other, const Scene& scene) {
  return make_world(scene, other.keeps_instances() ? InstanceChoice::automatic : InstanceChoice::flatten);
}

void draw_pictures(ComparisonOutcome& outcome) {
  const compare::Comparison& comparison = outcome.comparison;
  const compare::LightComparison& light = comparison.lights.front();
  outcome.raytrace = compare::raytraced_picture(comparison);
  outcome.difference = compare::difference_picture(comparison, light);
  outcome.labels = compare::label_picture(light);
  const raster::LightRecord& record = comparison.raster.lights.front();
  outcome.truth = truth_picture(light);
  outcome.gap = gap_picture(record, light);
  outcome.texels = texel_picture(compare::raster_picture(comparison), record, light);
  outcome.depth = compare::depth_map_picture(comparison.raster.lights.front().map);
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
  if (request_ && !request_->preview) request_.reset();
  if (job_ && !job_->preview) job_->given_up.request_stop();
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
  ComparisonRequest request;
  {
    std::unique_lock lock(mutex_);
    if (wait) wake_.wait(lock, [this] { return stop_ || request_; });
    if (stop_ || !request_) return !stop_;
    request = std::move(*request_);
    request_.reset();
    job = job_ = std::make_shared<Job>();
    job->preview = request.preview;
  }
  std::optional<Expected<ComparisonOutcome>> outcome;
  try {
    prepare_tracer(request.precision);
    outcome = compare(std::move(request), *job);
  } catch (const std::exception& error) {
    outcome = fail(unforeseen(error));
  }
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

std::optional<Expected<ComparisonOutcome>> CompareWorker::compare(ComparisonRequest request, Job& job) {
  scene_->camera = request.camera;
  scene_->lights = std::move(request.lights);
  ComparisonOutcome outcome;
  outcome.revision = request.revision;
  outcome.preview = request.preview;
  outcome.precision = request.precision;
  outcome.camera = request.camera;
  const std::vector<std::uint32_t> lights{request.drawn.lights.front().light};
  outcome.light = scene_->lights[lights.front()];
  compare::CompareOptions options = options_;
  options.raster = request.drawn.options;
  options.raytrace.size = options.raster.size;
  KeptTruth& kept = request.preview ? kept_preview_ : kept_;
  kept.keep_for({scene_->camera, scene_->lights, lights.front(), options.raytrace}, request.drawn);
  options.raytrace.stop = job.given_up.get_token();
  const compare::FrameSource frames{
      [&](const PictureRows&) { return Expected<raster::RasterFrame>(std::move(request.drawn)); },
      [&](const PictureRows&) -> Expected<raytrace::RayTracedFrame> {
        const auto given_up = [&] { return fail(ErrorKind::internal, "given up"); };
        if (job.given_up.stop_requested()) return given_up();
        if (kept.has_frame()) return kept.take_frame();
        auto traced = raytrace::trace_frame(*tracer_, request.plan, scene_->camera, lights, options.raytrace);
        if (job.given_up.stop_requested()) return given_up();
        traced.options.stop = {};
        return traced;
      },
      [&](const compare::LadderInput& input) { return kept.climb(input); }};
  compare::Comparison& comparison = outcome.comparison;
  compare::Plan plan = compare::plan_of(*tracer_, lights, options);
  plan.topology = &*topology_, plan.maps = kept.measures();
  const auto measured = compare::measure(comparison, plan, frames);
  if (!measured && !kept.has_frame()) kept.forget();
  if (!measured && job.given_up.stop_requested()) return std::nullopt;
  if (!measured) return Expected<ComparisonOutcome>(fail(measured.error()));
  comparison.plan = request.plan;
  draw_pictures(outcome);
  outcome.verdict = compare::verdict_on(comparison, comparison.lights.front());
  outcome.normals = Image<Vec3f>(comparison.raytraced.receiver.size);
  for (std::size_t i = 0; i < outcome.normals.data.size(); ++i)
    outcome.normals.data[i] = Vec3f(comparison.raytraced.receiver.data[i].normal);
  outcome.shown = shown_surfaces(*tracer_, comparison);
  outcome.result = compare::result_json(comparison);
  kept.keep(comparison);
  comparison.world = nullptr;
  return Expected<ComparisonOutcome>(std::move(outcome));
}

}  // namespace gnomon::app
