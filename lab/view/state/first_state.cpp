#include "lab/view/state/first_state.h"

#include <utility>

#include "app/session.h"

namespace gnomon::lab {

Expected<ViewState> first_state(const LabOptions& options, GivenScene given) {
  Scene bare;
  bare.camera = given.camera, bare.lights = given.lights;
  const auto lights = app::choose_lights(bare, options.light);
  if (!lights) return fail(lights.error());
  const auto poses = app::resolve_poses(options.poses, options.light, bare, given.centre);
  if (!poses) return fail(poses.error());
  ViewState state;
  state.given = std::move(given);
  state.setup.lights.resize(state.given.lights.size());
  state.setup.light = lights->front();
  state.setup.map = options.compare.raster.map;
  state.setup.size = options.compare.raster.size;
  state.setup.precision = options.compare.precision;
  state.setup.camera = poses->camera;
  if (poses->light_pose) state.setup.lights[poses->light] = poses->light_pose;
  state.initial = state.setup;
  return state;
}

}  // namespace gnomon::lab
