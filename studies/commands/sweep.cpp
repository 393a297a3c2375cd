// gnomon sweep: many settings of compare in one process, what does not change being made once.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>

#include "app/commands.h"
#include "app/options/option_kinds.h"
#include "app/options/values.h"
#include "app/outputs/run_files.h"
#include "app/process/interrupt.h"
#include "app/process/machine.h"
#include "app/session.h"
#include "app/strongest_lights.h"
#include "compare/result/figures.h"
#include "raster/programs/shader_folder.h"
#include "scene/base/expected.h"
#include "scene/base/timing.h"
#include "scene/files/own_program.h"
#include "scene/files/path_status.h"
#include "scene/files/write_file.h"
#include "studies/commands/make_cells.h"
#include "studies/commands/sweep_command.h"
#include "studies/sweep/cell_files.h"
#include "studies/sweep/page.h"
#include "studies/sweep/ray_points.h"

namespace gnomon::app {

namespace {

Expected<Plan> plan_of(const SweepCommand& command) {
  auto grid = command.options.grid(command.zip);
  if (!grid) return fail(grid.error());
  return make_plan(std::move(*grid), command.shard);
}

/// The constant biases that the sweep runs through.
std::vector<raster::Bias> bias_axis(const studies::Grid& grid) {
  std::vector<raster::Bias> biases;
  for (const studies::Axis& axis : grid.axes()) {
    if (axis.name != "bias") continue;
    for (const std::string& text : axis.values)
      if (const auto value = raster::parse_bias(text)) biases.push_back({value->constant, value->unit});
  }
  return biases;
}

/// The ray tracer's own points, made by the first shard.
Expected<void> measure_ray_tracer(const SweepCommand& command, const Plan& plan, const LoadedScene& loaded,
                                  LightSelection& selection, Console& console) {
  if (!command.ray_tracer || command.shard.part != 1) return {};
  const auto measured = is_there(studies::ray_points_path(command.folder), ErrorKind::cannot_write);
  if (!measured) return fail(measured.error());
  if (*measured) return {};
  auto options = command.options.parse_cell(plan.grid, 0);
  if (!options) return fail(options.error());
  set_runs(command, options->options);
  options->options.raytrace.warm_up = true;
  options->options.raytrace.seed = command.seed;
  Scene given;
  given.camera = loaded.scene->camera;
  given.lights = selection.kept(named_lights(options->light), options->poses);
  const auto setting = resolve_setting(*options, given, *loaded.world);
  if (!setting) return fail(setting.error());
  const Camera given_camera = std::exchange(loaded.scene->camera, setting->camera);
  const std::vector<Light> given_lights = std::exchange(loaded.scene->lights, setting->lights);
  console.progress("the ray tracer's own points", 1.0);
  const auto points =
      studies::measure_ray_points(*loaded.world, setting->accel, setting->compared, setting->raytrace);
  loaded.scene->camera = given_camera;
  loaded.scene->lights = given_lights;
  const OutputGuard whole_file;
  return write_file_in(command.folder, studies::ray_points_name, studies::ray_points_json(points));
}

/// Cells that another OpenGL drew differ by more than the option that the sweep varies.
Expected<void> check_same_drawer(const studies::Journal& journal, const raster::ContextInfo& info) {
  if (journal.size() == 0) return {};
  const std::string& before = journal.drawer();
  const std::string now = info.backend + ", " + info.renderer;
  if (before == now) return {};
  return fail(ErrorKind::usage,
              fmt::format("the folder's cells were drawn by {}, and {} would draw the others; choose "
                          "--backend, another folder, or --restart",
                          before, now));
}

Expected<void> fill(const SweepCommand& command, const Plan& plan, LoadedScene& loaded,
                    LightSelection& selection, studies::Journal& journal, Console& console) {
  const auto renderer = make_renderer(command.backend, loaded, console, command.shader_folder);
  if (!renderer) return fail(renderer.error());
  if (const auto same = check_same_drawer(journal, (*renderer)->info()); !same) return same;
  studies::Engine engine(*loaded.scene, *loaded.world, **renderer, command.perceptual);
  if (command.asked.is_filmed()) {
    const StageSource source = stage_source(command);
    const auto film = resolve_film(command.asked.film, loaded.paths, *loaded.scene, console, &source);
    if (!film) return fail(film.error());
    engine.film_with(*film);
  }
  if (const auto looked = look_from_views(command, loaded, *loaded.scene, engine, console); !looked)
    return looked;
  SweepRun run{command,
               plan,
               loaded,
               selection,
               {},
               machine_info(),
               engine,
               {command.folder, engine},
               PicturedCells(plan.grid.cells()),
               console};
  run.given.camera = loaded.scene->camera;
  run.given.lights = loaded.scene->lights;
  if (auto made = run.pictures.make_folders(); !made) return made;
  if (auto biases = bias_axis(plan.grid); !biases.empty()) engine.expect_biases(std::move(biases));
  if (auto made = make_cells(run, journal); !made) return made;
  const studies::EngineWork& work = engine.work();
  if (work.renders > 0)
    console.message(fmt::format(
        "{} cell{} drawn{}; ray traced {}", work.renders, work.renders == 1 ? "" : "s",
        work.derived > 0 ? fmt::format(", {} more derived from these drawings", work.derived) : std::string(),
        work.truths == 1 ? std::string("once") : fmt::format("{} times", work.truths)));
  return time_rounds(run, journal);
}

Expected<ExitCode> announce(const SweepCommand& command, const studies::Headline& headline) {
  Annotation limit{.about = command.scene.name, .name = "all cells"};
  for (const std::string& line : headline.lines()) {
    if (!command.quiet) print_data(one_line(line) + "\n");
    limit.said += (limit.said.empty() ? "" : " ") + line;
  }
  if (command.max_error) limit.name = "--max-error " + compare::threshold_text(*command.max_error);
  if (!headline.limit_met) limit.outcome = Annotation::Outcome::exceeded;
  if (auto put = put_annotations(command.annotate, "sweep", {&limit, 1}); !put) return fail(put.error());
  return headline.limit_met ? ExitCode::done : ExitCode::threshold_exceeded;
}

Expected<ExitCode> run_on_slurm(const SweepCommand& command) {
  Console console(command.quiet);
  if (command.shard.of != 1)
    return fail(ErrorKind::usage, "--slurm: it makes the shards itself; leave out --shard");
  if (const auto plan = plan_of(command); !plan) return fail(plan.error());
  const std::string program = own_program().string();
  if (program.empty()) return fail(ErrorKind::graphics, "--slurm: cannot find the program itself");
  const std::string folder = std::filesystem::absolute(command.folder).lexically_normal().string();
  if (holds_line_break(program + folder + task_arguments(command)))
    return fail(ErrorKind::usage, "--slurm: a path or name holds a line break, which a batch script cannot");
  if (const auto made = make_output_folder(command.folder); !made) return fail(made.error());
  const std::string script_name = "slurm.sh", script = folder + "/" + script_name;
  const int tasks = *command.slurm_tasks;
  if (const auto written =
          write_file_in(folder, script_name, slurm_script(program, task_arguments(command), folder, tasks));
      !written)
    return fail(written.error());
  console.message(fmt::format("submitting {} task{}, then waiting", tasks, tasks == 1 ? "" : "s"));
  if (const auto done = run_slurm_array(script, folder, tasks); !done) return fail(done.error());
  const OutputGuard whole_outputs;
  if (command.restart) {
    if (auto gone = studies::discard_sweep(folder); !gone) return fail(gone.error());
  }
  const auto merged =
      studies::merge_sweeps(shard_folders(folder, tasks), folder, command.report_max_mb, command.max_error);
  if (!merged) return fail(merged.error());
  if (merged->page.beside) console.note(beside_note(merged->page.page_mb, command.report_max_mb));
  if (merged->drawers.size() > 1)
    console.note(fmt::format("not all cells were drawn alike: {}", fmt::join(merged->drawers, "; ")));
  console.message(fmt::format("sweep: {}/report.html, {} cell{}", command.folder, merged->cells,
                              merged->cells == 1 ? "" : "s"));
  return announce(command, merged->page.headline);
}

Expected<ExitCode> run_sweep(SweepCommand& command) {
  const Stopwatch total;
  if (view_measure(command).needs == compare::FigureNeeds::perception) command.perceptual = true;
  if (const auto fine = check_film_use(command.asked); !fine) return fail(fine.error());
  const auto is_given = [&](std::string_view name) { return !command.options.values_given(name).empty(); };
  if (const auto fine =
          check_views(command.views, command.camera, command.asked.film, command.asked.is_filmed(), is_given);
      !fine)
    return fail(fine.error());
  const bool several = command.views.by_cameras() || follows_path(command.asked.film);
  if (several && command.ray_tracer)
    return fail(ErrorKind::usage, "--ray-tracer: its points are of one camera, not of --cameras or --path");
  if (command.folder.empty()) command.folder = default_output(command.scene.name) + "-sweep";
  RunFiles files;
  files.reads(command.scene);
  files.reads(path_file(command.asked.film));
  files.reads_shaders(command.shader_folder);
  files.writes("--trace", command.trace);
  files.writes("--annotate", command.annotate.path);
  files.writes_folder("-o", command.folder, studies::sweep_file_names);
  if (const auto fine = files.check(); !fine) return fail(fine.error());
  if (command.slurm_tasks) return run_on_slurm(command);
  Console console(command.quiet);
  auto plan = plan_of(command);
  if (!plan) return fail(plan.error());
  const auto shaders = raster::ShaderFolder::read(command.shader_folder);
  if (!shaders) return fail(shaders.error());
  command.replaced_shaders = shaders->replaced();
  auto loaded = load(command.scene, files, console, 0, command.camera, command.asked.is_filmed() || several,
                     true, command.views.by_cameras());
  if (!loaded) return fail(loaded.error());
  LightSelection selection(*loaded, command.max_lights);
  if (const auto named = command.options.values_given("light"); selection.leaves_out(named)) {
    console.note(selection.note(named));
    loaded->scene->notes.push_back(selection.note(named));  // for the page and the JSON
  }
  if (command.exposure) loaded->scene->exposure = *command.exposure;
  if (command.restart) {
    if (auto gone = studies::discard_sweep(command.folder); !gone) return fail(gone.error());
  }
  const studies::SweepHeader header =
      studies::make_header(configuration(command, *plan, *loaded->scene), plan->grid.cells(), command.shard);
  auto journal = studies::Journal::open(command.folder, header, plan->axes, plan->cells);
  if (!journal) return fail(journal.error());
  if (journal->was_torn()) console.note("the last line was torn; its cell is made anew");
  if (journal->size() > 0)
    console.message(fmt::format("{} of {} cell{} there already", journal->size(), plan->cells.size(),
                                plan->cells.size() == 1 ? " is" : "s are"));
  if (auto measured = measure_ray_tracer(command, *plan, *loaded, selection, console); !measured)
    return fail(measured.error());
  if (!has_all_rounds(command, *journal, plan->cells.size())) {
    if (auto filled = fill(command, *plan, *loaded, selection, *journal, console); !filled)
      return fail(filled.error());
  }
  const auto written = [&command] {
    const OutputGuard whole_page;
    return studies::write_sweep_page(command.folder, command.report_max_mb, command.max_error);
  }();
  if (!written) return fail(written.error());
  if (written->beside) console.note(beside_note(written->page_mb, command.report_max_mb));
  const std::size_t cells = plan->cells.size();
  console.message(
      cells == 0 ? fmt::format("sweep: {}, no cell falls to this shard, so there is no page", command.folder)
                 : fmt::format("sweep: {}/report.html, {} cell{}, {:.1f} s", command.folder, cells,
                               cells == 1 ? "" : "s", total.elapsed_ms() / 1000.0));
  return announce(command, written->headline);
}

Expected<studies::Shard> parse_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  const auto wrong = [&text] {
    return fail(ErrorKind::usage, fmt::format("not a shard (got {}, allowed 1/N to N/N)", text));
  };
  if (slash == std::string::npos) return wrong();
  const auto of = parse_integer(text.substr(slash + 1), 1, 10000);
  if (!of) return wrong();
  const auto part = parse_integer(text.substr(0, slash), 1, *of);
  if (!part) return wrong();
  return studies::Shard{static_cast<int>(*part), static_cast<int>(*of)};
}

void add_options(CLI::App& app, SweepCommand& command) {
  add_scene(app, command.scene);
  add_scene_time(app, command.scene);
  add_camera(app, command.camera);
  add_output(app, "-o,--output", command.folder, "DIR",
             "folder for report.html, sweep.jsonl, sweep.csv and the times; a sweep that was interrupted "
             "there goes on "
             "[default out/NAME-sweep]");
  command.options.add_to(app);
  add_max_lights(app, command.max_lights);
  app.add_flag("--zip", command.zip,
               "take the first values of all lists, then the second ones, … instead of all combinations "
               "[default off]");
  app.add_option_function<std::string>(
         "--shard",
         [&command](const std::string& text) {
           const auto shard = parse_shard(text);
           if (!shard) throw CLI::ValidationError("--shard", shard.error().reason);
           command.shard = *shard;
         },
         "make the K-th of N shares of the cells; gnomon merge puts the folders together [1/N to N/N; "
         "default "
         "1/1]")
      ->type_name("K/N");
  app.add_option_function<std::string>(
         "--slurm",
         [&command](const std::string& text) {
           const auto tasks = parse_integer(text, 1, 10000);
           if (!tasks) throw CLI::ValidationError("--slurm", tasks.error().reason);
           command.slurm_tasks = static_cast<int>(*tasks);
         },
         "submit the sweep as a job array of N shards through sbatch, wait, and merge them; DIR must be on a "
         "file "
         "system that the nodes share [tasks, 1 to 10000; default none]")
      ->type_name("N");
  app.add_flag("--perceptual", command.perceptual,
               "also FLIP and SSIM for every cell, which cost more than all the rest [default off]");
  app.add_flag(
      "--ray-tracer", command.ray_tracer,
      "also time the ray tracer's precisions, and its samples of lights with size, at the first cell's "
      "camera and lights, as points of the report's chart; ray_tracer.json has them [default off]");
  app.add_flag(
      "--full-records", command.full_records,
      "also write each cell's curve of every bias, biases in engines' units and the effects into its line "
      "of sweep.jsonl, which is then five times as long [default off]");
  app.add_flag("--restart", command.restart, "discard what the folder holds of a sweep [default off]");
  add_measured_limit(
      app, "--max-error", {command.asked.measure, command.max_error},
      "name the cheapest cell whose every light has at most this error, and exit with 1 when there "
      "is none; flip includes --perceptual",
      "none", true);
  add_annotate(app, command.annotate);
  add_film_options(app, command.asked.film);
  add_view_options(app, command.views);
  add_report_max_mb(app, command.report_max_mb);
  add_run_options(app, command);
  add_shader_dir(app, command.shader_folder);
  add_runs(app, command.runs,
           fmt::format("{}, of cells in rounds; of rays no further one once those made took {:g} ms together",
                       usual_runs, usual_enough_ms)
               .c_str());
  add_quiet(app, command.quiet);
}

}  // namespace

GNOMON_COMMAND(
    sweep, 70,
    "Compare at many settings. Each option of compare takes a list (128,512), a range of COUNT values "
    "(START:END:COUNT) or a range by a factor (START:END:xFACTOR); every combination is one cell.") {
  app->footer(
      "gnomon sweep fence --bias 0:0.1:64                   64 biases from one drawing\n"
      "gnomon sweep courtyard --map-size 128:8192:x2 --slope-bias 0,1,2 -o sizes\n"
      "gnomon sweep fence --map-size 256:4096:x2 --technique hard,pcf --max-error mean:0.5%\n"
      "gnomon sweep courtyard --technique hard,pcf,csm,lispsm --snap off,on --measure shimmer --frames 24\n"
      "gnomon sweep model.glb --camera-orbit 0,30:330,30:12    a path around it\n"
      "gnomon sweep model.glb --map-size 256,512 --bias 0.5texel,1texel --zip");
  const auto command = std::make_shared<SweepCommand>();
  add_options(*app, *command);
  bind_run(*app, invocation, command, run_sweep);
}

}  // namespace gnomon::app
