// Films that the lab can play: the paths of the scene itself, and those of `gnomon shimmer` that suit its lights. A
// moment of a film is a camera and lights as poses, so that whatever is set can be said in words there too.
#pragma once

#include <string>
#include <vector>

#include "app/pose.h"
#include "compare/path.h"

namespace gnomon::lab {

struct LabFilm {
  std::string
      name;  ///< of the scene's path, or "camera-orbit", "camera-walk", "camera-turn", "light-orbit", "sun"
  std::string title;  ///< "The camera walks ahead"
  compare::ShimmerPath path;
  double seconds = 0.0;  ///< > 0
};

/// `first`: the scene's own camera and lights. Paths that a pose cannot follow are left out: those that aim a spot again.
std::vector<LabFilm> films_of(const compare::Pose& first, const Vec3& centre,
                              const std::vector<KeyedPath>& own_paths);

/// What the film moves, at a time in [0, its seconds]; nothing for what stands still.
struct FilmMoment {
  std::optional<app::CameraPose> camera;
  std::vector<std::optional<app::LightPose>> lights;  ///< as the scene's
};
FilmMoment moment_of(const LabFilm& film, const compare::Pose& first, const Vec3& centre, double seconds);

}  // namespace gnomon::lab
