#include "lab/view/viewer.h"

#include <fmt/core.h>

#include "compare/bias/bias_curve.h"
#include "compare/result/number_text.h"
#include "lab/view/panels/panels.h"
#include "lab/view/state/presets.h"
#include "lab/view/state/status.h"
#include "raster/gl/context.h"
#include "scene/base/expected.h"

namespace gnomon::lab {

namespace {

constexpr double idle_wait_seconds = 1.0;  // between frames when nothing happens
// While a run beside the window is looked after, or pictures are waited for.
constexpr double busy_wait_seconds = 0.1;
constexpr double drawing_wait_seconds = 0.05;  // while a picture is drawn, unless something happens
constexpr glm::u8vec3 surround{24};            // where a picture leaves the window free

/// Colours that stand for something must not be mixed.
raster::Scaling scaling_of(Picture picture, const Look& look) {
  const bool photographic = picture == Picture::raster || picture == Picture::raytrace;
  return photographic && look.zoom == 1.0 ? raster::Scaling::linear : raster::Scaling::nearest;
}

}  // namespace

Expected<std::unique_ptr<Viewer>> Viewer::open(const ViewOptions& options, SceneSource source,
                                               ViewState state, std::vector<ScriptStep> script,
                                               app::Console& console) {
  std::unique_ptr<Viewer> viewer(new Viewer(options, std::move(state), std::move(script), console));
  auto window = Window::open("gnomon", options.compare.raster.size);
  if (!window) return fail(window.error());
  viewer->window_ = std::move(*window);
  viewer->context_ = viewer->window_->context();
  auto presenter = raster::Presenter::create(*viewer->context_);
  if (!presenter) return fail(presenter.error());
  viewer->presenter_ = std::move(*presenter);
  viewer->listen();
  auto interface = Interface::open(*viewer->window_);
  if (!interface) return fail(interface.error());
  viewer->interface_ = std::move(*interface);
  StudioOptions studio{options.compare, options.shader_folder, options.exposure, options.tessellate,
                       options.max_lights};
  studio.compare.perceptual = false;  // no view shows it
  auto context = viewer->choose_context();
  if (!context) return fail(context.error());
  viewer->thread_ = std::make_unique<RenderThread>(std::move(*context), std::move(source), std::move(studio),
                                                   [] { Window::wake(); });
  viewer->shown_ = viewer->thread_->snapshot();
  return viewer;
}

/// A graphics card's own context where the window has one and nothing else is asked for. In software a context of
/// another kind than the window's: those of one kind share threads, and the window would wait for every picture.
Expected<RenderThread::MakeContext> Viewer::choose_context() {
  using Made = Expected<std::unique_ptr<raster::Context>>;
  if (options_.backend != raster::Backend::automatic || raster::draws_in_software(presenter_->renderer()))
    return [backend = options_.backend, quiet = options_.quiet]() -> Made {
      app::Console console(quiet);
      return app::make_context(backend, console);
    };
  if (const auto added = window_->add_hidden_context(); !added) return fail(added.error());
  options_.backend = raster::Backend::egl_hardware;  // what the commands need to draw the same
  return [w = window_.get()]() -> Made { return w->hidden_context(); };
}

Viewer::Viewer(const ViewOptions& options, ViewState state, std::vector<ScriptStep> script,
               app::Console& console)
    : options_(options), console_(console), state_(std::move(state)), script_(std::move(script)) {}

void Viewer::listen() {
  WindowEvents events;
  events.key = [this](const Key& key) { press_key(key); };
  events.button = [this](int button, bool down, const Modifiers& held) { press(button, down, held); };
  events.pointer = [this](double x, double y) { move(x, y); };
  events.scroll = [this](double notches, const Modifiers& held) { scroll(notches, held); };
  events.drop = [this](const std::string& path) { act(OpenScene{path}); };
  window_->listen(std::move(events));
}

void Viewer::press_key(const Key& key) {
  busy_frames_ = 3;
  if (interface_->wants_key(key.code)) return;
  if (const auto action = action_for_key(key)) act(*action);
}

TypeSize Viewer::type() const {
  return type_size(window_->content_scale() * state_.look.ui_scale *
                   (state_.look.large_type ? large_type_factor : 1.0));
}

void Viewer::act(const Action& action) {
  busy_frames_ = 3;
  if (const auto* change = std::get_if<Change>(&action)) {
    const std::uint64_t before = state_.revision;
    lab::carry_out(state_, *change);
    if (state_.revision != before) note_.clear(), preset_ = nullptr;  // it was said of another setting
    return;
  }
  if (const auto* open = std::get_if<OpenScene>(&action)) {
    note("opening " + open->name);
    return thread_->open({open->name, false});
  }
  if (const auto* use = std::get_if<UsePreset>(&action)) {
    preset_ = &presets()[use->preset], preset_bias_raised_ = false;
    lab::carry_out(state_, SetMap{preset_->apply(state_.setup.map)});
    return note(fmt::format("{}: {}", preset_->title, preset_->what));
  }
  carry_out_command(std::get<Command>(action));
}

void Viewer::finish_preset() {
  if (preset_ == nullptr || !shown_->is_done(state_)) return;
  const compare::Comparison& c = shown_->outcome->comparison;
  if (c.lights.empty()) return;
  const compare::LightComparison& light = c.lights.front();
  if (preset_->lost_share > 0.0 && !preset_bias_raised_) {
    preset_bias_raised_ = true;
    const double texels = losing_bias_texels(c.raster.lights[light.record], light, preset_->lost_share);
    raster::MapOptions map = state_.setup.map;
    if (texels > map.bias.constant) {
      map.bias.constant = texels;
      map.bias = compare::with_three_digits(map.bias);
      return lab::carry_out(state_, SetMap{map});
    }
  }
  constexpr double hardly = 0.001;
  const double share = shown_share(*preset_, light);
  note(
      share >= hardly
          ? fmt::format("{}, on {} of the pixels: {}", preset_->title, compare::percent(share), preset_->what)
          : fmt::format("{}: this view has hardly any; another scene shows it better", preset_->title));
  preset_ = nullptr;
}

void Viewer::carry_out_command(Command command) {
  switch (command) {
    case Command::save_screenshot:
      screenshot_asked_ = true;
      return;
    case Command::save_picture:
      return save_picture();
    case Command::copy_command:
      return copy_command();
    case Command::save_scene:
      return save_scene();
    case Command::write_report:
      return write_report();
    case Command::find_best:
      return find_best();
    case Command::stop_job:
      job_.reset();
      return note("stopped");
    case Command::open_menu:
      menu_asked_ = true;
      return;
    case Command::leave:
      if (state_.look.help) return lab::carry_out(state_, SetFlag{&Look::help, false});
      if (interface_->leave_panels()) return;
      if (job_) return carry_out_command(Command::stop_job);
      quit_ = true;
      return;
    case Command::quit:
      quit_ = true;
      return;
  }
}

Expected<void> Viewer::run() {
  while (!quit_ && !window_->should_close()) {
    watch_ = FrameWatch();
    window_->poll();
    follow_layout();
    watch_.end(FramePart::events);
    if (auto ok = take_snapshot(); !ok) return ok;
    watch_.end(FramePart::snapshot);
    if (auto ok = advance_script(); !ok) return ok;
    if (quit_) break;
    follow_layout();
    watch_.end(FramePart::events);
    play_film();
    post_changes();
    look_after_job();
    watch_.end(FramePart::snapshot);
    if (auto ok = draw_frame(); !ok) return ok;
    window_->show_frame();
    watch_.end(FramePart::swap);
    meter_.frame(watch_);
    meter_.shown(*shown_);
    sleep();
  }
  if (job_ && !job_->ended())
    console_.note("the window was closed before this was done: " + job_->status().title);
  if (has_script()) console_.message(meter_.words());
  return {};
}

/// A picture has the size of its pane; an iconified window keeps its last one.
void Viewer::follow_layout() {
  const ImageSize size = window_->framebuffer_size();
  if (size.pixels() == 0) return;
  layout_ = lay_out(size, state_.look, type());
  if (!(layout_.picture == state_.setup.size)) lab::carry_out(state_, Resize{layout_.picture});
}

/// A person's wish that cannot be drawn is taken back, with a word about it; a script's ends the program.
Expected<void> Viewer::take_snapshot() {
  auto snapshot = thread_->snapshot();
  if (snapshot == shown_) return {};
  const std::string told = shown_->unreadable ? shown_->unreadable->message() : "";
  thread_->give_back(std::exchange(shown_, std::move(snapshot)));
  busy_frames_ = 3;
  if (!shown_->scene)
    return shown_->unreadable ? Expected<void>(fail(*shown_->unreadable)) : Expected<void>();
  if (shown_->unreadable && shown_->unreadable->message() != told) {
    if (has_script() && shown_->unreadable->kind != ErrorKind::bad_input) return fail(*shown_->unreadable);
    note(*shown_->unreadable);
  }
  if (!shown_->unreadable && !told.empty() && note_ == one_line(told)) note_.clear();  // it was mended
  if (shown_->scene->number != scene_) show_scene(*shown_->scene);
  if (shown_->is_drawn(state_)) {
    drawable_ = state_.setup;
    state_.texel_world = shown_->live.texel_world;
    state_.max_map_size = shown_->max_map_size;
  }
  finish_preset();
  if (const auto& failed = shown_->undrawable; failed && failed->revision == state_.revision) {
    if (has_script() || !drawable_) return fail(located(failed->error, changed_line_));
    note(failed->error);
    undo_change();
  }
  if (const auto& failed = shown_->incomparable; failed && failed->revision == state_.revision) {
    if (has_script()) return fail(located(failed->error, changed_line_));
    note(failed->error);
  }
  return {};
}

/// The first one is what the command line asked for; what was set stays where a scene is read again.
void Viewer::show_scene(const OpenedScene& scene) {
  const bool first = scene_ == 0;
  scene_ = scene.number;
  options_.camera = scene.camera;
  posted_ = 0;
  state_.given = scene.given;
  if (first || scene.again) return;
  const ImageSize size = state_.setup.size;
  state_.setup = {};
  state_.setup.lights.resize(scene.given.lights.size());
  state_.setup.map = scene.map;
  state_.setup.size = size;
  state_.initial = state_.setup;
  state_.look.probe.reset();
  state_.film = {};
  drawable_.reset();
  ++state_.revision;
}

void Viewer::undo_change() {
  const ImageSize size = state_.setup.size;
  state_.setup = *drawable_;
  state_.setup.size = size;
  ++state_.revision;
}

/// A film goes on by the clock, from a moment that is on the screen to the next: where pictures take long, by larger
/// steps.
void Viewer::play_film() {
  if (!state_.film.plays || scene_ == 0) return film_watch_.reset();
  if (!shown_->is_drawn(state_)) return;
  const double seconds = film_watch_ ? film_watch_->elapsed_ms() / 1000.0 : 0.0;
  film_watch_.emplace();
  busy_frames_ = std::max(busy_frames_, 1);
  lab::carry_out(state_, FilmGoesOn{seconds});
}

void Viewer::post_changes() {
  if (scene_ == 0 || posted_ == state_.revision) return;
  posted_ = state_.revision;
  thread_->post(scene_, {state_.revision, state_.setup});
  meter_.posted(posted_);
}

const Rgb8Image* Viewer::picture(Picture view) const {
  return picture_of(*shown_, view);
}

Expected<void> Viewer::draw_view(const ShownView& view) {
  const Rgb8Image* image = picture(view.picture);
  if (image == nullptr) return {};
  const bool as_pane = view.picture != Picture::depth || image == shown_->live.picture.get();
  const Box place =
      as_pane ? placed(layout_.picture, view.pane, state_.look) : fitted(image->size, view.pane);
  const int height = window_->framebuffer_size().height;
  const auto viewport = [height](const Box& box) {
    return raster::Viewport{box.x, height - box.y - box.height, box.width, box.height};
  };
  return presenter_->draw(*image, viewport(place), viewport(view.part),
                          scaling_of(view.picture, state_.look));
}

Expected<void> Viewer::draw_pictures() {
  presenter_->clear(surround);
  for (const ShownView& view : shown_views(layout_, state_.look, state_.picture, state_.previous))
    if (auto ok = draw_view(view); !ok) return ok;
  return {};
}

void Viewer::draw_panels() {
  interface_->use_type(state_.look, type());
  watch_.end(FramePart::font);
  interface_->begin_frame(script_pointer_, script_key_);
  if (state_.look.panels && shown_->scene) {
    const JobStatus job = job_ ? job_->status() : JobStatus{};
    asked_.clear();
    PanelContext context{state_,
                         *shown_,
                         layout_,
                         type(),
                         ink_of(state_.look.theme),
                         job,
                         note_,
                         asked_,
                         std::exchange(menu_asked_, false)};
    overlay(context);
    menu_bar(context);
    left_column(context);
    right_column(context);
    status_bar(context);
    help_window(context);
  }
  watch_.end(FramePart::panels);
  interface_->end_frame();
  watch_.end(FramePart::drawing);
  for (const Action& action : std::exchange(asked_, {})) act(action);
}

Expected<void> Viewer::draw_frame() {
  if (auto ok = draw_pictures(); !ok) return ok;
  watch_.end(FramePart::pictures);
  draw_panels();
  set_title();
  watch_.end(FramePart::panels);
  if (shot_after_frame_) {
    const std::string path = *std::exchange(shot_after_frame_, std::nullopt);
    if (auto ok = save_screenshot(path); !ok) return ok;
  }
  if (std::exchange(screenshot_asked_, false)) save_numbered_screenshot();
  return {};
}

Readings Viewer::readings() const {
  return readings_of(*shown_, state_);
}

void Viewer::set_title() {
  if (!shown_->scene) return;
  std::string title = status_line(state_, readings(), shown_->scene->name);
  if (title != title_) window_->set_title(title_ = std::move(title));
}

/// A picture that is finished ends the wait. A frame in between would show the same again, and in software it takes the
/// processor from that picture.
void Viewer::sleep() {
  if (busy_frames_ > 0) --busy_frames_;
  if (state_.film.plays && !shown_->is_drawn(state_)) return window_->wait(busy_wait_seconds);
  if (busy_frames_ > 0 && !shown_->is_drawn(state_)) return window_->wait(drawing_wait_seconds);
  if (busy_frames_ > 0) return;
  if (!has_script()) return window_->wait(job_ || saving_.valid() ? busy_wait_seconds : idle_wait_seconds);
  const bool waits = next_step_ < script_.size() && needs_time(script_[next_step_], *shown_, state_);
  if (waits || resizing_ || opening_after_ || job_ || saving_.valid()) window_->wait(busy_wait_seconds);
}

}  // namespace gnomon::lab
