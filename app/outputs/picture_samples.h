// How many samples a ray-traced picture takes: what the scene says, or what the command line says instead.
#pragma once

#include <optional>
#include <string>

#include "scene/effects.h"
#include "scene/image.h"
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

/// What is said before a picture that may take days. Glass splits each ray in two at every surface. That goes on down to the
/// scene's depth, or until a ray carries less than `min_contribution` of its pixel. Empty where there are fewer than 1e11 such
/// rays.
std::string many_rays_note(const Scene& scene, const EffectPlan& plan, double min_contribution,
                           const ImageSize& size);

}  // namespace gnomon::app
