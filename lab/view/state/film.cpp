#include "lab/view/state/film.h"

#include <algorithm>
#include <cmath>

namespace gnomon::lab {

namespace {

using compare::CameraPath;
using compare::LightPath;

constexpr double frames_per_second = 1000.0;  // any moment of a film is one of its frames
constexpr double turn_seconds = 36.0;         // once around
constexpr double walk_seconds = 8.0;          // eight tenths of the way to the target
constexpr double day_seconds = 20.0;

LabFilm built_in(const char* name, const char* title, CameraPath camera, LightPath light, double seconds) {
  LabFilm film{name, title, {}, seconds};
  film.path.camera = camera;
  film.path.light = light;
  return film;
}

LabFilm keyed(const KeyedPath& keys) {
  LabFilm film{keys.name, keys.name, {}, keys.seconds()};
  film.path.camera = keys.moves_camera() ? CameraPath::keys : CameraPath::still;
  film.path.light = keys.lights.empty() ? LightPath::still : LightPath::keys;
  film.path.keys = keys;
  return film;
}

compare::Pose pose_of(const LabFilm& film, const compare::Pose& first, const Vec3& centre, double seconds) {
  const int last = std::max(1, static_cast<int>(std::lround(frames_per_second * film.seconds)));
  const compare::FilmTime time{last + 1, frames_per_second};
  const int frame = std::clamp(static_cast<int>(std::lround(frames_per_second * seconds)), 0, last);
  return compare::pose_at(film.path, time, first, centre, frame);
}

/// Posed again, the camera and the lights are where the path has them. Looked at in so many places of it.
bool can_be_posed(const LabFilm& film, const compare::Pose& first, const Vec3& centre) {
  constexpr int places = 32;
  constexpr double aim = 1e-6, place = 1e-6;
  for (int i = 0; i <= places; ++i) {
    const double seconds = film.seconds * i / places;
    const compare::Pose meant = pose_of(film, first, centre, seconds);
    if (!compare::check_pose(meant, i)) return false;
    const FilmMoment moment = moment_of(film, first, centre, seconds);
    for (std::size_t k = 0; k < meant.lights.size(); ++k) {
      if (!moment.lights[k]) continue;
      const Light posed = app::posed_light(first.lights[k], centre, *moment.lights[k]),
                  &light = meant.lights[k];
      const double scale = 1.0 + glm::length(light.position - centre);
      if (glm::length(posed.position - light.position) > place * scale) return false;
      if (light.type != LightType::point && glm::length(posed.direction - light.direction) > aim)
        return false;
    }
  }
  return true;
}

bool moves(const LabFilm& film, const Light& light) {
  switch (film.path.light) {
    case LightPath::still:
      return false;
    case LightPath::orbit:
      return true;
    case LightPath::sun:
      return light.type == LightType::directional;
    case LightPath::keys:
      return film.path.keys.lights.contains(light.name);
  }
  return false;
}

}  // namespace

std::vector<LabFilm> films_of(const compare::Pose& first, const Vec3& centre,
                              const std::vector<KeyedPath>& own_paths) {
  std::vector<LabFilm> films;
  const auto add = [&](LabFilm film) {
    const bool known = std::any_of(films.begin(), films.end(),
                                   [&](const LabFilm& other) { return other.name == film.name; });
    if (!known && film.seconds > 0.0 && can_be_posed(film, first, centre)) films.push_back(std::move(film));
  };
  for (const KeyedPath& own : own_paths) add(keyed(own));
  add(built_in("camera-orbit", "The camera goes round", CameraPath::orbit, LightPath::still, turn_seconds));
  add(built_in("camera-walk", "The camera walks ahead", CameraPath::walk, LightPath::still, walk_seconds));
  add(built_in("camera-turn", "The camera looks round", CameraPath::turn, LightPath::still, turn_seconds));
  add(built_in("light-orbit", "The lights go round", CameraPath::still, LightPath::orbit, turn_seconds));
  const bool has_sun = std::any_of(first.lights.begin(), first.lights.end(),
                                   [](const Light& light) { return light.type == LightType::directional; });
  if (has_sun) add(built_in("sun", "The sun's day", CameraPath::still, LightPath::sun, day_seconds));
  return films;
}

FilmMoment moment_of(const LabFilm& film, const compare::Pose& first, const Vec3& centre, double seconds) {
  const compare::Pose pose = pose_of(film, first, centre, seconds);
  FilmMoment moment;
  if (film.path.camera != CameraPath::still) {
    moment.camera = app::camera_pose(pose.camera);
    moment.camera->target = pose.camera.target;
    if (pose.camera.up != first.camera.up) moment.camera->up = pose.camera.up;
  }
  moment.lights.resize(first.lights.size());
  for (std::size_t i = 0; i < first.lights.size(); ++i) {
    const Light& light = pose.lights[i];
    if (!moves(film, light)) continue;
    moment.lights[i] = app::light_pose(light, centre);
    if (light.type != LightType::directional)
      moment.lights[i]->distance = glm::length(light.position - centre);
  }
  return moment;
}

}  // namespace gnomon::lab
