#include "app/options/shimmer_options.h"

#include <algorithm>
#include <array>
#include <sstream>

#include "app/options/option_kinds.h"
#include "scene/base/option_text.h"
#include "scene/files/read_file.h"

namespace gnomon::app {

namespace {

using compare::CameraPath;
using compare::LightPath;
using compare::Moves;

constexpr std::pair<std::string_view, Moves> all_moves[] = {
    {"camera", Moves::camera}, {"light", Moves::light}, {"both", Moves::both}};
constexpr std::pair<std::string_view, CameraPath> camera_paths[] = {{"orbit", CameraPath::orbit},
                                                                    {"walk", CameraPath::walk},
                                                                    {"turn", CameraPath::turn},
                                                                    {"drift", CameraPath::drift},
                                                                    {"still", CameraPath::still}};
constexpr std::pair<std::string_view, LightPath> light_paths[] = {
    {"orbit", LightPath::orbit}, {"sun", LightPath::sun}, {"still", LightPath::still}};
constexpr OptionRange speed_range{-1e6, 1e6};
constexpr OptionRange drift_range{-1000.0, 1000.0};
constexpr int most_frames = 10000;
constexpr int most_anchors = 64;

std::vector<std::string> parts_of(const std::string& text) {
  std::vector<std::string> parts;
  std::stringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

Expected<Vec2> parse_drift(const std::string& text) {
  const std::vector<std::string> parts = parts_of(text);
  if (parts.size() != 2)
    return fail(ErrorKind::usage, fmt::format("wrong value (got {}, allowed U,V)", text));
  const auto u = parse_number(parts[0], drift_range), v = parse_number(parts[1], drift_range);
  if (!u) return fail(u.error());
  if (!v) return fail(v.error());
  return Vec2(*u, *v);
}

bool is_file(const std::string& path) {
  return lower_extension(path) == ".json";
}

template <class Path, std::size_t N>
const Path* find_path(const std::pair<std::string_view, Path> (&known)[N], const std::string& name) {
  const auto found =
      std::find_if(std::begin(known), std::end(known), [&](const auto& one) { return one.first == name; });
  return found == std::end(known) ? nullptr : &found->second;
}

LightPath usual_light_path(const Scene& scene) {
  const bool sun = std::any_of(scene.lights.begin(), scene.lights.end(),
                               [](const Light& light) { return light.type == LightType::directional; });
  return sun ? LightPath::sun : LightPath::orbit;
}

// The first name is the camera's where it moves; the last one the light's.
Expected<void> apply_names(const FilmOptions& film, compare::ShimmerPath& path) {
  const Moves moves = film.moves.value_or(Moves::camera);
  const bool camera = moves != Moves::light, light = moves != Moves::camera;
  const auto& names = film.paths;
  if (names.size() > (camera && light ? 2u : 1u))
    return fail(ErrorKind::usage,
                fmt::format("--path: one path for each of what moves (got {} paths)", names.size()));
  if (camera && !names.empty()) {
    const CameraPath* found = find_path(camera_paths, names.front());
    if (found == nullptr)
      return fail(ErrorKind::usage, fmt::format("--path: no path of a camera (got {}, allowed {}, FILE.json)",
                                                names.front(), choice_names<CameraPath>(camera_paths, ", ")));
    path.camera = *found;
  }
  if (light && names.size() > (camera ? 1u : 0u)) {
    const LightPath* found = find_path(light_paths, names.back());
    if (found == nullptr)
      return fail(ErrorKind::usage, fmt::format("--path: no path of a light (got {}, allowed {}, FILE.json)",
                                                names.back(), choice_names<LightPath>(light_paths, ", ")));
    path.light = *found;
  }
  return {};
}

// An option whose text is kept, to be typed again.
template <class Store>
void add_kept(CLI::App& app, FilmOptions& film, const std::string& name, const char* type,
              const std::string& text, Store store) {
  add_value(app, name, type, text, [&film, name, store](const std::string& value) {
    film.given.emplace_back(name, value);
    return store(value);
  });
}

void add_movement(CLI::App& app, FilmOptions& film) {
  add_kept(
      app, film, "--move", "WHAT",
      describe("what moves", choice_names<Moves>(all_moves, " or "),
               "camera; along a path by keys all that it has keys of"),
      [&film](const std::string& text) { return assign(film.moves, parse_choice<Moves>(text, all_moves)); });
  add_kept(
      app, film, "--path", "NAME[,NAME]|FILE.json",
      describe(
          "how: of the camera orbit, walk, turn, drift (sideways by parts of a texel, the map's window along "
          "with it) or still; of the light orbit, sun (over a day) or still; the camera's first where both "
          "move; or one of the scene's own paths by its name (an animation of a glTF file); or keys from a "
          "file "
          "(gnomon/path/1, docs/shimmer.md)",
          "names", "the scene's first; else orbit, of a light sun where one is directional"),
      [&film](const std::string& text) -> Expected<void> {
        film.paths = parts_of(text);
        if (film.paths.empty()) return fail(ErrorKind::usage, "wrong value (got nothing)");
        return {};
      });
  add_kept(
      app, film, "--speed", "NUMBER",
      describe("how fast a path that is built in goes; orbit and turn: 10 degrees a second, walk: a tenth of "
               "the way to the camera's target a second, sun: a day in the whole film",
               fmt::format("factor, {}", range_text(speed_range)), number_text(film.speed)),
      [&film](const std::string& text) { return assign(film.speed, parse_number(text, speed_range)); });
}

void add_drift(CLI::App& app, FilmOptions& film) {
  add_kept(
      app, film, "--drift", "U,V",
      describe("of --path drift: how far the map's window goes with each frame, along its right and its up",
               fmt::format("texels, each {}", range_text(drift_range)),
               fmt::format("{},{}", number_text(film.drift_texels.x), number_text(film.drift_texels.y))),
      [&film](const std::string& text) { return assign(film.drift_texels, parse_drift(text)); });
}

void add_time(CLI::App& app, FilmOptions& film) {
  add_kept(
      app, film, "--frames", "N",
      describe("frames of the film", fmt::format("2 to {}", most_frames), std::to_string(film.time.frames)),
      [&film](const std::string& text) {
        return assign(film.time.frames, parse_integer(text, 2, most_frames));
      });
  constexpr OptionRange fps{0.0, 1e6, true};
  add_kept(app, film, "--fps", "NUMBER",
           describe("speed of the film", fmt::format("frames a second, {}", range_text(fps)),
                    number_text(film.time.fps)),
           [&film, fps](const std::string& text) { return assign(film.time.fps, parse_number(text, fps)); });
}

bool is_film_option(const FilmOptions& film, std::string_view option) {
  return std::any_of(film.given.begin(), film.given.end(),
                     [&](const auto& given) { return given.first == option; });
}

// What would change nothing is refused.
Expected<void> check_use(const FilmOptions& film, const compare::ShimmerPath& path) {
  const bool by_keys = path.camera == CameraPath::keys || path.light == LightPath::keys;
  if (by_keys && is_film_option(film, "--speed"))
    return fail(ErrorKind::usage,
                "--speed: belongs to paths that are built in; keys have times of their own");
  if (path.camera != CameraPath::drift && is_film_option(film, "--drift"))
    return fail(ErrorKind::usage, "--drift: belongs to --path drift");
  return {};
}

// The keys of what is to move. What was asked to move and stands still is refused.
Expected<void> play_keys(const FilmOptions& film, compare::ShimmerPath& path) {
  const bool camera = path.keys.moves_camera() && film.moves != Moves::light;
  const bool light = !path.keys.lights.empty() && film.moves != Moves::camera;
  path.camera = camera ? CameraPath::keys : CameraPath::still;
  path.light = light ? LightPath::keys : LightPath::still;
  if (!camera && !light && !film.moves && !path.objects)
    return fail(ErrorKind::usage, "--path: it has no keys of the camera, nor of a light that is drawn");
  const auto stands_still = [&film](std::string_view what) {
    const auto move = std::find_if(std::begin(all_moves), std::end(all_moves),
                                   [&film](const auto& one) { return film.moves == one.second; });
    return fail(ErrorKind::usage, fmt::format("--move {}: the path has no keys of {}", move->first, what));
  };
  if (!camera && film.moves && film.moves != Moves::light) return stands_still("the camera");
  if (!light && film.moves && film.moves != Moves::camera) return stands_still("a light that is drawn");
  return check_use(film, path);
}

// Of very many lights some are left out, and their keys with them.
KeyedPath of_kept_lights(KeyedPath path, const Scene& scene) {
  std::erase_if(path.lights, [&](const auto& keys) {
    return std::none_of(scene.lights.begin(), scene.lights.end(),
                        [&](const Light& light) { return light.name == keys.first; });
  });
  return path;
}

// A file's keys, or those of one of the scene's own paths; nothing where a built-in path is meant.
Expected<std::optional<KeyedPath>> find_keys(const FilmOptions& film, const std::vector<KeyedPath>& own_paths,
                                             const Scene& scene, Console& console) {
  if (const std::string file = path_file(film); !file.empty()) {
    auto keys = read_path(file);
    if (!keys) return fail(keys.error());
    return std::optional(std::move(*keys));
  }
  for (const KeyedPath& own : own_paths)
    if (film.paths.size() == 1 && own.name == film.paths.front())
      return std::optional(of_kept_lights(own, scene));
  const bool asked =
      film.moves || !film.paths.empty() || is_film_option(film, "--speed") || is_film_option(film, "--drift");
  if (asked || own_paths.empty()) return std::optional<KeyedPath>();
  const KeyedPath& first = own_paths.front();
  console.note(fmt::format("the scene's path {} is taken; it lasts {:g} s (--path takes another)", first.name,
                           first.seconds()));
  return std::optional(of_kept_lights(first, scene));
}

}  // namespace

void add_film_options(CLI::App& app, FilmOptions& film) {
  add_time(app, film);
  add_movement(app, film);
  add_drift(app, film);
  add_kept(app, film, "--anchors", "N",
           describe("receivers at every so many pixels of the first frame, along both axes",
                    fmt::format("pixels, 1 to {}", most_anchors), std::to_string(film.anchors)),
           [&film](const std::string& text) {
             return assign(film.anchors, parse_integer(text, 1, most_anchors));
           });
}

void add_path_options(CLI::App& app, FilmOptions& film) {
  add_time(app, film);
  add_movement(app, film);
}

std::string path_file(const FilmOptions& film) {
  return film.paths.size() == 1 && is_file(film.paths.front()) ? film.paths.front() : std::string();
}

Expected<compare::FilmPlan> resolve_film(const FilmOptions& film, const std::vector<KeyedPath>& own_paths,
                                         const Scene& scene, Console& console, const StageSource* source) {
  compare::FilmPlan plan{{}, film.time, film.anchors};
  compare::ShimmerPath& path = plan.path;
  path.speed = film.speed;
  path.drift_texels = film.drift_texels;
  auto keys = find_keys(film, own_paths, scene, console);
  if (!keys) return fail(keys.error());
  if (*keys) {
    path.keys = std::move(**keys);
    path.objects = source != nullptr && path.keys.objects_until && !film.moves;
    if (path.objects && source->scene.time)
      return fail(ErrorKind::usage, "--time: the film plays the animation, which says where objects are");
    if (path.objects) plan.stage = stages_of(*source, path.keys.name);
    if (path.keys.objects_until && !path.objects)
      console.note(fmt::format(
          "The animation {} moves objects, too, which stand still here; --time says where.", path.keys.name));
    if (const auto played = play_keys(film, path); !played) return fail(played.error());
    return plan;
  }
  const Moves moves = film.moves.value_or(Moves::camera);
  path.camera = moves != Moves::light ? CameraPath::orbit : CameraPath::still;
  path.light = moves != Moves::camera ? usual_light_path(scene) : LightPath::still;
  if (const auto taken = apply_names(film, path); !taken) return fail(taken.error());
  if (const auto used = check_use(film, path); !used) return fail(used.error());
  if (const auto sound = check_path(path, scene); !sound) return fail(sound.error());
  return plan;
}

bool is_film_option(std::string_view name) {
  CLI::App app;
  FilmOptions film;
  add_film_options(app, film);
  return app.get_option_no_throw(std::string(name)) != nullptr;
}

Expected<void> check_film_use(const FilmedMeasure& asked) {
  if (asked.is_filmed()) return {};
  for (const char* of_films : {"--anchors", "--drift"})
    if (is_film_option(asked.film, of_films))
      return fail(ErrorKind::usage, fmt::format("{}: belongs to --measure shimmer", of_films));
  return {};
}

std::string film_arguments(const FilmOptions& film) {
  std::string text;
  for (const auto& [option, value] : film.given)
    text += value.starts_with('-') ? fmt::format(" {}={}", option, shell_quoted(value))
                                   : fmt::format(" {} {}", option, shell_quoted(value));
  return text;
}

}  // namespace gnomon::app
