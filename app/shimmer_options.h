// The options of `gnomon shimmer` that say how camera and light move.
#pragma once

#include "compare/shimmer/shimmer.h"

namespace CLI {
class App;
}

namespace gnomon::app {

struct MovementOptions {
  compare::Moves moves = compare::Moves::camera;
  std::vector<std::string> paths;  ///< names of built-in ones, or one file; empty: the usual ones
  double speed = 1.0;
  Vec2 drift_texels{0.1, 0.07};
};

/// --move, --path, --speed, --drift.
void add_movement_options(CLI::App& app, MovementOptions& movement);
/// The file that --path names; empty: none.
std::string path_file(const MovementOptions& movement);
/// Errors: usage for a path that does not suit what moves; bad input of a file.
Expected<compare::ShimmerPath> resolve_movement(const MovementOptions& movement, const Scene& scene);

}  // namespace gnomon::app
