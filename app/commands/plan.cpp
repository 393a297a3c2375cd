// gnomon plan: which effects the scene calls for, which are simulated, and why.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>

#include "app/commands.h"
#include "app/invocation.h"
#include "app/options/options.h"
#include "app/outputs/picture_samples.h"
#include "app/outputs/render_json.h"
#include "app/process/machine.h"
#include "app/session.h"
#include "app/strongest_lights.h"
#include "compare/result/number_text.h"
#include "compare/result/text_layout.h"
#include "raytrace/choose_tracer.h"
#include "raytrace/forecast.h"
#include "scene/base/expected.h"
#include "scene/light.h"

namespace gnomon::app {

namespace {

struct PlanCommand {
  SceneArgument scene;
  std::string camera, json;
  raytrace::RaytraceOptions options;
  PictureSamples samples;
  MemoryLimit memory;
  int threads = 0;
  bool quiet = false;
};

/// How a command goes through the picture.
struct BandPlan {
  std::string_view command;
  PictureBytes bytes;
  Expected<std::vector<PictureRows>> bands;
};

std::vector<BandPlan> band_plans(const PlanCommand& command, const LoadedScene& loaded) {
  const ImageSize size = command.options.size;
  std::vector<BandPlan> plans;
  const auto add = [&](std::string_view name, const PictureBytes& bytes) {
    plans.push_back({name, bytes, plan_bands(command.memory, size, bytes)});
  };
  add("compare",
      compare_bytes(*loaded.scene,
                    strongest_lights(loaded, loaded.scene->lights, loaded.scene->camera, usual_max_lights),
                    size, true));
  add("raster", raster_png);
  add("raytrace", raytrace_png);
  return plans;
}

/// Cast. Effects that decide a ray's colour, not whether there is one, cost none.
std::uint64_t rays_of(Effect effect, const raytrace::RayCounts& rays) {
  switch (effect) {
    case Effect::hard_shadow:
      return rays.shadow;
    case Effect::soft_shadow:
      return rays.soft_shadow;
    case Effect::reflection:
      return rays.reflection;
    case Effect::refraction:
      return rays.for_refraction();
    case Effect::glossy:
      return rays.glossy;
    case Effect::indirect_light:
      return rays.indirect;
    case Effect::antialiasing:
      return rays.antialiasing;
    case Effect::absorption:
    case Effect::textures:
    case Effect::alpha_mask:
    case Effect::emission:
    case Effect::specular:
    case Effect::vertex_colors:
    case Effect::unlit:
    case Effect::single_sided:
      break;
  }
  return 0;
}

std::uint64_t total_rays(const raytrace::RayCounts& rays) {
  std::uint64_t total = rays.primary;
  for (std::size_t i = 0; i < effect_count; ++i) total += rays_of(static_cast<Effect>(i), rays);
  return total;
}

nlohmann::ordered_json size_json(const ImageSize& size) {
  return {size.width, size.height};
}

nlohmann::ordered_json method_json(std::string_view way, std::string_view reason) {
  return {{"way", way}, {"reason", reason}};
}

/// Three digits are what a forecast is worth: 1.23 M.
std::string short_count(std::uint64_t count) {
  constexpr std::array<std::string_view, 5> units{"", " k", " M", " G", " T"};
  double value = static_cast<double>(count);
  std::size_t unit = 0;
  while (value >= 999.5 && unit + 1 < units.size()) value /= 1000.0, ++unit;
  return unit == 0 ? std::to_string(count) : fmt::format("{:.3g}{}", value, units[unit]);
}

/// How the rays to lights' centres go.
struct ShadowMethods {
  const raytrace::TracerPlan& methods;
  raytrace::SingleRayForecasts forecast;  ///< of those that go by blocks
  const Scene& scene;
};

nlohmann::ordered_json shadow_json(const ShadowMethods& shadow) {
  nlohmann::ordered_json json = method_json(name_of(shadow.methods.shadow), shadow.methods.shadow_reason);
  json["forecast_rows"] = shadow.forecast.rows;
  json["lights"] = nlohmann::ordered_json::array();
  for (const raytrace::SingleRayForecast& light : shadow.forecast.lights)
    json["lights"].push_back({{"light", shadow.scene.lights[light.light].name},
                              {"rays", light.rays},
                              {"single_rays", light.single}});
  return json;
}

/// The reason, and how many of the rays go on one by one.
std::string shadow_reason(const ShadowMethods& shadow, const ImageSize& size) {
  raytrace::SingleRayForecast all;
  for (const raytrace::SingleRayForecast& light : shadow.forecast.lights)
    all.rays += light.rays, all.single += light.single;
  if (all.rays == 0) return std::string(shadow.methods.shadow_reason);
  return fmt::format(
      "{}; {} of them go on one by one, where 16 x 16 receivers meet more leaves than their rays are "
      "worth or floats do not suffice ({} {} of {} rows)",
      shadow.methods.shadow_reason, compare::percent(all.share()),
      shadow.forecast.rows < size.height ? "forecast from" : "counted in", shadow.forecast.rows, size.height);
}

std::string_view name_of_way(const World& world) {
  return world.keeps_instances() ? "kept" : "flattened";
}

/// Why the world's instances are kept or flattened.
std::string instances_reason(const InstancePlan& plan, InstanceChoice choice) {
  if (plan.instances == 0) return "no mesh of some size stands more than once";
  const std::string bytes =
      fmt::format("{} instances of {} {}, {} triangles, would take {}B flattened, {}B kept", plan.instances,
                  plan.meshes, plan.meshes == 1 ? "mesh" : "meshes", short_count(plan.triangles),
                  short_count(plan.flat_bytes), short_count(plan.kept_bytes));
  if (choice != InstanceChoice::automatic) return "as asked for; " + bytes;
  return plan.keep ? bytes : bytes + ": little, and flattened triangles are traced faster";
}

nlohmann::ordered_json instances_json(const LoadedScene& loaded, InstanceChoice choice) {
  const InstancePlan plan = plan_instances(*loaded.scene);
  nlohmann::ordered_json json = method_json(name_of_way(*loaded.world), instances_reason(plan, choice));
  json["instances"] = plan.instances, json["meshes"] = plan.meshes, json["triangles"] = plan.triangles;
  json["bytes_flattened"] = plan.flat_bytes, json["bytes_kept"] = plan.kept_bytes;
  return json;
}

nlohmann::ordered_json memory_json(const std::vector<BandPlan>& plans, const ImageSize& size) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const BandPlan& plan : plans) {
    const int rows = plan.bands ? plan.bands->front().count : band_step;
    json[std::string(plan.command)] = {
        {"bytes", plan.bytes.of(size, rows)}, {"bands", plan.bands ? plan.bands->size() : 0}, {"rows", rows}};
  }
  return json;
}

std::string plan_json(const EffectPlan& plan, const ImageSize& size, const raytrace::Forecast& forecast,
                      const ShadowMethods& shadow, const nlohmann::ordered_json& instances,
                      const std::vector<BandPlan>& bands) {
  nlohmann::ordered_json effects = nlohmann::ordered_json::array();
  for (const EffectEntry& entry : plan.entries) {
    effects.push_back({{"effect", effect_name(entry.effect)},
                       {"simulated", entry.simulated},
                       {"called_for", entry.called_for},
                       {"reason", entry.reason},
                       {"rays", rays_of(entry.effect, forecast.rays)}});
    if (entry.effect == Effect::soft_shadow) effects.back()["samples"] = forecast.rays.soft_shadow_asked;
  }
  const nlohmann::ordered_json rays{{"size", size_json(size)},
                                    {"grid", size_json(forecast.grid)},
                                    {"exact", forecast.exact},
                                    {"primary", forecast.rays.primary},
                                    {"total", total_rays(forecast.rays)}};
  const raytrace::TracerPlan& methods = shadow.methods;
  const nlohmann::ordered_json tracer{
      {"primary", method_json(name_of(methods.primary), methods.primary_reason)},
      {"receivers", method_json(name_of(methods.receivers), methods.receivers_reason)},
      {"shadow", shadow_json(shadow)}};
  const nlohmann::ordered_json json{{"effects", effects},
                                    {"rays", rays},
                                    {"tracer", tracer},
                                    {"instances", instances},
                                    {"memory", memory_json(bands, size)}};
  return plain_lines(json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace)) + "\n";
}

std::string_view state_words(const EffectEntry& entry) {
  if (entry.simulated) return "simulated";
  return entry.called_for ? "not yet" : "off";
}

/// `text` behind `start`, at most 80 columns wide, further lines under the first.
std::string hanging(std::string start, std::string_view text) {
  constexpr std::size_t columns = 80;
  const std::size_t before = start.size();
  std::string out;
  for (const std::string& line : compare::wrapped(text, columns - before)) {
    out += start + line + "\n";
    start.assign(before, ' ');
  }
  return out;
}

std::string in_words(std::string_view effect) {
  std::string words(effect);
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

std::string plan_row(std::string_view name, std::string_view state, const std::string& rays,
                     std::string_view why) {
  return hanging(fmt::format("{:<16}{:<11}{:>9}  ", name, state, rays), why);
}

std::string ways_table(const ShadowMethods& shadow, const ImageSize& size,
                       const nlohmann::ordered_json& instances) {
  const raytrace::TracerPlan& methods = shadow.methods;
  const auto row = [](std::string_view what, std::string_view way, std::string_view reason) {
    return hanging(fmt::format("{:<16}", what), fmt::format("{}: {}", way, reason));
  };
  return "\n" + row("primary rays", name_of(methods.primary), methods.primary_reason) +
         row("receivers", name_of(methods.receivers), methods.receivers_reason) +
         row("shadow rays", name_of(methods.shadow), shadow_reason(shadow, size)) +
         row("instances", instances["way"].get<std::string>(), instances["reason"].get<std::string>());
}

/// What the pixels take, and in how many bands.
std::string memory_table(const std::vector<BandPlan>& plans, const ImageSize& size) {
  std::string text = "\n";
  for (const BandPlan& plan : plans)
    text += hanging(fmt::format("{:<18}", fmt::format("memory, {}", plan.command)),
                    plan.bands ? bands_text(size, plan.bytes, *plan.bands) : plan.bands.error().reason);
  return text;
}

std::string plan_table(const EffectPlan& plan, const ImageSize& size, const raytrace::Forecast& forecast) {
  std::string text = plan_row("effect", "", "rays", "why");
  for (const EffectEntry& entry : plan.entries) {
    const std::uint64_t rays = rays_of(entry.effect, forecast.rays);
    std::string why = one_line(entry.reason);
    if (entry.effect == Effect::soft_shadow && forecast.rays.soft_shadow_asked > 0)
      why += fmt::format("; {} samples asked for", short_count(forecast.rays.soft_shadow_asked));
    text += plan_row(in_words(effect_name(entry.effect)), state_words(entry),
                     rays > 0 ? short_count(rays) : "-", why);
  }
  text += plan_row("all", "", short_count(total_rays(forecast.rays)),
                   fmt::format("{} of them from the eye; gnomon raytrace at {}x{}, {}",
                               short_count(forecast.rays.primary), size.width, size.height,
                               forecast.exact ? "counted"
                                              : fmt::format("forecast from {}x{} pixels", forecast.grid.width,
                                                            forecast.grid.height)));
  return text;
}

/// How gnomon raytrace makes the picture, with all lights.
raytrace::TracerPlan picture_methods(const raytrace::Tracer& tracer, const Camera& camera,
                                     raytrace::RaytraceOptions options) {
  options.records = false;
  std::vector<std::uint32_t> lights(tracer.world().scene->lights.size());
  std::iota(lights.begin(), lights.end(), 0U);
  return choose_tracer(tracer, make_view(camera, options.size), lights, options);
}

ShadowMethods shadow_methods(const raytrace::Tracer& tracer, const LoadedScene& loaded,
                             const raytrace::TracerPlan& methods, const raytrace::RaytraceOptions& options) {
  const Scene& scene = *loaded.scene;
  ShadowMethods shadow{methods, {}, scene};
  if (methods.shadow != raytrace::ShadowMethod::blocks) return shadow;
  std::vector<std::uint32_t> lights;
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i)
    if (!has_size(scene.lights[i])) lights.push_back(i);
  shadow.forecast = forecast_single_rays(tracer, loaded.plan, scene.camera, lights, options);
  return shadow;
}

Expected<ExitCode> run_plan(const PlanCommand& command) {
  Console console(command.quiet);
  RunFiles files;
  files.reads(command.scene);
  files.writes("--json", command.json);
  if (const auto fine = files.check(); !fine) return fail(fine.error());
  auto loaded = load(command.scene, files, console, 0, command.camera);
  if (!loaded) return fail(loaded.error());
  apply_picture_samples(command.samples, *loaded->scene);
  loaded->plan = plan_effects(*loaded->scene);
  raytrace::RaytraceOptions options = command.options;
  options.samples_per_pixel = loaded->scene->camera.samples_per_pixel;
  console.progress("tracing a coarse grid", 0.5);
  const raytrace::Tracer tracer(*loaded->world, raytrace::Accel::bvh);
  const raytrace::Forecast forecast = forecast_rays(tracer, loaded->plan, loaded->scene->camera, options);
  const raytrace::TracerPlan methods = picture_methods(tracer, loaded->scene->camera, options);
  const ShadowMethods shadow = shadow_methods(tracer, *loaded, methods, options);
  console.clear_progress();
  const nlohmann::ordered_json instances = instances_json(*loaded, command.scene.instances);
  const std::vector<BandPlan> bands = band_plans(command, *loaded);
  const std::string json = plan_json(loaded->plan, options.size, forecast, shadow, instances, bands);
  if (const auto out = hand_out_json(command.json, json); !out) return fail(out.error());
  if (!command.quiet && command.json != "-")
    print_data(plan_table(loaded->plan, options.size, forecast) +
               ways_table(shadow, options.size, instances) + memory_table(bands, options.size));
  return ExitCode::done;
}

}  // namespace

GNOMON_COMMAND(plan, 40,
               "List the effects that a scene calls for, which light or material does, and the rays that "
               "each will cost.") {
  app->footer(
      "gnomon plan whitted\n"
      "gnomon plan penumbra --size 1920x1080 --samples 256 --aa 4\n"
      "gnomon plan model.glb --json - | jq '.effects[] | select(.simulated)'");
  const auto command = std::make_shared<PlanCommand>();
  add_scene(*app, command->scene);
  add_camera(*app, command->camera);
  add_size(*app, command->options.size);
  add_samples(*app, command->options.shadow_samples);
  add_picture_samples(*app, command->samples);
  add_min_contribution(*app, command->options.min_contribution);
  add_memory(*app, command->memory, command->scene.memory);
  add_threads(*app, command->threads, "threads of the ray tracer");
  add_json(*app, command->json, "the plan");
  add_quiet(*app, command->quiet);
  app->callback([command, &invocation] { invocation.action = [command] { return run_plan(*command); }; });
}

}  // namespace gnomon::app
