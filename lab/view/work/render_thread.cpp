#include "lab/view/work/render_thread.h"

#include <fmt/core.h>

#include <chrono>
#include <exception>

#include "lab/view/work/priority.h"
#include "scene/base/interruptible.h"
#include "scene/base/threads.h"

namespace gnomon::lab {

namespace {

constexpr std::chrono::milliseconds file_interval{500};  // between looks at the files
constexpr double soon_ms = 2000.0;  // what is drawn within that is drawn, so that dragging shows something

}  // namespace

const Rgb8Image* picture_of(const Snapshot& shown, Picture view) {
  const ComparisonOutcome* outcome = shown.outcome.get();
  if (outcome == nullptr || view == Picture::raster) return shown.live.picture.get();
  return &outcome->picture(view);
}

RenderThread::RenderThread(MakeContext context, SceneSource first, StudioOptions options,
                           std::function<void()> wake)
    : context_(std::move(context)),
      options_(std::move(options)),
      wake_(std::move(wake)),
      first_(std::move(first)),
      published_(std::make_shared<const Snapshot>()),
      turns_({[this] { first_turn(); }, [this](bool wait) { return turn(wait); },
              [this] { studio_.reset(); }}) {}  // while its context is current there

RenderThread::~RenderThread() {
  {
    const std::lock_guard lock(mutex_);
    quit_ = true;
  }
  changed_.notify_one();
}

void RenderThread::post(std::uint64_t scene, DrawOrder order) {
  {
    const std::lock_guard lock(mutex_);
    asked_order_ = std::pair{scene, std::move(order)};
    newer_waits_ = true;
  }
  changed_.notify_one();
}

void RenderThread::open(app::SceneArgument scene, std::string camera) {
  {
    const std::lock_guard lock(mutex_);
    asked_scene_.emplace(std::move(scene), std::move(camera));
    newer_waits_ = true;
    other_scene_waits_ = reads_ && asked_scene_->first.name != *reads_;
  }
  changed_.notify_one();
}

std::shared_ptr<const Snapshot> RenderThread::snapshot() const {
  const std::lock_guard lock(mutex_);
  return published_;
}

void RenderThread::give_back(std::shared_ptr<const Snapshot> snapshot) {
  {
    const std::lock_guard lock(mutex_);
    given_back_.push_back(std::move(snapshot));
  }
  changed_.notify_one();
}

/// A comparison has finished: from the worker's thread.
void RenderThread::wake_thread() {
  {
    const std::lock_guard lock(mutex_);
    finished_ = true;
  }
  changed_.notify_one();
}

void RenderThread::publish() {
  if (studio_) {
    now_.live = studio_->live();
    now_.outcome = studio_->outcome();
    now_.shadow_times = studio_->shadow_times();
  }
  auto snapshot = std::make_shared<const Snapshot>(now_);
  {
    const std::lock_guard lock(mutex_);
    published_ = std::move(snapshot);
  }
  wake_();
}

RenderThread::Task RenderThread::next_task(bool wait) {
  std::vector<std::shared_ptr<const Snapshot>> given_back;  // freed last, without the lock
  std::unique_lock lock(mutex_);
  if (wait)
    changed_.wait_for(lock, file_interval, [this] {
      return quit_ || asked_scene_ || asked_order_ || finished_ || !given_back_.empty();
    });
  given_back.swap(given_back_);
  Task task;
  task.quit = quit_;
  newer_waits_ = other_scene_waits_ = false;
  task.open = std::exchange(asked_scene_, std::nullopt);
  finished_ = false;
  if (auto asked = std::exchange(asked_order_, std::nullopt);
      asked && now_.scene && asked->first == now_.scene->number)
    task.order = std::move(asked->second);
  return task;
}

void RenderThread::first_turn() {
  give_way(drawing_gives_way);  // and so do the threads of its OpenGL in software
  try {
    install(*first_, false);
    first_.reset();
  } catch (const std::exception& error) {
    give_up(error);
  }
}

bool RenderThread::turn(bool wait) {
  if (gave_up_) return false;
  const Task task = next_task(wait);
  if (task.quit) return false;
  try {
    work_on(task);
  } catch (const std::exception& error) {
    give_up(error);
  }
  return !gave_up_;
}

void RenderThread::give_up(const std::exception& error) {
  gave_up_ = true;
  now_.unreadable = unforeseen(error);
  publish();
}

void RenderThread::work_on(const Task& task) {
  if (task.open) read_scene(task.open->first, task.open->second, false);
  read_changed_files();
  if (task.order) {
    last_order_ = task.order;
    if (std::exchange(only_said_, false)) now_.unreadable.reset();
  }
  if (last_order_ && studio_) carry_out(*last_order_);
}

std::optional<Expected<SceneSource>> RenderThread::read(const app::SceneArgument& argument,
                                                        const std::string& camera) {
  const auto reads = [this](std::optional<std::string> name) {
    const std::lock_guard lock(mutex_);
    other_scene_waits_ = name && asked_scene_ && asked_scene_->first.name != *name;
    reads_ = std::move(name);
  };
  reads(argument.name);
  std::optional<Expected<SceneSource>> source;
  {
    const Interruptible reading([this] { return quit_ || other_scene_waits_; });
    try {
      source = read_source(argument, camera, options_);
    } catch (const Interrupted&) {
    }
    if (reading.has_ended()) source.reset();
  }
  reads({});
  return source;
}

void RenderThread::read_scene(const app::SceneArgument& argument, const std::string& camera, bool again) {
  now_.opening = true;
  if (!again) now_.unreadable.reset();  // it was another scene
  publish();
  const auto source = read(argument, camera);
  now_.opening = false;
  if (!source) return;
  if (*source) return install(**source, again);
  now_.unreadable = source->error();
  only_said_ = !again;
  publish();
}

/// What was shown of a scene that is read again must be drawable with it, too: a shader may fail only then.
Expected<std::unique_ptr<Studio>> RenderThread::make_studio(const SceneSource& source, bool& again) {
  auto context = context_();
  if (!context) return fail(context.error());
  auto studio = Studio::create(
      std::move(*context), source.loaded, options_.compare, options_.shader_folder, [this] { wake_thread(); },
      [this] { return is_overtaken(); });
  if (!studio) return studio;
  again = again && last_order_ && (*studio)->given().lights.size() == last_order_->setup.lights.size();
  if (!again) return studio;
  must_finish_ = true;
  const auto drawn = (*studio)->draw(*last_order_);
  must_finish_ = false;
  if (!drawn) return fail(drawn.error());
  return studio;
}

/// Where a new studio for the scene cannot be made the one before stays.
void RenderThread::install(const SceneSource& source, bool again) {
  const auto fail_with = [this, again](const Error& error) {
    now_.unreadable = error;
    only_said_ = !again;
    publish();
  };
  const auto map = first_map_options(source.argument);
  if (!map) return fail_with(map.error());
  auto studio = make_studio(source, again);
  if (!studio) return fail_with(studio.error());
  studio_ = std::move(*studio);
  scene_files_.watch(source.files);
  if (!options_.shader_folder.empty()) shader_files_.watch({options_.shader_folder});
  auto scene = std::make_shared<OpenedScene>();
  scene->number = now_.scene ? now_.scene->number + 1 : 1;
  scene->again = again;
  scene->argument = source.argument;
  scene->camera = source.camera;
  scene->name = source.loaded->scene->name;
  scene->given = studio_->given();
  scene->lights_left_out = source.loaded->lights_left_out;
  scene->map = *map;
  now_ = Snapshot{};
  now_.scene = std::move(scene);
  now_.max_map_size = studio_->context_info().max_map_size;
  now_.renderer = studio_->context_info().renderer;
  if (!again) last_order_.reset();
  publish();
}

void RenderThread::read_changed_files() {
  if (!now_.scene) return;
  const bool scene = scene_files_.changed(), shaders = shader_files_.changed();
  if (scene || shaders) read_scene(now_.scene->argument, now_.scene->camera, true);
}

bool RenderThread::is_overtaken() const {
  return quit_ || (!must_finish_ && newer_waits_ && since_order_.elapsed_ms() > soon_ms);
}

void RenderThread::carry_out(const DrawOrder& order) {
  since_order_ = Stopwatch();
  const std::uint64_t live = studio_->live().revision;
  const auto outcome = studio_->outcome();
  const auto shadow_times = studio_->shadow_times();
  const auto already = [&](const std::optional<Snapshot::Failure>& failure) {
    return failure && failure->revision == order.revision;
  };
  if (already(now_.undrawable)) return;
  if (const auto drawn = studio_->draw(order); !drawn) {
    if (is_overtaken()) return;
    now_.undrawable = Snapshot::Failure{order.revision, drawn.error()};
    return publish();
  }
  now_.undrawable.reset();
  if (studio_->live().revision != live) publish();
  if (already(now_.incomparable)) return;
  if (const auto compared = studio_->compare(order); !compared) {
    if (is_overtaken()) return;
    now_.incomparable = Snapshot::Failure{order.revision, compared.error()};
    publish();
  } else if (studio_->outcome() != outcome || studio_->shadow_times() != shadow_times) {
    now_.incomparable.reset();
    publish();
  }
}

}  // namespace gnomon::lab
