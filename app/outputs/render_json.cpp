#include "app/outputs/render_json.h"

#include "app/console.h"
#include "app/outputs/run_files.h"
#include "app/process/machine.h"
#include "compare/result/option_names.h"
#include "compare/result/result_parts.h"
#include "raster/technique_traits.h"
#include "scene/base/parallel.h"
#include "scene/files/write_file.h"
#include "scene/light.h"

namespace gnomon::app {
namespace {

using compare::dumped, compare::Json, compare::number, compare::one_time_json, compare::times_json;

Json common(const RenderRecord& record, const char* renderer, const ImageSize& size) {
  return {{"schema", "gnomon/render/1"},
          {"command", record.command_line},
          {"version", compare::program_version()},
          {"renderer", renderer},
          {"picture", record.picture},
          {"threads", threads_in_use()},
          {"size", {{"width", size.width}, {"height", size.height}}},
          {"exposure", number(record.exposure)},
          {"scene", compare::scene_json(*record.loaded.world)},
          {"machine", compare::machine_json(machine_info())}};
}

Json light_json(const Scene& scene, std::uint32_t index) {
  const Light& light = scene.lights[index];
  return {{"name", light.name}, {"type", light_type_name(light.type)}};
}

}  // namespace

std::string render_json(const RenderRecord& record, const raster::RasterFrame& frame) {
  Json json = common(record, "shadow mapping", frame.options.size);
  const raster::MapOptions& map = frame.options.map;
  json["gl"] = compare::context_json(frame.context);
  json["shaders"] = compare::shaders_json(frame.replaced_shaders);
  json["map"] = {{"technique", raster::technique_name(map.technique)},
                 {"size", map.size},
                 {"depth_format", raster::depth_format_name(map.depth_format)},
                 {"cull", raster::cull_name(map.cull)}};
  json["costs"] = {{"map_texels", frame.map_texels}, {"map_bytes", frame.map_bytes}};
  json["times_ms"] = {{"load", one_time_json(record.loaded.load_ms)},
                      {"total", one_time_json(record.total_ms)}};
  json["lights"] = Json::array();
  for (const raster::LightRecord& light : frame.lights) {
    Json entry = light_json(*record.loaded.scene, light.light);
    entry["times_ms"] = {{"map_pass", times_json(light.map_pass)},
                         {"shade_pass", times_json(light.shade_pass)}};
    json["lights"].push_back(std::move(entry));
  }
  return dumped(json, 2);
}

std::string render_json(const RenderRecord& record, const raytrace::Tracer& tracer, std::string_view accel,
                        const raytrace::RaytraceOptions& options, const raytrace::RayTracedFrame& frame) {
  Json json = common(record, "ray tracing", options.size);
  json["seed"] = options.seed;
  json["precision"] = raytrace::precision_name(tracer.precision());
  const raytrace::AccelStats& stats = tracer.stats();
  json["accel"] = {
      {"name", accel}, {"bytes", stats.bytes}, {"nodes", stats.nodes}, {"dropped", stats.dropped}};
  const raytrace::RayCounts& rays = frame.rays;
  json["costs"] = {{"primary_rays", rays.primary},
                   {"shadow_rays", rays.shadow},
                   {"soft_shadow_rays", rays.soft_shadow},
                   {"soft_shadow_rays_asked", rays.soft_shadow_asked},
                   {"reflection_rays", rays.reflection},
                   {"refraction_rays", rays.for_refraction()},
                   {"glossy_rays", rays.glossy},
                   {"indirect_rays", rays.indirect},
                   {"antialiasing_rays", rays.antialiasing}};
  json["times_ms"] = {{"load", one_time_json(record.loaded.load_ms)},
                      {"accel_build", one_time_json(stats.build_ms)},
                      {"primary_rays", times_json(frame.primary_rays)},
                      {"picture", one_time_json(frame.picture_ms)},
                      {"total", one_time_json(record.total_ms)}};
  json["lights"] = Json::array();
  for (const raytrace::LightTruth& light : frame.lights) {
    Json entry = light_json(*record.loaded.scene, light.light);
    entry["shadow_rays"] = light.rays;
    entry["soft_shadow_rays"] = light.soft_rays;
    entry["soft_shadow_rays_asked"] = light.soft_rays_asked;
    entry["times_ms"] = {{"shadow_rays", times_json(light.shadow_rays)},
                         {"soft_shadow_rays", times_json(light.soft_shadow_rays)}};
    json["lights"].push_back(std::move(entry));
  }
  return dumped(json, 2);
}

Expected<void> hand_out_json(const std::string& path, const std::string& json) {
  if (path.empty()) return {};
  if (path == "-") {
    print_data(json);
    return {};
  }
  if (const auto made = make_folder_for(path); !made) return made;
  return write_file(path, json);
}

std::vector<FileText> texts_for_files(const std::vector<FileText>& texts) {
  std::vector<FileText> files = texts;
  std::erase_if(files, [](const FileText& text) { return text.path.empty() || text.path == "-"; });
  return files;
}

void print_texts(const std::vector<FileText>& texts) {
  for (const FileText& text : texts)
    if (text.path == "-") print_data(text.bytes);
}

Expected<void> publish_texts(const std::vector<FileText>& texts, StagedFiles& files) {
  for (const FileText& text : texts_for_files(texts))
    if (auto written = files.write(text); !written) return written;
  if (auto sealed = files.seal(); !sealed) return sealed;
  if (auto published = files.publish(); !published) return published;
  print_texts(texts);
  return {};
}

}  // namespace gnomon::app
