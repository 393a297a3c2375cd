#include "app/options/options.h"

#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cmath>

#include "app/lesson_scene.h"
#include "app/options/option_kinds.h"
#include "app/session.h"
#include "compare/result/figures.h"
#include "scene/files/path_status.h"
#include "scene/load.h"
#include "scene/shapes/tessellate.h"

namespace gnomon::app {

namespace {

constexpr std::pair<std::string_view, raster::Backend> backends[] = {
    {"auto", raster::Backend::automatic},
    {"osmesa", raster::Backend::osmesa},
    {"egl", raster::Backend::egl},
    {"egl-software", raster::Backend::egl_software},
    {"egl-hardware", raster::Backend::egl_hardware}};
constexpr std::pair<std::string_view, raytrace::Precision> precisions[] = {
    {"fast", raytrace::Precision::fast},
    {"robust", raytrace::Precision::robust},
    {"exact", raytrace::Precision::exact}};

// Ranges that no struct states. Each is far beyond what is useful and short of what overflows a float.
/// --accel's words.
std::span<const std::pair<std::string_view, raytrace::Accel>> accels() {
  static const auto named = [] {
    std::vector<std::pair<std::string_view, raytrace::Accel>> list;
    for (const raytrace::Accel accel : raytrace::all_accels()) list.emplace_back(accel_name(accel), accel);
    return list;
  }();
  return named;
}
constexpr int max_threads = 1024;
constexpr int max_runs = 1000;

}  // namespace

void add_scene(CLI::App& command, SceneArgument& scene) {
  command.add_flag("--allow-outside", scene.allow_outside,
                   "let the scene name files outside its own folder [default off]");
  static constexpr std::pair<std::string_view, InstanceChoice> choices[] = {
      {"auto", InstanceChoice::automatic},
      {"keep", InstanceChoice::keep},
      {"flatten", InstanceChoice::flatten}};
  add_choice(
      command, "--instances", scene.instances, choices, "NAME",
      "what becomes of meshes that stand many times: one copy of each is kept, or all are written out, which "
      "is faster and takes more memory; the results are the same. auto takes what gnomon plan says");
  command
      .add_option("SCENE", scene.name,
                  fmt::format("a scene file ({}; {} by way of assimp), or the name of a built-in scene or "
                              "lesson (gnomon scenes)",
                              extensions_text(false), extensions_text(true)))
      ->required();
  command.parse_complete_callback([&] { scene.settings = use_of_settings(command); });
}

void add_scene_time(CLI::App& command, SceneArgument& scene) {
  constexpr OptionRange range{0.0, 1e6};
  add_value(
      command, "--time", "[NAME:]SECONDS",
      describe("the moment of an animation of a glTF file, or of a scene's path, at which objects, camera "
               "and lights stand",
               fmt::format("the first or NAME's; seconds, {}", range_text(range)),
               "off: all stands as it is stored"),
      [&scene, range](const std::string& text) -> Expected<void> {
        const std::size_t colon = text.rfind(':');
        const bool named = colon != std::string::npos;
        auto seconds = parse_number(named ? text.substr(colon + 1) : text, range);
        if (!seconds) return fail(seconds.error());
        scene.time = {named ? text.substr(0, colon) : std::string(), *seconds};
        return {};
      });
}

void add_tessellate(CLI::App& command, int& tessellate) {
  const std::string range = fmt::format("sectors, {} to {}", min_tessellation, max_tessellation);
  add_value(command, "--tessellate", "N",
            describe("make triangles of the exact shapes, to see what that changes: N sectors around, N/2 "
                     "rings, N^3 cells of an implicit surface",
                     range, "off: shapes are exact"),
            [&tessellate](const std::string& value) {
              return assign(tessellate, parse_integer(value, min_tessellation, max_tessellation));
            });
}

void add_size(CLI::App& command, ImageSize& size) {
  add_value(command, "--size", "WxH",
            describe("size of the picture", size_choices(), fmt::format("{}x{}", size.width, size.height)),
            [&size](const std::string& value) { return assign(size, parse_size(value)); });
}

void add_backend(CLI::App& command, raster::Backend& backend) {
  add_choice(command, "--backend", backend, backends, "NAME",
             "where OpenGL comes from; auto tries OSMesa, then EGL in software, then EGL on a GPU; egl takes "
             "a GPU where there is one, egl-hardware nothing else, and egl-software none");
}

std::string backend_argument(raster::Backend backend) {
  for (const auto& [name, choice] : backends)
    if (choice == backend && choice != raster::Backend::automatic) return fmt::format(" --backend {}", name);
  return {};
}

void add_shader_dir(CLI::App& command, std::string& folder) {
  add_value(command, "--shader-dir", "DIR",
            describe("shader files to use instead of the program's own of the same names, such as "
                     "technique/pcf_box.glsl",
                     "a folder", "none"),
            [&folder](const std::string& text) -> Expected<void> {
              const auto there = is_folder(text);  // if nobody can tell, who reads it says so
              if (there && !*there)
                return fail(ErrorKind::usage, fmt::format("no such folder (got {})", text));
              folder = text;
              return {};
            });
}

void add_tracer_options(CLI::App& command, raytrace::Accel& accel, raytrace::Precision& precision) {
  add_choice(command, "--accel", accel, accels(), "NAME",
             "how rays find what they hit; brute tests everything");
  add_precision(command, precision);
}

void add_precision(CLI::App& command, raytrace::Precision& precision) {
  add_choice(
      command, "--precision", precision, precisions, "NAME",
      "arithmetic of the rays: fast is the textbooks' floats, robust is watertight with error bounds, exact "
      "settles what the bounds leave open");
}

void add_accel_list(CLI::App& command, std::vector<raytrace::Accel>& chosen) {
  add_value(command, "--accel", "all|NAME[,NAME]",
            describe("structures to compare", choice_names<raytrace::Accel>(accels(), " or "), "all"),
            [&chosen](const std::string& text) -> Expected<void> {
              const auto all = raytrace::all_accels();
              chosen.assign(all.begin(), all.end());
              if (text == "all") return {};
              chosen.clear();
              for (std::size_t start = 0; start <= text.size();) {
                const std::size_t end = std::min(text.find(',', start), text.size());
                const auto accel = parse_choice<raytrace::Accel>(text.substr(start, end - start), accels());
                if (!accel) return fail(accel.error());
                chosen.push_back(*accel);
                start = end + 1;
              }
              return {};
            });
}

void add_heatmap(CLI::App& command, std::optional<HeatmapOf>& heatmap) {
  static constexpr std::pair<std::string_view, HeatmapOf> choices[] = {{"nodes", HeatmapOf::nodes},
                                                                       {"triangles", HeatmapOf::triangles}};
  add_value(command, "--heatmap", "WHAT",
            describe("instead of the picture, what its primary rays test: boxes, cells or planes of the "
                     "structure, or triangles; dark purple is 0, yellow 4095 and more, the scale logarithmic",
                     choice_names<HeatmapOf>(choices, " or "), "off"),
            [&heatmap](const std::string& text) {
              HeatmapOf what{};
              const Expected<void> stored = assign(what, parse_choice<HeatmapOf>(text, choices));
              if (stored) heatmap = what;
              return stored;
            });
}

void add_min_contribution(CLI::App& command, double& share) {
  add_number(command, "--min-contribution", share, {0.0, 1.0}, "share of a pixel",
             "reflected and refracted rays that matter less are not followed");
}

void add_camera(CLI::App& command, std::string& camera) {
  add_name(command, "--camera", camera, "NAME",
           "of the scene's cameras, the one to look through [a name, or a number from 0; default the first]");
}

void add_light(CLI::App& command, std::string& light, const char* what) {
  add_name(command, "--light", light, "NAME", fmt::format("{} [a light's name; default all]", what));
}

void add_engine(CLI::App& app, const compare::TunedEngine*& engine, const char* what, const char* fallback) {
  std::vector<std::string_view> keys;
  for (const compare::TunedEngine& known : compare::tuned_engines()) keys.push_back(known.key);
  const std::string names = fmt::format("{}", fmt::join(keys, " or "));
  add_value(app, "--engine", "NAME", describe(what, names, fallback),
            [&engine, keys](const std::string& text) -> Expected<void> {
              engine = compare::find_engine(text);
              if (engine != nullptr) return {};
              return fail(ErrorKind::usage, fmt::format("unknown engine (got {}, allowed {}){}", text,
                                                        fmt::join(keys, ", "), did_you_mean(text, keys)));
            });
}

void add_threads(CLI::App& command, int& threads, const char* of_what) {
  add_integer(command, "--threads", threads, 0, max_threads, "0 means all cores", of_what);
}

void add_runs(CLI::App& command, std::optional<int>& runs, const char* fallback) {
  add_value(command, "--runs", "N",
            describe("timed repetitions of each pass, after one that is not timed",
                     fmt::format("1 to {}", max_runs), fallback),
            [&runs](const std::string& value) { return assign(runs, parse_integer(value, 1, max_runs)); });
}

void add_exposure(CLI::App& command, std::optional<std::optional<double>>& exposure) {
  add_value(
      command, "--exposure", "auto|FACTOR",
      describe(
          "factor on linear colour before 8-bit pictures are encoded; auto brings the 95th percentile of the "
          "luminance to 0.8",
          "auto, or linear, " + range_text(exposure_range), "the scene's own, or else auto"),
      [&exposure](const std::string& value) -> Expected<void> {
        const Expected<std::optional<double>> parsed = parse_exposure(value);
        if (!parsed) return fail(parsed.error());
        exposure = *parsed;
        return {};
      });
}

void add_seed(CLI::App& command, std::uint64_t& seed, const char* what) {
  add_value(command, "--seed", "N", describe(what, "0 to 18446744073709551615", std::to_string(seed)),
            [&seed](const std::string& value) { return assign(seed, parse_unsigned(value)); });
}

void add_samples(CLI::App& command, int& samples) {
  add_value(command, "--samples", "N",
            describe("rays from each point to a light with size", fmt::format("1 to {}", max_shadow_samples),
                     "the light's shadow_samples, 64"),
            [&samples](const std::string& value) {
              return assign(samples, parse_integer(value, 1, max_shadow_samples));
            });
}

void add_ray_count(CLI::App& command, std::uint64_t& rays) {
  constexpr OptionRange range{1e3, 1e12};
  add_value(command, "--rays", "N",
            describe("rays of each row of the table; costly rows take a fixed share of it", range_text(range),
                     number_text(static_cast<double>(rays))),
            [&rays, range](const std::string& text) -> Expected<void> {
              const Expected<double> value = parse_number(text, range);
              if (!value) return fail(value.error());
              if (std::trunc(*value) != *value)
                return fail(ErrorKind::usage, fmt::format("is not a whole number (got {}, allowed {})", text,
                                                          range_text(range)));
              rays = static_cast<std::uint64_t>(*value);
              return {};
            });
}

void add_checked(CLI::App& command, const std::string& name, const char* type, const std::string& text,
                 const std::function<Expected<void>(const std::string&)>& store) {
  add_value(command, name, type, text, store);
}

namespace {

std::vector<std::string_view> measure_names(bool filmed) {
  std::vector<std::string_view> names;
  for (const compare::Figure& figure : compare::figures())
    if (!figure.measure.name.empty() && (filmed || figure.needs != compare::FigureNeeds::film))
      names.push_back(figure.measure.name);
  return names;
}

Expected<void> store_limit(const std::string& value, MeasuredLimit asked, bool filmed) {
  const auto parsed = parse_threshold(value, *asked.measure);
  if (!parsed) return fail(parsed.error());
  const bool of_film = parsed->measure->needs == compare::FigureNeeds::film;
  if (of_film && !filmed)
    return fail(ErrorKind::usage,
                fmt::format("a still picture has no flips (got {}; gnomon shimmer counts them)", value));
  if (asked.measure != &compare::wrong_and_mean() && parsed->measure != asked.measure)
    return fail(ErrorKind::usage, fmt::format("is no limit of --measure {0} (got {1}, allowed {0}:LIMIT)",
                                              asked.measure->measure.name, value));
  if (of_film) asked.measure = parsed->measure;
  asked.limit = *parsed;
  return {};
}

}  // namespace

// Options are parsed in the order in which they are added, so the limit knows the measure.
void add_measured_limit(CLI::App& command, const std::string& name, MeasuredLimit asked,
                        std::string_view what, std::string_view fallback, bool filmed) {
  const std::vector<std::string_view> names = measure_names(filmed);
  const std::string film =
      filmed ? "; shimmer: flips per receiver and second of a film, as gnomon shimmer makes it" : "";
  add_value(command, "--measure", "NAME",
            describe("what errors are counted in: the share of wrong pixels, the mean error of visibility, "
                     "FLIP, or how far edges are off, in texels" +
                         film,
                     fmt::format("{}", fmt::join(names, " or ")), "the larger of wrong and mean"),
            [&measure = asked.measure, names](const std::string& text) -> Expected<void> {
              if (std::find(names.begin(), names.end(), text) == names.end())
                return fail(ErrorKind::usage, fmt::format("unknown value (got {}, allowed {}){}", text,
                                                          fmt::join(names, ", "), did_you_mean(text, names)));
              measure = compare::find_measure(text);
              return {};
            });
  add_value(command, name, "LIMIT", describe(what, compare::threshold_range(filmed), fallback),
            [asked, filmed](const std::string& value) { return store_limit(value, asked, filmed); });
}

std::string measure_argument(const compare::Figure& measure) {
  return &measure == &compare::wrong_and_mean() ? std::string()
                                                : fmt::format(" --measure {}", measure.measure.name);
}

void add_report_max_mb(CLI::App& command, double& megabytes) {
  add_number(
      command, "--report-max-mb", megabytes, {0.0, 1e6}, "megabytes",
      "largest report page that is one file; beyond it pictures and pixels become files beside the page");
}

std::string beside_note(double page_mb, double max_mb) {
  return fmt::format(
      "the page would weigh {:.0f} MB, more than --report-max-mb {:g}: its pictures and pixels are files "
      "beside it; keep the folder together",
      page_mb, max_mb);
}

void add_output(CLI::App& command, const char* names, std::string& path, const char* type,
                const std::string& what) {
  add_name(command, names, path, type, what);
}

void add_json(CLI::App& command, std::string& path, const char* what) {
  add_name(command, "--json", path, "FILE|-",
           fmt::format("write {} as JSON; - means stdout, alone [default off]", what));
}

void add_trace(CLI::App& command, std::string& path) {
  add_value(command, "--trace", "FILE.json",
            "also write the stages of the run in the Trace Event Format, which Perfetto opens [default off]",
            [&path](const std::string& file) -> Expected<void> {
              if (file.empty() || file == "-")
                return fail(ErrorKind::usage, fmt::format("not a file (got {})", file));
              path = file;
              return {};
            });
}

void add_verbose(CLI::App& command, bool& verbose, const char* what) {
  command.add_flag("--verbose,-v", verbose, fmt::format("{} [default off]", what));
}

void add_quiet(CLI::App& command, bool& quiet) {
  command.add_flag("--quiet,-q", quiet, "print nothing but errors and what --json - asks for [default off]");
}

void add_run_options(CLI::App& command, RunOptions& options) {
  add_backend(command, options.backend);
  add_threads(command, options.threads, "threads of the ray tracer and of Mesa's software rasterizer");
  add_exposure(command, options.exposure);
  add_seed(command, options.seed, "of the samples of lights with size; recorded in the result");
}

}  // namespace gnomon::app
