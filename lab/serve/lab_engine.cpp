// CLI11 throws; what is thrown here is caught here.
#include "lab/serve/lab_engine.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "app/options/map_options.h"
#include "app/options/options.h"
#include "compare/bias/bias_curve.h"
#include "compare/result/number_text.h"
#include "lab/view/state/first_state.h"
#include "lab/view/state/status.h"
#include "raster/settings.h"
#include "raster/technique_traits.h"
#include "report/lessons.h"
#include "scene/load.h"

namespace gnomon::lab {

namespace {

bool has_map_options(const std::vector<std::string>& words) {
  const std::vector<std::string> names = app::map_setting_names();
  return std::ranges::any_of(words, [&](const std::string& word) {
    return word.starts_with("--") &&
           std::ranges::find(names, word.substr(2, word.find('=') - 2)) != names.end();
  });
}

/// What --camera is given; empty: nothing.
std::string camera_of(const std::vector<std::string>& words) {
  constexpr std::string_view joined = "--camera=";
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i].starts_with(joined)) return words[i].substr(joined.size());
    if (words[i] == "--camera" && i + 1 < words.size()) return words[i + 1];
  }
  return {};
}

bool is_own_scene(const std::string& name) {
  return find_builtin_scene(name) ||
         std::ranges::any_of(report::all_lessons(),
                             [&](const report::Lesson& lesson) { return lesson.name == name; });
}

// Beyond this a single call of the driver can take seconds, and images gigabytes: gnomon compare takes both.
constexpr ImageSize largest_picture{3840, 2160};
constexpr double most_map_texels = 8192.0 * 8192.0;

/// Nothing that keeps the lab from a newer wish for long.
Expected<void> check_load(const ViewState& state) {
  const Setup& setup = state.setup;
  if (setup.size.pixels() > largest_picture.pixels())
    return fail(ErrorKind::usage,
                fmt::format("--size: the lab draws at most {} x {} pixels (gnomon compare draws more)",
                            largest_picture.width, largest_picture.height));
  const bool has_point_light = std::ranges::any_of(
      state.given.lights, [](const Light& light) { return light.type == LightType::point; });
  const int cascades = raster::follows_camera(setup.map.technique) ? setup.map.cascades.count : 1;
  const int maps = std::max(has_point_light ? 6 : 1, cascades);
  if (const double side = std::sqrt(most_map_texels / maps); setup.map.size > side)
    return fail(ErrorKind::usage,
                fmt::format("--map-size: the lab draws at most {:.0f} texels on a side here (gnomon compare "
                            "draws more)",
                            std::floor(side)));
  return {};
}

/// Returns what a preset leaves undone until its comparison is there: the words for how much of it is seen.
std::string shown_words(const Preset& preset, const compare::LightComparison& light) {
  constexpr double hardly = 0.001;
  const double share = shown_share(preset, light);
  return share >= hardly
             ? fmt::format("{}, on {} of the pixels: {}", preset.title, compare::percent(share), preset.what)
             : fmt::format("{}: this view has hardly any; another scene shows it better", preset.title);
}

}  // namespace

Expected<std::unique_ptr<LabEngine>> LabEngine::start(const LabOptions& options, SceneSource first) {
  const app::LoadedScene& loaded = *first.loaded;
  auto state = first_state(options, given_scene(*loaded.scene, *loaded.world, loaded.paths));
  if (!state) return fail(state.error());
  if (const auto fits = check_load(*state); !fits) return fail(fits.error());
  std::unique_ptr<LabEngine> engine(new LabEngine(options, std::move(*state)));
  StudioOptions studio{options.compare, options.shader_folder, options.exposure, options.tessellate,
                       options.max_lights};
  studio.compare.perceptual = false;  // no view shows it
  engine->admit(options.scene.name, options.scene.name);
  const std::lock_guard lock(engine->mutex_);  // notice() waits until the thread is known
  engine->thread_ = std::make_unique<RenderThread>(
      [backend = options.backend, quiet = options.quiet] {
        app::Console console(quiet);
        return app::make_context(backend, console);
      },
      std::move(first), std::move(studio), [raw = engine.get()] { raw->notice(); });
  return engine;
}

LabEngine::LabEngine(const LabOptions& options, ViewState first) : given_(options) {
  now_.options = options;
  now_.state = std::move(first);
  now_.shown = std::make_shared<const Snapshot>();
  revision_ = now_.state.revision;
}

void LabEngine::admit(const std::string& name, const std::string& path) {
  const std::lock_guard lock(mutex_);
  admitted_.emplace_back(name, path);
}

/// Nothing of a name that may not be opened.
std::string LabEngine::path_of(const std::string& scene) const {
  const auto found = std::find_if(admitted_.rbegin(), admitted_.rend(),
                                  [&](const auto& entry) { return entry.first == scene; });
  if (found != admitted_.rend()) return found->second;
  return is_own_scene(scene) ? scene : std::string();
}

std::string LabEngine::name_of(const std::string& path) const {
  const auto found = std::find_if(admitted_.rbegin(), admitted_.rend(),
                                  [&](const auto& entry) { return entry.second == path; });
  return found != admitted_.rend() ? found->first : path;
}

bool LabEngine::is_of(const LabWish& wish, const OpenedScene& scene) const {
  return scene.argument.name == path_of(wish.scene) && scene.camera == camera_of(wish.words);
}

/// What the words leave out is the default, and of the map, where they say nothing of it, what the scene asks for. No words at all
/// are what the command line asked for, of its scene.
Expected<ViewState> LabEngine::state_of(const std::vector<std::string>& words, const OpenedScene& scene,
                                        LabOptions& options) const {
  options = given_;
  const bool is_first = scene.argument.name == given_.scene.name, sets_map = has_map_options(words);
  options.camera = scene.camera;
  if (!is_first || !words.empty()) options.light.clear(), options.poses = {};
  if (!words.empty()) options.compare.precision = raytrace::Precision::robust;
  if (sets_map || !is_first) options.compare.raster.map = sets_map ? raster::MapOptions{} : scene.map;
  CLI::App command;
  command.set_help_flag();
  app::add_camera(command, options.camera);
  app::add_size(command, options.compare.raster.size);
  app::add_map_options(command, options.compare.raster.map);
  app::add_light(command, options.light, "the light");
  app::add_pose_options(command, options.poses);
  app::add_precision(command, options.compare.precision);
  try {
    std::vector<std::string> reversed(words.rbegin(), words.rend());
    command.parse(reversed);
    if (sets_map) app::finish_map_options(command, options.compare.raster.map);
  } catch (const CLI::ParseError& error) {
    return fail(ErrorKind::usage, error.what());
  }
  if (const auto fine = raster::check_map_options(options.compare.raster.map); !fine)
    return fail(fine.error());
  auto state = first_state(options, scene.given);
  if (!state) return state;
  if (const auto fits = check_load(*state); !fits) return fail(fits.error());
  return state;
}

Expected<void> LabEngine::carry_out(const LabWish& wish, const OpenedScene& scene) {
  LabOptions options;
  auto state = state_of(wish.words, scene, options);
  if (!state) return fail(state.error());
  preset_ = wish.preset ? &presets()[*wish.preset] : nullptr, preset_bias_raised_ = false;
  if (preset_ != nullptr) state->setup.map = preset_->apply(state->setup.map);
  now_.state = std::move(*state);
  now_.options = std::move(options);
  now_.client = wish.client;
  now_.error.clear(), now_.note.clear();
  drawn_ = wish;
  post();
  return {};
}

/// Asks for the state as a new revision.
void LabEngine::post() {
  now_.state.revision = ++revision_;
  ++now_.number;
  thread_->post(scene_, {now_.state.revision, now_.state.setup});
}

Expected<std::uint64_t> LabEngine::ask(const LabWish& wish) {
  const std::lock_guard lock(mutex_);
  const std::string path = path_of(wish.scene);
  if (path.empty())
    return fail(
        ErrorKind::usage,
        fmt::format("{}: no scene of this lab (a file is opened by dropping it on the page)", wish.scene));
  if (wish.preset && *wish.preset >= presets().size()) return fail(ErrorKind::usage, "no such preset");
  const OpenedScene* scene = now_.shown->scene.get();
  if (scene != nullptr && is_of(wish, *scene) && !waiting_) {
    if (const auto done = carry_out(wish, *scene); !done) return fail(done.error());
  } else {
    waiting_ = wish;
    now_.client = wish.client;
    now_.error.clear();
    ++now_.number;
    app::SceneArgument scene_to_open = given_.scene.named(path);
    // What the command line lets its own scene do is not for files that are dropped on the page.
    if (given_.scene.name != path) scene_to_open.allow_outside = false;
    thread_->open(std::move(scene_to_open), camera_of(wish.words));
  }
  changed_.notify_all();
  return now_.number;
}

/// Something has happened: on the render thread.
void LabEngine::notice() {
  const std::lock_guard lock(mutex_);
  look_at(*(now_.shown = thread_->snapshot()));
  ++now_.number;
  changed_.notify_all();
}

LabWish LabEngine::wish_for(const OpenedScene& scene) const {
  if (waiting_) return *waiting_;
  if (drawn_ && is_of(*drawn_, scene)) return *drawn_;
  return {now_.client, scene.argument.name, {}, {}};
}

void LabEngine::look_at(const Snapshot& shown) {
  if (shown.scene && shown.scene->number != scene_) {
    const bool first = scene_ == 0, again = shown.scene->again;
    scene_ = shown.scene->number;
    const LabWish wish = wish_for(*shown.scene);
    if (waiting_ && !is_of(*waiting_, *shown.scene)) {
      post();
    } else if (waiting_ || (!first && !again)) {
      waiting_.reset();
      if (const auto done = carry_out(wish, *shown.scene); !done) now_.error = done.error().message();
    } else {
      now_.state.given = shown.scene->given;
      post();
    }
  }
  const std::string unreadable = shown.unreadable ? shown.unreadable->message() : "";
  if (!unreadable.empty() && unreadable != unreadable_) now_.error = unreadable, waiting_.reset();
  unreadable_ = unreadable;
  for (const auto& failure : {shown.undrawable, shown.incomparable})
    if (failure && failure->revision == now_.state.revision) now_.error = failure->error.message();
  finish_preset(shown);
}

void LabEngine::finish_preset(const Snapshot& shown) {
  if (preset_ == nullptr || !shown.is_done(now_.state)) return;
  const compare::Comparison& comparison = shown.outcome->comparison;
  const compare::LightComparison& light = comparison.lights.front();
  if (preset_->lost_share > 0.0 && !preset_bias_raised_) {
    preset_bias_raised_ = true;
    const double texels =
        losing_bias_texels(comparison.raster.lights[light.record], light, preset_->lost_share);
    raster::Bias& bias = now_.state.setup.map.bias;
    if (texels > bias.constant) {
      bias.constant = texels;
      bias = compare::with_three_digits(bias);
      return post();
    }
  }
  now_.note = shown_words(*preset_, light);
  preset_ = nullptr;
}

LabMoment LabEngine::wait(std::uint64_t after, std::chrono::milliseconds most) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, most, [&] { return now_.number > after; });
  LabMoment moment = now_;
  moment.opening = waiting_.has_value() || !now_.shown->scene;
  if (now_.shown->scene) moment.scene = name_of(now_.shown->scene->argument.name);
  return moment;
}

std::vector<std::string> LabEngine::compare_words(const LabMoment& moment) const {
  std::vector<std::string> words{"compare"};
  if (!moment.shown->scene) return words;
  const app::SceneArgument& scene = moment.shown->scene->argument;
  for (const auto& part : {scene.plain_words(), setting_words(moment.state, moment.options, scene.name)})
    words.insert(words.end(), part.begin(), part.end());
  return words;
}

}  // namespace gnomon::lab
