// The options that say what a film of shadows shows: of `gnomon shimmer`, and of `sweep` and `tune` with --measure shimmer.
#pragma once

#include <optional>

#include "app/film_stages.h"
#include "app/session.h"
#include "compare/path.h"
#include "compare/result/figures.h"
#include "compare/result/threshold.h"

namespace CLI {
class App;
}

namespace gnomon::app {

struct FilmOptions {
  std::optional<compare::Moves> moves;  ///< none: the camera; of a path by keys all that it moves
  std::vector<std::string>
      paths;  ///< names of built-in ones, or one of the scene's, or one file; empty: the usual
  double speed = 1.0;
  Vec2 drift_texels{0.1, 0.07};
  compare::FilmTime time;
  int anchors = 1;
  std::vector<std::pair<std::string, std::string>> given;  ///< options and values, as they were typed
};

/// --frames, --fps, --move, --path, --speed, --drift, --anchors.
bool is_film_option(std::string_view name);
void add_film_options(CLI::App& app, FilmOptions& film);
/// Adds --frames, --fps, --move, --path and --speed alone: for still pictures along a path.
void add_path_options(CLI::App& app, FilmOptions& film);
/// The file that --path names; empty: none.
std::string path_file(const FilmOptions& film);
/// `source`: what an animation moves besides camera and lights is moved, too, loaded by this; null: a note says that it
/// stays.
/// The scene's own path goes before a built-in one of the same name; where nothing is asked for, its first one is taken
/// and a note says so. Errors: usage for a path that does not suit what moves; bad input of a file.
Expected<compare::FilmPlan> resolve_film(const FilmOptions& film, const std::vector<KeyedPath>& own_paths,
                                         const Scene& scene, Console& console,
                                         const StageSource* source = nullptr);

/// What errors of a sweep or of the tuner are counted in, and the film where they are flips.
struct FilmedMeasure {
  const compare::Figure* measure = &compare::wrong_and_mean();
  FilmOptions film;
  bool is_filmed() const { return measure->needs == compare::FigureNeeds::film; }
};
/// Fails (usage) for --anchors or --drift without a film.
Expected<void> check_film_use(const FilmedMeasure& asked);
/// " --frames 24 --path walk": what was given, to be typed again.
std::string film_arguments(const FilmOptions& film);

}  // namespace gnomon::app
