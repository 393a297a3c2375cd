// gnomon raytrace: the ray-traced picture alone.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/effect_options.h"
#include "app/heatmap.h"
#include "app/interrupt.h"
#include "app/invocation.h"
#include "app/machine.h"
#include "app/options.h"
#include "app/output_path.h"
#include "app/picture_file.h"
#include "app/picture_samples.h"
#include "app/pose_options.h"
#include "app/render_json.h"
#include "app/session.h"

namespace gnomon::app {

namespace {

struct RaytraceCommand {
  std::string scene, image, light, json, command_line;
  raytrace::RaytraceOptions options;
  raytrace::Accel accel = raytrace::Accel::bvh;
  raytrace::Precision precision = raytrace::Precision::robust;
  std::optional<std::optional<double>> exposure;
  std::optional<HeatmapOf> heatmap;
  PoseOptions poses;
  PictureSamples samples;
  int threads = 0;
  int tessellate = 0;  ///< sectors; 0: shapes stay exact
  bool quiet = false;
  std::vector<std::string> given;  ///< options
};

// Measured: what the peak grows by from 320x180 to 2560x1440, with one light.
constexpr double png_bytes_per_pixel = 109.0;
constexpr double exr_bytes_per_pixel = 216.0;

Expected<ExitCode> run_raytrace(RaytraceCommand& command) {
  const Stopwatch watch;
  Console console(command.quiet);
  const ThreadLimit thread_limit(command.threads);
  if (command.image.empty()) command.image = default_output(command.scene) + "-raytrace.png";
  if (const auto known = check_extension("-o", command.image, ".png .exr"); !known)
    return fail(known.error());
  if (const auto writable = check_output_file(command.image); !writable) return fail(writable.error());
  if (const auto writable = check_output_file(command.json); !writable) return fail(writable.error());
  if (command.heatmap && !command.json.empty())
    return fail(ErrorKind::usage, "--json: a heat map has none (give one of --heatmap and --json)");

  const bool records = command.image.ends_with(".exr");
  const double bytes = records ? exr_bytes_per_pixel : png_bytes_per_pixel;
  if (const auto fits = check_memory(command.options.size, bytes); !fits) return fail(fits.error());
  auto loaded = load(command.scene, console, command.tessellate);
  if (!loaded) return fail(loaded.error());
  apply_picture_samples(command.samples, *loaded->scene);
  loaded->plan = plan_effects(*loaded->scene);
  for (const std::string& note : idle_options(command.given, loaded->plan)) console.note(note);
  command.options.records = records;
  command.options.samples_per_pixel = loaded->scene->camera.samples_per_pixel;
  const auto lights = choose_lights(*loaded->scene, command.light);
  if (!lights) return fail(lights.error());
  const auto posed = apply_poses(command.poses, command.light, *loaded->scene, *loaded->world);
  if (!posed) return fail(posed.error());
  console.progress("ray tracing", 0.2);
  const raytrace::Tracer tracer(*loaded->world, command.accel, command.precision);
  if (command.heatmap) {
    const OutputGuard whole_outputs;
    const auto work = primary_ray_work(tracer, loaded->scene->camera, command.options.size);
    if (const auto written = write_heatmap(command.image, work, *command.heatmap); !written)
      return fail(written.error());
    console.message(fmt::format("heatmap: {}", command.image));
    return ExitCode::done;
  }
  const raytrace::RayTracedFrame frame =
      raytrace::trace_frame(tracer, loaded->plan, loaded->scene->camera, *lights, command.options);
  if (frame.non_finite > 0)
    console.note(fmt::format("{} samples of the picture were not finite; they are black.", frame.non_finite));

  const OutputGuard whole_outputs;
  if (const auto made = make_folder_for(command.image); !made) return fail(made.error());
  const double exposure = choose_exposure(command.exposure, *loaded->scene, frame.color);
  if (const auto written = write_picture(command.image, *loaded->world, frame, exposure); !written) {
    return fail(written.error());
  }
  console.message(fmt::format("picture: {}", command.image));
  const RenderRecord record{command.command_line, command.image, *loaded, exposure, watch.elapsed_ms()};
  if (command.json.empty()) return ExitCode::done;
  const std::string json = render_json(record, tracer, accel_name(command.accel), command.options, frame);
  if (const auto out = hand_out_json(command.json, json); !out) return fail(out.error());
  return ExitCode::done;
}

}  // namespace

void add_raytrace(CLI::App& program, Invocation& invocation) {
  CLI::App* app =
      program.add_subcommand("raytrace", "Render with rays only: a PNG, or an EXR with its records.");
  app->footer(
      "gnomon raytrace whitted -o whitted.png\n"
      "gnomon raytrace model.glb --size 1920x1080 -o model.exr\n"
      "gnomon raytrace whitted --aa 16 --indirect-samples 64 -o soft.png\n"
      "gnomon raytrace stadium --accel grid --heatmap triangles -o heat.png");
  const auto command = std::make_shared<RaytraceCommand>();
  add_scene(*app, command->scene);
  add_output(*app, "-o,--output", command->image, "IMAGE",
             ".png, or .exr with depth, position, normal, ids and, per light, visibility [default "
             "out/NAME-raytrace.png]");
  add_size(*app, command->options.size);
  add_tessellate(*app, command->tessellate);
  add_light(*app, command->light,
            "put this light's visibility only into the .exr; the picture always has all lights");
  add_pose_options(*app, command->poses);
  add_tracer_options(*app, command->accel, command->precision);
  add_heatmap(*app, command->heatmap);
  add_min_contribution(*app, command->options.min_contribution);
  add_samples(*app, command->options.shadow_samples);
  add_picture_samples(*app, command->samples);
  add_seed(*app, command->options.seed, "of every sample");
  add_threads(*app, command->threads, "threads of the ray tracer");
  add_exposure(*app, command->exposure);
  add_json(*app, command->json, "what was traced, costs and times");
  add_quiet(*app, command->quiet);
  app->callback([command, &invocation, app] {
    command->command_line = invocation.command_line;
    command->given = given_options(*app);
    invocation.action = [command] { return run_raytrace(*command); };
  });
}

}  // namespace gnomon::app
