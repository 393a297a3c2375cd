// gnomon raytrace: the ray-traced picture alone.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/commands.h"
#include "app/invocation.h"
#include "app/options/effect_options.h"
#include "app/options/options.h"
#include "app/options/pose_options.h"
#include "app/outputs/heatmap.h"
#include "app/outputs/picture_bands.h"
#include "app/outputs/picture_command.h"
#include "app/outputs/picture_samples.h"
#include "app/outputs/run_files.h"
#include "app/process/interrupt.h"
#include "app/session.h"
#include "raytrace/frame.h"

namespace gnomon::app {

namespace {

struct RaytraceCommand : PictureCommand {
  raytrace::RaytraceOptions options;
  raytrace::Accel accel = raytrace::Accel::bvh;
  raytrace::Precision precision = raytrace::Precision::robust;
  std::optional<HeatmapOf> heatmap;
  PictureSamples samples;
};

constexpr BytesPerPixel raytrace_bytes_per_pixel{.png = raytrace_png, .exr = raytrace_exr};

struct Tracing {
  const RaytraceCommand& command;
  const LoadedScene& loaded;
  const raytrace::Tracer& tracer;
  const std::vector<std::uint32_t>& lights;
};

/// Band by band into the picture; `costs` are of all of them.
Expected<void> trace_in_bands(const Tracing& in, const std::vector<PictureRows>& bands, PictureBands& picture,
                              raytrace::RayTracedFrame& costs, Console& console) {
  if (in.command.wants_records())  // an .exr grows in its place
    if (const auto made = make_folder_for(in.command.image); !made) return made;
  for (const PictureRows& rows : bands) {
    console.progress("ray tracing in bands", double(rows.first) / in.command.options.size.height);
    const auto frame = raytrace::trace_band(in.tracer, in.loaded.plan, in.loaded.scene->camera, in.lights,
                                            in.command.options, rows);
    if (const auto added = picture.add(frame, rows); !added) return added;
    raytrace::add_costs(frame, costs);
  }
  return {};
}

Expected<ExitCode> draw_heatmap(const RaytraceCommand& command, const raytrace::Tracer& tracer,
                                const Camera& camera, Console& console) {
  const auto work = primary_ray_work(tracer, camera, command.options.size);
  const OutputGuard whole_outputs;
  if (const auto made = make_folder_for(command.image); !made) return fail(made.error());
  if (const auto written = write_heatmap(command.image, work, *command.heatmap); !written)
    return fail(written.error());
  console.message(fmt::format("heatmap: {}", command.image));
  return ExitCode::done;
}

Expected<ExitCode> run_raytrace(RaytraceCommand& command) {
  const Stopwatch watch;
  Console console(command.quiet);
  auto files = check_files(command, "raytrace");
  if (!files) return fail(files.error());
  if (command.heatmap && !command.json.empty())
    return fail(ErrorKind::usage, "--json: a heat map has none (give one of --heatmap and --json)");
  auto loaded = open_scene(command, *files, command.options.size, raytrace_bytes_per_pixel, console);
  if (!loaded) return fail(loaded.error());
  apply_picture_samples(command.samples, *loaded->scene);
  const auto lights = choose_lights(*loaded->scene, command.light);
  if (!lights) return fail(lights.error());
  const auto posed = apply_poses(command.poses, command.light, *loaded);
  if (!posed) return fail(posed.error());
  for (const std::string& note : command.heatmap ? heatmap_options_without_effect(command.given)
                                                 : options_without_effect(command.given, loaded->plan))
    console.note(note);
  if (command.options.terminator_offset && !loaded->world->has_normals())
    console.note("--terminator-offset has no effect: no mesh has normals of its own");
  if (const std::string note = many_rays_note(*loaded->scene, loaded->plan, command.options.min_contribution,
                                              command.options.size);
      !note.empty() && !command.heatmap)
    console.note(note);
  command.options.records = command.wants_records();
  command.options.samples_per_pixel = loaded->scene->camera.samples_per_pixel;
  console.progress("ray tracing", 0.2);
  const raytrace::Tracer tracer(*loaded->world, command.accel, command.precision);
  const Camera& camera = loaded->scene->camera;
  if (command.heatmap) return draw_heatmap(command, tracer, camera, console);
  const auto bands = plan_bands(command.memory, command.options.size, raytrace_bytes_per_pixel.of(command));
  if (!bands) return fail(bands.error());
  raytrace::RayTracedFrame frame;
  PictureBands picture(command.image, *loaded->world, command.options.size,
                       known_exposure(command.exposure, *loaded->scene));
  const Tracing tracing{command, *loaded, tracer, *lights};
  const bool whole = bands->size() == 1;
  if (whole)
    frame = raytrace::trace_frame(tracer, loaded->plan, camera, *lights, command.options);
  else if (const auto traced = trace_in_bands(tracing, *bands, picture, frame, console); !traced)
    return fail(traced.error());
  if (frame.non_finite > 0)
    console.note(fmt::format("{} samples of the picture were not finite; they are black.", frame.non_finite));
  const PictureWriter writer{
      .picture =
          [&](const std::string& place) {
            return whole ? write_whole(command, *loaded, frame, place) : picture.finish(place);
          },
      .json =
          [&](const RenderRecord& record) {
            return render_json(record, tracer, raytrace::accel_name(command.accel), command.options, frame);
          }};
  return hand_out(command, *loaded, writer, watch, console);
}

}  // namespace

GNOMON_COMMAND(raytrace, 30, "Render with rays only: a PNG, or an EXR with its records.") {
  app->footer(
      "gnomon raytrace whitted -o whitted.png\n"
      "gnomon raytrace model.glb --size 1920x1080 -o model.exr\n"
      "gnomon raytrace whitted --aa 16 --indirect-samples 64 -o soft.png\n"
      "gnomon raytrace stadium --accel grid --heatmap triangles -o heat.png");
  const auto command = std::make_shared<RaytraceCommand>();
  add_picture_subject(*app, *command, command->options.size,
                      ".png, or .exr with depth, position, normal, ids and, per light, visibility [default "
                      "out/NAME-raytrace.png]");
  add_light(*app, command->light,
            "put this light's visibility only into the .exr; the picture always has all lights");
  add_pose_options(*app, command->poses);
  add_tracer_options(*app, command->accel, command->precision);
  add_heatmap(*app, command->heatmap);
  add_min_contribution(*app, command->options.min_contribution);
  add_samples(*app, command->options.shadow_samples);
  add_picture_samples(*app, command->samples);
  app->add_flag("--terminator-offset", command->options.terminator_offset,
                "start the picture's shadow rays on the smooth body that vertex normals tell, so that the "
                "border of light "
                "does not follow the facets (Hanika 2021) [default off]");
  add_seed(*app, command->options.seed, "of every sample");
  add_picture_manner(*app, *command, "threads of the ray tracer", "what was traced, costs and times");
  app->callback([command, &invocation, app] {
    note_call(*app, invocation, *command);
    invocation.action = [command] { return run_raytrace(*command); };
  });
}

}  // namespace gnomon::app
