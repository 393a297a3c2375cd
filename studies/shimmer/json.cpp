// result.json of `gnomon shimmer` (shimmer.schema.json). Conventions: result_json.cpp. Means are over the pairs of
// following frames of every receiver that is counted in both.
#include <fmt/core.h>

#include "compare/result/option_names.h"
#include "compare/result/result_parts.h"
#include "scene/light.h"
#include "studies/shimmer/outputs.h"

namespace gnomon::studies {
namespace {

using compare::Json;
using compare::number;

Json vector3(const Vec3& v) {
  return Json::array({number(v.x), number(v.y), number(v.z)});
}

Json mean(double sum, std::uint64_t count) {
  return count > 0 ? number(sum / static_cast<double>(count)) : Json(nullptr);
}

Json budget_json(const TemporalSums& sums, compare::Ladder ladder) {
  Json steps = Json::array();
  for (std::size_t k = 0; k < compare::cause_count; ++k)
    steps.push_back({{"cause", compare::cause_name(static_cast<compare::Cause>(k), ladder)},
                     {"signed", mean(sums.signed_sum[k], sums.receivers)},
                     {"absolute", mean(sums.absolute_sum[k], sums.receivers)}});
  return steps;
}

Json by_label_json(const TemporalSums& sums, compare::Ladder ladder) {
  Json json = Json::object();
  for (std::size_t k = 0; k < flip_label_count; ++k) json[flip_label_name(k, ladder)] = sums.by_label[k];
  return json;
}

Json edges_json(const ShimmerOptions& options, const ShimmerLight& light) {
  const EdgeSpeed speed = edge_speed(options, light);
  return {{"length_world", mean(light.temporal.total().edge_length, light.temporal.transitions().size())},
          {"drawn_world_per_second", number(speed.drawn_world_per_second)},
          {"true_world_per_second", number(speed.true_world_per_second)},
          {"drawn_texels_per_frame", number(speed.drawn_texels_per_frame)},
          {"true_texels_per_frame", number(speed.true_texels_per_frame)}};
}

Json frames_json(const ShimmerLight& light) {
  Json frames = Json::array();
  for (const TemporalSums& sums : light.temporal.transitions())
    frames.push_back({{"receivers", sums.receivers},
                      {"flips", sums.flips},
                      {"error", mean(sums.error_sum, sums.receivers)},
                      {"absolute", mean(sums.error_absolute_sum, sums.receivers)}});
  return frames;
}

Json worst_json(const Shimmer& shimmer, const ShimmerLight& light) {
  Json worst = Json::array();
  const int width = shimmer.receivers.size.width;
  for (const WorstReceiver& one : light.worst) {
    const raytrace::SurfacePoint& at = shimmer.receivers.data[one.pixel];
    worst.push_back({{"x", static_cast<int>(one.pixel) % width},
                     {"y", static_cast<int>(one.pixel) / width},
                     {"position", vector3(at.position)},
                     {"primitive", at.primitive},
                     {"flips", one.flips},
                     {"absolute", number(one.absolute)}});
  }
  return worst;
}

Json light_json(const Shimmer& shimmer, const ShimmerLight& light) {
  const raster::MapOptions& map = shimmer.options.compare.raster.map;
  const Light& of = shimmer.world->scene->lights[light.light];
  const TemporalSums& total = light.temporal.total();
  return {{"light", {{"name", of.name}, {"type", light_type_name(of.type)}}},
          {"map",
           {{"technique", technique_name(map.technique)},
            {"size", map.size},
            {"depth_format", depth_format_name(map.depth_format)},
            {"texel_world", number(light.texel_world)},
            {"texel_world_unsnapped",
             light.texel_world_unsnapped ? number(*light.texel_world_unsnapped) : Json(nullptr)}}},
          {"receivers", light.receivers},
          {"receiver_steps", total.receivers},
          {"flips", total.flips},
          {"flips_per_receiver_second", number(flips_per_receiver_second(shimmer.options, light))},
          {"seam_flips", total.seam_flips},
          {"by_label", by_label_json(total, shimmer.ladder())},
          {"budget", budget_json(total, shimmer.ladder())},
          {"error",
           {{"signed", mean(total.error_sum, total.receivers)},
            {"absolute", mean(total.error_absolute_sum, total.receivers)}}},
          {"edges", edges_json(shimmer.options, light)},
          {"by_frame", frames_json(light)},
          {"worst", worst_json(shimmer, light)}};
}

Json path_json(const ShimmerOptions& options) {
  Json json{{"camera", compare::camera_path_name(options.path.camera)},
            {"light", compare::light_path_name(options.path.light)},
            {"speed", number(options.path.speed)}};
  if (options.path.objects) json["objects"] = true;
  if (!options.path.keys.name.empty()) json["name"] = options.path.keys.name;
  if (options.path.camera == compare::CameraPath::drift)
    json["drift_texels"] = {number(options.path.drift_texels.x), number(options.path.drift_texels.y)};
  return json;
}

}  // namespace

double flips_per_receiver_second(const ShimmerOptions& options, const ShimmerLight& light) {
  return shimmer_figures(options, light).flips_per_receiver_second;
}

EdgeSpeed edge_speed(const ShimmerOptions& options, const ShimmerLight& light) {
  const TemporalSums& total = light.temporal.total();
  EdgeSpeed out;
  if (!(total.edge_length > 0.0)) return out;
  const double drawn = total.drawn_swept / total.edge_length, truth = total.true_swept / total.edge_length;
  out.drawn_world_per_second = drawn * options.time.fps;
  out.true_world_per_second = truth * options.time.fps;
  if (light.texel_world > 0.0)
    out.drawn_texels_per_frame = drawn / light.texel_world,
    out.true_texels_per_frame = truth / light.texel_world;
  return out;
}

std::string shimmer_json(const Shimmer& shimmer, const ShimmerProvenance& from) {
  const Scene& scene = *shimmer.world->scene;
  const ShimmerOptions& o = shimmer.options;
  Json lights = Json::array();
  for (const ShimmerLight& light : shimmer.lights) lights.push_back(light_json(shimmer, light));
  const ImageSize size = o.compare.raster.size;
  const Json json{
      {"schema", "gnomon/shimmer/1"},
      {"command", from.command},
      {"version", compare::program_version()},
      {"seed", from.seed},
      {"scene",
       {{"path", scene.path}, {"sha256", scene.sha256}, {"name", scene.name}, {"notes", scene.notes}}},
      {"gl",
       {{"backend", shimmer.context.backend},
        {"version", shimmer.context.version},
        {"renderer", shimmer.context.renderer}}},
      {"size", {{"width", size.width}, {"height", size.height}}},
      {"frames", o.time.frames},
      {"fps", number(o.time.fps)},
      {"path", path_json(o)},
      {"anchors", o.anchors},
      {"snap", o.compare.raster.map.snap},
      {"lights", std::move(lights)},
      {"times_ms",
       {{"accel_build", compare::one_time_json(shimmer.accel_build_ms)},
        {"frame", compare::times_json(shimmer.frame_ms)},
        {"total", compare::one_time_json(from.total_ms)}}}};
  return compare::dumped(json, 2);
}

}  // namespace gnomon::studies
