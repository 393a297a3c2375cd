// The scene of a film whose objects move, as it stands from frame to frame: of shimmer, and of sweep and tune with --measure
// shimmer.
#pragma once

#include "app/session.h"
#include "compare/path.h"

namespace gnomon::app {

/// What the scene is loaded and drawn with.
struct StageSource {
  SceneArgument scene;
  std::string camera;
  raster::Backend backend = raster::Backend::automatic;
  std::string shader_folder;
};

/// Returns what loads the scene again for each moment of its animation (FilmPlan::stage). What it gives has the errors
/// of load_scene and make_renderer.
std::function<Expected<compare::FilmStage>(double seconds)> stages_of(StageSource source,
                                                                      std::string animation);

}  // namespace gnomon::app
