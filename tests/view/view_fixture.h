// A state over two lights, without a scene file.
#pragma once

#include "lab/view/state/state.h"

namespace gnomon::lab {

inline ViewState two_light_state() {
  ViewState state;
  state.given.camera.eye = {0.0, 3.0, 4.0};  // distance 5
  state.given.camera.target = Vec3(0.0);
  Light sun, lamp;
  sun.name = "sun";
  sun.direction = {0.0, -1.0, 0.0};
  lamp.name = "lamp";
  lamp.type = LightType::point;
  lamp.position = {0.0, 0.0, 2.0};
  state.given.lights = {sun, lamp};
  state.setup.lights.resize(2);
  state.initial = state.setup;
  state.texel_world = 0.01;
  return state;
}

}  // namespace gnomon::lab
