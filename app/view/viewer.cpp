#include "app/view/viewer.h"

#include <fmt/format.h>

#include <filesystem>

#include "app/interrupt.h"
#include "app/output_path.h"
#include "app/view/status.h"
#include "scene/files/image_io.h"

namespace gnomon::app {

namespace {

constexpr double idle_wait_seconds = 1.0;           // between frames when nothing happens
constexpr double resize_patience_ms = 5000.0;       // for a window manager to grant a size
const Rgb8Image surround({1, 1}, glm::u8vec3(24));  // where a picture leaves the window free

/// The largest place in the window that has the picture's proportions.
raster::Viewport fitted(ImageSize picture, ImageSize window) {
  const double scale = std::min(static_cast<double>(window.width) / picture.width,
                                static_cast<double>(window.height) / picture.height);
  const int width = std::max(1, static_cast<int>(std::lround(scale * picture.width)));
  const int height = std::max(1, static_cast<int>(std::lround(scale * picture.height)));
  return {(window.width - width) / 2, (window.height - height) / 2, width, height};
}

/// Colours that stand for something must not be mixed.
raster::Scaling scaling_of(Picture picture) {
  const bool photographic = picture == Picture::raster || picture == Picture::raytrace;
  return photographic ? raster::Scaling::linear : raster::Scaling::nearest;
}

}  // namespace

Expected<std::unique_ptr<Viewer>> Viewer::open(const ViewOptions& options, const LoadedScene& loaded,
                                               ViewState state, std::vector<ScriptStep> script,
                                               Console& console) {
  std::unique_ptr<Viewer> viewer(new Viewer(options, loaded, std::move(state), std::move(script), console));
  auto window = Window::open("gnomon", viewer->state_.setup.size);
  if (!window) return fail(window.error());
  viewer->window_ = std::move(*window);
  viewer->context_ = viewer->window_->context();
  auto presenter = raster::Presenter::create(*viewer->context_);
  if (!presenter) return fail(presenter.error());
  viewer->presenter_ = std::move(*presenter);
  auto studio = Studio::create(viewer->window_->context(), loaded, options.compare, options.shader_folder,
                               [] { Window::wake(); });
  if (!studio) return fail(studio.error());
  viewer->studio_ = std::move(*studio);
  viewer->listen();
  return viewer;
}

Viewer::Viewer(const ViewOptions& options, const LoadedScene& loaded, ViewState state,
               std::vector<ScriptStep> script, Console& console)
    : options_(options),
      loaded_(loaded),
      console_(console),
      state_(std::move(state)),
      script_(std::move(script)) {}

void Viewer::listen() {
  WindowEvents events;
  events.key = [this](int key, bool shift) {
    if (const auto action = action_for_key(key, shift)) act(*action);
  };
  events.button = [this](int button, bool down) { down ? pointer_.press(button) : pointer_.release(button); };
  events.pointer = [this](double x, double y) {
    if (const auto change = pointer_.move_to(x, y)) carry_out(state_, *change);
  };
  events.scroll = [this](double notches) { carry_out(state_, zoom_for_scroll(notches)); };
  window_->listen(std::move(events));
}

void Viewer::act(const Action& action) {
  if (const auto* change = std::get_if<Change>(&action)) return carry_out(state_, *change);
  switch (std::get<Command>(action)) {
    case Command::save_screenshot:
      screenshot_asked_ = true;
      return;
    case Command::print_command:
      print_command();
      return;
    case Command::print_help:
      console_.message(key_help());
      return;
    case Command::quit:
      quit_ = true;
      return;
  }
}

Expected<void> Viewer::run() {
  while (!quit_ && !window_->should_close()) {
    window_->poll();
    follow_window_size();
    if (auto ok = advance_script(); !ok) return ok;
    if (quit_) break;
    if (auto ok = update_pictures(); !ok) return ok;
    if (auto ok = draw_frame(); !ok) return ok;
    window_->show_frame();
    sleep();
  }
  return {};
}

/// The state's size is always that of the framebuffer; an iconified window keeps its last one.
void Viewer::follow_window_size() {
  const ImageSize size = window_->framebuffer_size();
  if (size.pixels() > 0 && !(size == state_.setup.size)) carry_out(state_, Resize{size});
}

/// A person's wish that cannot be drawn is taken back, with a word about it; a script's ends the program.
Expected<void> Viewer::update_pictures() {
  Expected<void> drawn = studio_->draw(state_);
  if (!drawn && drawable_ && !has_script()) {
    print_error(drawn.error());
    take_back();
    drawn = studio_->draw(state_);
  }
  if (!drawn) return fail(located(drawn.error(), changed_line_));
  drawable_ = state_.setup;
  const Expected<void> compared = studio_->compare(state_);
  if (!compared && has_script()) return fail(located(compared.error(), changed_line_));
  if (!compared) print_error(compared.error());
  return {};
}

void Viewer::take_back() {
  const ImageSize size = state_.setup.size;
  state_.setup = *drawable_;
  state_.setup.size = size;
  ++state_.revision;
}

Expected<void> Viewer::draw_frame() {
  const Picture shown = state_.picture;
  const Rgb8Image& picture = studio_->picture(shown);
  const ImageSize size = state_.setup.size;
  const bool as_window = shown != Picture::depth || &picture == &studio_->picture(Picture::raster);
  const raster::Viewport whole{0, 0, size.width, size.height};
  if (!as_window) {
    if (auto ok = presenter_->draw(surround, whole, raster::Scaling::nearest); !ok) return ok;
  }
  if (auto ok = presenter_->draw(picture, as_window ? whole : fitted(picture.size, size), scaling_of(shown));
      !ok)
    return ok;
  std::string title = status_line(state_, studio_->readings(state_), loaded_.scene->name);
  if (title != title_) window_->set_title(title_ = std::move(title));

  if (shot_after_frame_) {
    const std::string path = *std::exchange(shot_after_frame_, std::nullopt);
    if (auto ok = save_screenshot(path); !ok) return ok;
  }
  if (std::exchange(screenshot_asked_, false)) {
    if (auto ok = save_numbered_screenshot(); !ok) print_error(ok.error());
  }
  return {};
}

Expected<void> Viewer::save_screenshot(const std::string& path) {
  const ImageSize size = state_.setup.size;
  const auto picture = presenter_->read({0, 0, size.width, size.height});
  if (!picture) return fail(picture.error());
  const OutputGuard whole_output;
  if (auto made = make_folder_for(path); !made) return made;
  if (auto written = write_png(path, *picture); !written) return written;
  console_.message("screenshot: " + path);
  return {};
}

/// SCENE-VIEW-001.png and so on in the current folder; nothing is overwritten.
Expected<void> Viewer::save_numbered_screenshot() {
  const std::string name = std::filesystem::path(options_.scene.name).stem().string();
  for (int number = 1;; ++number) {
    const std::string path = fmt::format("{}-{}-{:03}.png", name, picture_name(state_.picture), number);
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) return save_screenshot(path);
  }
}

void Viewer::print_command() const {
  print_data(compare_command(state_, options_) + "\n");
  std::fflush(stdout);
  for (const std::string& light : other_turned_lights(state_))
    console_.note(
        fmt::format("light {} was turned as well; the command line turns only the chosen one", light));
}

void Viewer::sleep() {
  if (!has_script()) return window_->wait(idle_wait_seconds);
  const bool waits_for_worker = next_step_ < script_.size() &&
                                std::holds_alternative<WaitDone>(script_[next_step_].what) &&
                                !studio_->is_done(state_);
  if (waits_for_worker || resizing_) window_->wait(idle_wait_seconds / 100.0);
}

Expected<void> Viewer::advance_script() {
  while (has_script() && !quit_ && !shot_after_frame_) {
    if (next_step_ == script_.size()) {
      quit_ = true;
      return {};
    }
    const Expected<bool> over = pass(script_[next_step_]);
    if (!over) return fail(located(over.error(), script_[next_step_].line));
    if (!*over) return {};
    ++next_step_;
    frames_waited_ = 0;
  }
  return {};
}

Expected<bool> Viewer::pass(const ScriptStep& step) {
  if (std::holds_alternative<Quit>(step.what)) return quit_ = true;
  if (std::holds_alternative<WaitDone>(step.what)) return studio_->is_done(state_);
  if (const auto* wait = std::get_if<WaitFrames>(&step.what)) return frames_waited_++ == wait->frames;
  if (const auto* shot = std::get_if<Screenshot>(&step.what)) {
    shot_after_frame_ = shot->path;
    return true;
  }
  const Change& change = std::get<Change>(step.what);
  changed_line_ = step.line;
  if (const auto* resize = std::get_if<Resize>(&change)) return pass_resize(*resize);
  carry_out(state_, change);
  return true;
}

/// A window gets its size from the display, in its own time.
Expected<bool> Viewer::pass_resize(const Resize& resize) {
  const ImageSize now = window_->framebuffer_size();
  if (now == resize.size) {
    resizing_.reset();
    follow_window_size();
    return true;
  }
  if (!resizing_) {
    resizing_.emplace();
    window_->ask_for_size(resize.size);
  }
  if (resizing_->elapsed_ms() < resize_patience_ms) return false;
  return fail(ErrorKind::graphics,
              fmt::format("the display does not grant this window size (got {}x{}, asked for {}x{})",
                          now.width, now.height, resize.size.width, resize.size.height));
}

Error Viewer::located(Error error, int line) const {
  if (line == 0 || !error.file.empty()) return error;
  error.file = options_.script;
  error.line = line;
  return error;
}

}  // namespace gnomon::app
