#include "app/options/view_options.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "app/options/option_kinds.h"
#include "scene/base/option_text.h"

namespace gnomon::app {
namespace {

constexpr int most_views = 1000;

std::vector<std::string> names_of(const std::string& text) {
  std::vector<std::string> names;
  std::stringstream stream(text);
  for (std::string name; std::getline(stream, name, ',');) names.push_back(name);
  return names;
}

bool was_given(const FilmOptions& film, std::string_view option) {
  return std::any_of(film.given.begin(), film.given.end(),
                     [&](const auto& given) { return given.first == option; });
}

const NamedCamera* find_camera(const std::vector<NamedCamera>& cameras, const std::string& name) {
  const auto found =
      std::find_if(cameras.begin(), cameras.end(), [&](const auto& each) { return each.name == name; });
  return found == cameras.end() ? nullptr : &*found;
}

compare::JudgedView view_of(const NamedCamera& camera) {
  return {camera.name, [at = camera.camera](const compare::Pose& own) {
            return compare::Pose{at, own.lights};
          }};
}

Expected<std::vector<compare::JudgedView>> views_of_cameras(const std::vector<std::string>& wanted,
                                                            const std::vector<NamedCamera>& cameras) {
  std::vector<compare::JudgedView> views;
  if (cameras.empty())
    return fail(ErrorKind::usage, fmt::format("--cameras: the scene has no camera of its own (got {})",
                                              fmt::join(wanted, ",")));
  std::vector<std::string_view> names;
  for (const NamedCamera& camera : cameras) names.push_back(camera.name);
  for (const std::string& name : wanted) {
    if (const NamedCamera* camera = find_camera(cameras, name)) {
      views.push_back(view_of(*camera));
    } else if (name == "all") {
      for (const NamedCamera& each : cameras) views.push_back(view_of(each));
    } else {
      return fail(ErrorKind::usage,
                  fmt::format("--cameras: the scene has no such camera (got {}, allowed all, {}){}", name,
                              fmt::join(names, ", "), did_you_mean(name, names)));
    }
  }
  return views;
}

/// The frame of a film that is shown as one of so many views.
int frame_of(int view, int views, const compare::FilmTime& time) {
  return views == 1 ? 0 : static_cast<int>(std::lround(double(view) * (time.frames - 1) / (views - 1)));
}

Expected<std::vector<compare::JudgedView>> views_along(const compare::FilmPlan& film, int count,
                                                       const Scene& given, const Vec3& centre,
                                                       const std::string& name) {
  if (film.path.camera == compare::CameraPath::drift)
    return fail(ErrorKind::usage,
                "--path drift: goes by parts of a texel, which is a film's (--measure shimmer)");
  std::vector<compare::JudgedView> views;
  for (int view = 0; view < std::min(count, film.time.frames); ++view) {
    const int frame = frame_of(view, std::min(count, film.time.frames), film.time);
    const auto pose = [film, centre, frame](const compare::Pose& own) {
      return compare::pose_at(film.path, film.time, own, centre, frame);
    };
    if (const auto sound = check_pose(pose({given.camera, given.lights}), frame); !sound)
      return fail(sound.error());
    views.push_back({fmt::format("{} at {:.3g} s", name, film.time.seconds(frame)), pose});
  }
  return views;
}

}  // namespace

void add_view_options(CLI::App& app, ViewListOptions& views) {
  add_value(app, "--cameras", "NAME[,NAME]",
            describe("judge the setting from these of the scene's cameras, and by the worst of them",
                     "names, or all", "the one of --camera"),
            [&views](const std::string& text) -> Expected<void> {
              views.cameras = names_of(text);
              if (views.cameras.empty()) return fail(ErrorKind::usage, "wrong value (got nothing)");
              return {};
            });
  add_value(app, "--views", "N",
            describe("pictures along --path, evenly over the film that --frames and --fps describe, from "
                     "which the setting "
                     "is judged, and by the worst of them",
                     fmt::format("1 to {}", most_views), std::to_string(views.along_path)),
            [&views](const std::string& text) {
              views.count_given = true;
              return assign(views.along_path, parse_integer(text, 1, most_views));
            });
}

bool follows_path(const FilmOptions& film) {
  return was_given(film, "--path") || was_given(film, "--move");
}

Expected<void> check_views(const ViewListOptions& views, const std::string& camera, const FilmOptions& film,
                           bool filmed, const std::function<bool(std::string_view)>& is_given) {
  const bool along = !filmed && follows_path(film);
  if (views.by_cameras() && along)
    return fail(ErrorKind::usage, "--cameras: one of --cameras and --path says from where");
  if (views.count_given && !along)
    return fail(ErrorKind::usage, "--views: belongs to --path, of a still picture");
  if (!filmed && !along && !film.given.empty())
    return fail(ErrorKind::usage, fmt::format("{}: belongs to --path", film.given.front().first));
  if (!views.by_cameras()) return {};
  if (!camera.empty()) return fail(ErrorKind::usage, "--camera: --cameras says from where");
  for (const char* pose : {"camera-orbit", "camera-distance", "camera-target", "camera-up", "camera-height"})
    if (is_given(pose)) return fail(ErrorKind::usage, fmt::format("--{}: --cameras says from where", pose));
  return {};
}

Expected<std::vector<compare::JudgedView>> resolve_views(const ViewListOptions& views,
                                                         const FilmOptions& film, bool filmed,
                                                         const LoadedScene& loaded, const Scene& given,
                                                         Console& console) {
  if (views.by_cameras()) return views_of_cameras(views.cameras, loaded.cameras);
  if (filmed || !follows_path(film)) return std::vector<compare::JudgedView>();
  const auto plan = resolve_film(film, loaded.paths, given, console);
  if (!plan) return fail(plan.error());
  const std::string name = film.paths.empty() ? "the path" : fmt::format("{}", fmt::join(film.paths, ","));
  const Vec3 centre = loaded.world->finite_bounds.empty() ? given.camera.target : loaded.world->middle();
  return views_along(*plan, views.along_path, given, centre, name);
}

std::string view_arguments(const ViewListOptions& views, const FilmOptions& film, bool filmed) {
  if (views.by_cameras())
    return " --cameras " + shell_quoted(fmt::format("{}", fmt::join(views.cameras, ",")));
  if (filmed || !follows_path(film)) return {};
  return film_arguments(film) + (views.count_given ? fmt::format(" --views {}", views.along_path) : "");
}

}  // namespace gnomon::app
