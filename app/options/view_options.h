// From where a setting is judged: --cameras, or pictures along --path. One list of views for compare, sweep and tune.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/options/shimmer_options.h"
#include "compare/setting.h"

namespace gnomon::app {

struct ViewListOptions {
  std::vector<std::string> cameras;  ///< names; "all": every one of the file; empty: not given
  int along_path = 5;                ///< pictures, evenly over the film that --path and its options describe
  bool count_given = false;

  bool by_cameras() const { return !cameras.empty(); }
};

/// Adds --cameras and --views.
void add_view_options(CLI::App& app, ViewListOptions& views);

/// Returns whether --path or --move says where pictures are made.
bool follows_path(const FilmOptions& film);

/// Fails (usage), before anything is loaded, where cameras and a path are both given, or an option would change
/// nothing. `is_given`: whether an option, without dashes, was given. `filmed`: --measure
/// shimmer, whose path is the film's.
Expected<void> check_views(const ViewListOptions& views, const std::string& camera, const FilmOptions& film,
                           bool filmed, const std::function<bool(std::string_view)>& is_given);

/// Returns the views of a scene; none where a single picture was asked for. `lights`: a scene with the lights that are kept, and
/// the camera that a path begins at. Errors: usage for a camera or path that there is not; bad input for a place along
/// the path that shows nothing.
Expected<std::vector<compare::JudgedView>> resolve_views(const ViewListOptions& views,
                                                         const FilmOptions& film, bool filmed,
                                                         const LoadedScene& loaded, const Scene& given,
                                                         Console& console);

/// Returns what was given, to be typed again: " --cameras all", " --path walk --views 5".
std::string view_arguments(const ViewListOptions& views, const FilmOptions& film, bool filmed);

}  // namespace gnomon::app
