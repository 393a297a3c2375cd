// The shadows that engines draw with rays, as the rasterizer's Technique::rays: a few rays for each pixel, and a denoiser with a
// history. A light without size takes one exact ray and no denoiser.
#pragma once

#include <memory>

#include "raster/external_visibility.h"
#include "scene/world.h"

namespace gnomon::rays {

/// The ray tracer is built when it is first asked. Lights are read from the world's scene at each call, so they may move in
/// between; the world must not change and must outlive the result. A picture's history is that of a camera and lights that
/// stand still: its frames are cast when it is first asked for, and are no part of the times. A film's is that of its frames.
std::shared_ptr<raster::ExternalVisibility> make_visibility(const World& world);

}  // namespace gnomon::rays
