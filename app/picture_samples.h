// How many samples a ray-traced picture takes: what the scene says, or what the command line says instead.
#pragma once

#include <optional>

#include "scene/scene.h"

namespace CLI {
class App;
}

namespace gnomon::app {

struct PictureSamples {
  std::optional<int> per_pixel, glossy, indirect;
};

/// --aa, --glossy-samples, --indirect-samples.
void add_picture_samples(CLI::App& command, PictureSamples& samples);

/// Writes what was asked for into the scene, so that its effect plan follows.
void apply_picture_samples(const PictureSamples& samples, Scene& scene);

}  // namespace gnomon::app
