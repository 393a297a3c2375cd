#include "studies/shimmer/shimmer.h"

#include <fmt/core.h>

#include <algorithm>

#include "compare/ladder/ladder.h"
#include "compare/result/number_text.h"
#include "raster/renderer.h"
#include "raster/technique_traits.h"
#include "scene/base/parallel.h"
#include "scene/base/stages.h"
#include "scene/light_map/cascade_fit.h"

namespace gnomon::studies {
namespace {

using compare::Label;
using compare::Pose;

// How far a drift goes with each frame, world units, and by how much the map is wider so that it never leaves what it
// is to cover.
struct Drift {
  Vec3 step{0.0};
  double margin = 0.0;
};

Expected<LightView> first_fit(const World& world, const Light& light, const Camera& camera,
                              const raster::RasterOptions& drawing) {
  const raster::MapOptions& map = drawing.map;
  const double aspect = double(drawing.size.width) / drawing.size.height;
  CascadeOptions cascades = map.cascades;
  cascades.fit_samples = false;  // the nominal size is enough
  switch (raster::traits_of(map.technique).texels) {
    case raster::TexelShape::cascades:
      return fit_cascades(world, light, camera, aspect, map.size, cascades, {});
    case raster::TexelShape::warped:
      return fit_warped(world, light, camera, aspect, map.size, map.snap);
    case raster::TexelShape::of_light:
      break;
  }
  return fit_light_view(world, light, camera, aspect, map.size, map.window);
}

Vec3 middle_of(const World& world, const Camera& camera) {
  return world.finite_bounds.empty() ? camera.target : world.finite_bounds.center();
}

class Film {
 public:
  Film(const World& world, Scene& scene, raster::Renderer& renderer, std::span<const std::uint32_t> lights,
       const ShimmerOptions& options, const raytrace::Tracer& tracer, const raytrace::Topology& topology)
      : world_(&world),
        scene_(&scene),
        renderer_(&renderer),
        own_scene_(scene),
        own_renderer_(renderer),
        lights_(lights),
        first_{scene.camera, scene.lights},
        receivers_of_(first_camera(options, scene)),
        plan_(plan_effects(scene)),
        tracer_(&tracer),
        topology_(&topology) {
    out_.world = &world;
    out_.options = options;
    out_.accel_build_ms = tracer.stats().build_ms;
    scene.camera = receivers_of_;
    ShimmerOptions& o = out_.options;
    o.compare.raster = compare::drawing_options(o.compare.raster, o.compare.raytrace);
    o.compare.raster.runs = 0, o.compare.raster.analysis = true;
    o.compare.raster.map_contents = o.explain;
    o.compare.raytrace.size = o.compare.raster.size;
    o.compare.raytrace.picture = o.compare.raytrace.warm_up = false;
    o.compare.raytrace.runs = 1;
  }
  ~Film() {
    own_scene_.camera = first_.camera;
    own_scene_.lights = first_.lights;
    raster::set_map_camera(own_renderer_, std::nullopt);
  }
  Film(const Film&) = delete;
  Film& operator=(const Film&) = delete;

  /// Where a truth of the lights as they stand is known.
  void set_truth(const raytrace::RayTracedFrame& truth) {
    if (receivers_of_ == first_.camera) truth_ = &truth, truth_lights_ = first_.lights;
  }
  Expected<Shimmer> run(const FrameSink& sink, const compare::Progress& progress);

 private:
  Expected<void> find_drift();
  raster::MapCamera map_camera(const Pose& pose, int frame) const;
  Expected<void> make_frame(int frame);
  void begin_lights();
  std::optional<double> unsnapped_texel(const Light& light) const;
  RungFrame climb_light(std::size_t i);
  void keep_anchors(Image<Label>& labels) const;
  Expected<void> load_stage(int frame);
  void leave_out_moved(Image<Label>& labels) const;

  // As they stand in the frame.
  const World* world_;
  Scene* scene_;
  raster::Renderer* renderer_;
  Scene& own_scene_;
  raster::Renderer& own_renderer_;
  std::span<const std::uint32_t> lights_;
  const Pose first_;
  const Camera receivers_of_;
  const EffectPlan plan_;
  const raytrace::Tracer* tracer_;
  const raytrace::Topology* topology_;
  std::unique_ptr<raytrace::Tracer> staged_tracer_;
  std::unique_ptr<raytrace::Topology> staged_topology_;
  Drift drift_;
  raster::RasterFrame drawn_;
  raytrace::RayTracedFrame own_truth_;
  const raytrace::RayTracedFrame* truth_ = nullptr;
  std::vector<Light> truth_lights_;
  std::vector<rays::FilmPassengers> passengers_;  // by light
  Shimmer out_;
};

Expected<void> Film::find_drift() {
  const ShimmerOptions& o = out_.options;
  if (o.path.camera != compare::CameraPath::drift) return {};
  const auto directional = [&](std::uint32_t i) { return first_.lights[i].type == LightType::directional; };
  const auto sun = std::find_if(lights_.begin(), lights_.end(), directional);
  if (sun == lights_.end())
    return fail(ErrorKind::usage,
                "--path drift: no directional light is compared; maps of others stay with the light");
  const raster::RasterOptions& drawing = o.compare.raster;
  const auto view = first_fit(*world_, first_.lights[*sun], first_.camera, drawing);
  if (!view) return fail(view.error());
  const LightFace& face = view->face(0);
  const Vec2 texels = o.path.speed * o.path.drift_texels;
  // Widened by the whole way, the map's texels are wider, too, and so is the way.
  const double way = (o.time.frames - 1) * std::max(std::abs(texels.x), std::abs(texels.y));
  const double share = 1.0 - 2.0 * way / drawing.map.size;
  if (!(share > 0.5))
    return fail(ErrorKind::usage,
                fmt::format("--drift: the way of {} is more than a quarter of the map's {}",
                            compare::with_noun(fmt::format("{:g}", way), "texel"), drawing.map.size));
  const bool follows = raster::follows_camera(drawing.map.technique);
  Vec2 half = face.half_extent;
  if (!follows) {
    drift_.margin = std::max(half.x, half.y) * (1.0 / share - 1.0);
    half += Vec2(drift_.margin);
  }
  const Vec2 step = texels * 2.0 * half / double(drawing.map.size);
  drift_.step = step.x * face.right + step.y * face.up;
  return {};
}

raster::MapCamera Film::map_camera(const Pose& pose, int frame) const {
  raster::MapCamera out{.camera = pose.camera};
  if (out_.options.path.camera != compare::CameraPath::drift) return out;
  const Vec3 way = double(frame) * drift_.step;
  if (raster::follows_camera(out_.options.compare.raster.map.technique)) {
    out.camera.eye += way, out.camera.target += way;
  } else {
    out.shift = way, out.margin = drift_.margin;
  }
  return out;
}

void Film::keep_anchors(Image<Label>& labels) const {
  const int step = out_.options.anchors;
  if (step == 1) return;
  for (int y = 0; y < labels.size.height; ++y)
    for (int x = 0; x < labels.size.width; ++x)
      if (x % step != 0 || y % step != 0) labels.at(x, y) = Label::background;
}

/// Loads the scene as it stands in that frame, and makes its hierarchy and topology.
Expected<void> Film::load_stage(int frame) {
  staged_tracer_.reset(), staged_topology_.reset();
  const ShimmerOptions& o = out_.options;
  const auto stage = o.stage(o.time.seconds(frame));
  if (!stage) return fail(stage.error());
  if (stage->world.triangle_count() != out_.world->triangle_count())
    return fail(ErrorKind::bad_input,
                fmt::format("--path: in frame {} an object is drawn flat: its triangles are gone", frame));
  world_ = &stage->world, scene_ = &stage->scene, renderer_ = &stage->renderer;
  scene_->camera = receivers_of_;
  staged_tracer_ = std::make_unique<raytrace::Tracer>(*world_, o.compare.accel, o.compare.precision);
  staged_topology_ = std::make_unique<raytrace::Topology>(*world_);
  tracer_ = staged_tracer_.get(), topology_ = staged_topology_.get();
  return {};
}

// A receiver stands where the pixel sees the very point that it saw in the first frame.
void Film::leave_out_moved(Image<Label>& labels) const {
  if (!out_.options.stage || out_.receivers.data.empty()) return;
  parallel_for(labels.data.size(), [&](std::size_t i) {
    const raytrace::SurfacePoint &now = truth_->receiver.data[i], &first = out_.receivers.data[i];
    const bool stands = now.primitive == first.primitive && now.position == first.position &&
                        now.barycentric == first.barycentric;
    if (!stands) labels.data[i] = Label::background;
  });
}

// The rungs alone: no label is asked for, so none of the columns that only labels need is looked at. A technique
// without a map has no lower rungs.
std::array<Image<float>, compare::rung_count> climb_rungs(const compare::LadderInput& input,
                                                          Image<Label> labels) {
  if (!raster::compares_depths(input.drawn.options.map.technique))
    return compare::climb(input, std::move(labels)).rungs;
  compare::LowerClimb lower(input, std::move(labels));
  std::fill(lower.sorted.data.begin(), lower.sorted.data.end(), Label::background);
  return compare::climb_up(lower, input).rungs;
}

// V0, and V6 on every other rung.
std::array<Image<float>, compare::rung_count> ends_of_ladder(const compare::LadderInput& input,
                                                             const Image<Label>& labels) {
  std::array<Image<float>, compare::rung_count> rungs;
  rungs.fill(input.record().visibility);
  parallel_for(labels.data.size(), [&](std::size_t i) {
    if (compare::is_compared(labels.data[i])) rungs[0].data[i] = compare::true_visibility(input, i);
  });
  return rungs;
}

RungFrame Film::climb_light(std::size_t i) {
  const raster::LightRecord& record = drawn_.lights[i];
  const compare::LadderInput input{*tracer_, *topology_, drawn_, *truth_, i, {}, &passengers_[i]};
  Image<Label> labels = compare::sort_pixels(input);
  keep_anchors(labels);
  leave_out_moved(labels);
  RungFrame out{{}, Image<std::uint8_t>(labels.size), record.outside_map, record.face};
  std::transform(labels.data.begin(), labels.data.end(), out.counted.data.begin(),
                 [](Label label) { return static_cast<std::uint8_t>(compare::is_compared(label)); });
  out.rungs = out_.options.explain ? climb_rungs(input, std::move(labels)) : ends_of_ladder(input, labels);
  return out;
}

std::optional<double> Film::unsnapped_texel(const Light& light) const {
  raster::RasterOptions drawing = out_.options.compare.raster;
  if (!drawing.map.snap || light.type != LightType::directional) return std::nullopt;
  drawing.map.snap = false;
  const auto view = first_fit(*world_, light, receivers_of_, drawing);
  if (!view) return std::nullopt;
  return raster::texel_world(*view, *world_) + 2.0 * drift_.margin / drawing.map.size;
}

void Film::begin_lights() {
  const ShimmerOptions& o = out_.options;
  out_.receivers = truth_->receiver;
  passengers_.resize(drawn_.lights.size());
  out_.context = drawn_.context;
  const ReceiverSpacing spacing = receiver_spacing(truth_->receiver, *world_, o.anchors);
  for (const raster::LightRecord& record : drawn_.lights) {
    out_.lights.push_back(
        {.light = record.light,
         .temporal = TemporalBudget(o.compare.raster.size, o.time.frames, spacing, o.anchors),
         .texel_world = record.texel_world});
    out_.lights.back().texel_world_unsnapped = unsnapped_texel(first_.lights[record.light]);
  }
}

Expected<void> Film::make_frame(int frame) {
  const ShimmerOptions& o = out_.options;
  const Pose pose = compare::pose_at(o.path, o.time, first_, middle_of(*out_.world, first_.camera), frame);
  if (const auto sound = compare::check_pose(pose, frame); !sound) return sound;
  if (o.stage)
    if (const auto taken = load_stage(frame); !taken) return taken;
  scene_->lights = pose.lights;
  raster::set_map_camera(*renderer_, map_camera(pose, frame));
  out_.options.compare.raster.film_frame = frame;
  auto drawn = renderer_->render(o.compare.raster, lights_);
  if (!drawn) return fail(drawn.error());
  drawn_ = std::move(*drawn);
  if (truth_lights_ != pose.lights || o.stage) {
    own_truth_ = raytrace::trace_frame(*tracer_, plan_, receivers_of_, lights_, o.compare.raytrace);
    truth_ = &own_truth_, truth_lights_ = pose.lights;
  }
  if (frame == 0) begin_lights();
  for (std::size_t i = 0; i < out_.lights.size(); ++i) {
    RungFrame rungs = climb_light(i);
    if (frame == 0)
      out_.lights[i].receivers = static_cast<std::uint64_t>(
          std::count(rungs.counted.data.begin(), rungs.counted.data.end(), std::uint8_t{1}));
    const TimedStage stage("temporal budget");
    out_.lights[i].temporal.add(std::move(rungs));
  }
  return {};
}

Expected<Shimmer> Film::run(const FrameSink& sink, const compare::Progress& progress) {
  if (const auto found = find_drift(); !found) return fail(found.error());
  const int frames = out_.options.time.frames;
  for (int frame = 0; frame < frames; ++frame) {
    if (progress) progress("frames", double(frame) / frames);
    Expected<void> made;
    time_run(out_.frame_ms, [&] { made = make_frame(frame); });
    if (!made) return fail(made.error());
    if (sink)
      if (const auto kept = sink({frame, out_, drawn_}); !kept) return fail(kept.error());
  }
  for (ShimmerLight& light : out_.lights) light.worst = light.temporal.worst(worst_receivers);
  return std::move(out_);
}

}  // namespace

Camera first_camera(const compare::FilmPlan& plan, const Scene& scene) {
  return compare::pose_at(plan.path, plan.time, {scene.camera, {}}, Vec3(0.0), 0).camera;
}

Expected<Shimmer> film_shimmer(const World& world, Scene& scene, raster::Renderer& renderer,
                               std::span<const std::uint32_t> lights, const ShimmerOptions& options,
                               const FrameSink& sink, const compare::Progress& progress) {
  if (const auto sound = compare::check_path(options.path, scene); !sound) return fail(sound.error());
  const raytrace::Tracer tracer(world, options.compare.accel, options.compare.precision);
  const raytrace::Topology topology(world);
  return Film(world, scene, renderer, lights, options, tracer, topology).run(sink, progress);
}

compare::ShimmerFigures shimmer_figures(const compare::FilmPlan& plan, const ShimmerLight& light) {
  const TemporalSums& total = light.temporal.total();
  const double steps = static_cast<double>(std::max<std::uint64_t>(total.receivers, 1));
  return {.frames = plan.time.frames,
          .fps = plan.time.fps,
          .receiver_steps = total.receivers,
          .flips = total.flips,
          .flips_per_receiver_second = static_cast<double>(total.flips) / steps * plan.time.fps,
          .mean_absolute = total.error_absolute_sum / steps};
}

Expected<std::vector<compare::ShimmerFigures>> count_flips(const FilmTools& tools, const World& world,
                                                           Scene& scene, raster::Renderer& renderer,
                                                           std::span<const std::uint32_t> lights,
                                                           const ShimmerOptions& options) {
  if (const auto sound = compare::check_path(options.path, scene); !sound) return fail(sound.error());
  ShimmerOptions plain = options;
  plain.explain = false;
  Film film(world, scene, renderer, lights, plain, tools.tracer, tools.topology);
  film.set_truth(tools.truth);
  const auto made = film.run({}, {});
  if (!made) return fail(made.error());
  std::vector<compare::ShimmerFigures> out;
  for (const ShimmerLight& light : made->lights) out.push_back(shimmer_figures(plain, light));
  return out;
}

}  // namespace gnomon::studies
