// A map that follows the camera by less than whole texels draws its shadow edges anew at every step of the
// camera: they swim.
#pragma once

#include <span>
#include <string>

#include "raster/options.h"
#include "scene/image.h"
#include "scene/world.h"

namespace gnomon::app {

/// A note that names the lights whose map does so; empty where none does. Whether a map follows the camera is
/// found by moving it.
std::string swim_note(const World& world, const raster::MapOptions& map, ImageSize size,
                      std::span<const std::uint32_t> lights);

}  // namespace gnomon::app
