// How a script drives the window: its steps, one after another, between the frames.
#include <fmt/core.h>

#include <algorithm>

#include "app/console.h"
#include "lab/view/viewer.h"

namespace gnomon::lab {

namespace {

constexpr double resize_patience_ms = 5000.0;  // for a window manager to grant a size
constexpr std::int64_t drag_frames = 8;        // from the press to the release
constexpr std::int64_t point_frames = 3;

}  // namespace

bool needs_time(const ScriptStep& step, const Snapshot& shown, const ViewState& state) {
  if (std::holds_alternative<WaitDone>(step.what)) return !shown.is_done(state);
  return std::holds_alternative<Screenshot>(step.what) && !shown.is_drawn(state);
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
  if (!shown_->scene) return false;
  if (std::holds_alternative<WaitDone>(step.what) && state_.film.plays)
    return fail(ErrorKind::bad_input, "a film that plays is never done (set film-play off before)");
  if (needs_time(step, *shown_, state_) || busy_frames_ > 0) {
    const bool waits =
        std::holds_alternative<WaitDone>(step.what) || std::holds_alternative<Screenshot>(step.what);
    if (waits) return false;
  }
  if (std::holds_alternative<WaitDone>(step.what)) return job_ == nullptr && !saving_.valid();
  if (const auto* wait = std::get_if<WaitFrames>(&step.what)) return frames_waited_++ == wait->frames;
  if (const auto* shot = std::get_if<Screenshot>(&step.what)) {
    shot_after_frame_ = shot->path;
    return true;
  }
  if (std::holds_alternative<PrintCommand>(step.what)) {
    print_command();
    return true;
  }
  if (std::holds_alternative<PrintClipboard>(step.what)) {
    app::print_data(window_->clipboard() + "\n");
    return true;
  }
  if (const auto* drag = std::get_if<DragPointer>(&step.what)) return pass_drag(*drag);
  if (const auto* point = std::get_if<PointAt>(&step.what)) return pass_point(point->at);
  if (const auto* open = std::get_if<OpenScene>(&step.what)) return pass_open([this, open] { act(*open); });
  if (const auto* drop = std::get_if<DropFile>(&step.what))
    return pass_open([this, drop] { window_->drop(drop->path); });
  changed_line_ = step.line;
  if (const auto* pick = std::get_if<PickByName>(&step.what))
    return pick->kind == PickByName::Kind::film ? pass_film(pick->name) : pass_light(pick->name);
  if (const auto* press = std::get_if<PressKey>(&step.what)) return pass_key(press->key);
  if (const auto* save = std::get_if<SaveScene>(&step.what)) {
    const auto saved = write_scene(save->path, shown_->scene->argument, state_);
    if (!saved) return fail(saved.error());
    if (const std::string words = left_out_words(); !words.empty())
      console_.note("saved " + save->path + words);
    return true;
  }
  if (const auto* use = std::get_if<UsePreset>(&step.what)) {
    act(*use);
    return true;
  }
  const Change& change = std::get<Change>(step.what);
  if (const auto* resize = std::get_if<Resize>(&change)) return pass_resize(*resize);
  act(change);
  follow_layout();  // panels that come or go change the picture's size
  return true;
}

/// The scene that was there stays until the other has been read.
Expected<bool> Viewer::pass_open(const std::function<void()>& ask) {
  if (!opening_after_) {
    opening_after_ = scene_;
    ask();
    return false;
  }
  if (shown_->unreadable) return fail(*shown_->unreadable);
  if (scene_ == *opening_after_) return false;
  opening_after_.reset();
  return true;
}

Expected<bool> Viewer::pass_film(const std::string& wanted) {
  if (wanted == "off") {
    lab::carry_out(state_, PickFilm{});
    return true;
  }
  std::string names;
  for (std::size_t i = 0; i < state_.given.films.size(); ++i) {
    const std::string& name = state_.given.films[i].name;
    if (name == wanted) {
      lab::carry_out(state_, PickFilm{i});
      return true;
    }
    names += ", " + name;
  }
  return fail(ErrorKind::bad_input,
              fmt::format("film: the scene has no such film (got {}, allowed off{})", wanted, names));
}

Expected<bool> Viewer::pass_light(const std::string& wanted) {
  const auto light = light_of_name(wanted, state_.given.lights);
  if (light) {
    act(Change{PickLight{*light}});
    return true;
  }
  Error error = light.error();
  error.reason += left_out_words();
  return fail(std::move(error));
}

/// A press, a move in steps and a release, each in a frame of its own, for the panels and the pictures alike.
Expected<bool> Viewer::pass_drag(DragPointer drag) {
  if (drag.light) {
    const auto handle = frames_waited_ == 0 ? shown_handle() : dragged_from_;
    if (!handle) return fail(ErrorKind::bad_input, "the light's handle is not in view");
    dragged_from_ = handle;
    drag.from = *handle;
  }
  const std::int64_t frame = frames_waited_++;
  const double share = std::clamp(double(frame - 2) / double(drag_frames - 2), 0.0, 1.0);
  ScriptPointer& pointer = move_script_pointer(drag.from + share * (drag.to - drag.from));
  const auto button = static_cast<std::size_t>(drag.button);
  if (frame == 2) pointer.down[button] = true, press(drag.button, true, {});
  if (frame == drag_frames + 1) pointer.down[button] = false, press(drag.button, false, {});
  return frame > drag_frames + 2;
}

/// Menus and notes need a frame to open and one to find their place.
bool Viewer::pass_point(Vec2 at) {
  move_script_pointer(at);
  return frames_waited_++ == point_frames;
}

ScriptPointer& Viewer::move_script_pointer(Vec2 to) {
  if (!script_pointer_) script_pointer_.emplace();
  script_pointer_->x = to.x, script_pointer_->y = to.y;
  move(to.x, to.y);
  return *script_pointer_;
}

/// A key goes down in one frame and up in the next, for the panels and the pictures alike.
bool Viewer::pass_key(const Key& key) {
  const std::int64_t frame = frames_waited_++;
  if (frame == 0) press_key(key);
  script_key_ = frame == 0 ? std::optional(key) : std::nullopt;
  busy_frames_ = 3;
  return frame == 2 || quit_;
}

/// A window gets its size from the display, in its own time.
Expected<bool> Viewer::pass_resize(const Resize& resize) {
  const ImageSize now = window_->framebuffer_size();
  if (now == resize.size) {
    resizing_.reset();
    follow_layout();
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

}  // namespace gnomon::lab
