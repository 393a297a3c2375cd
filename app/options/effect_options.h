// Options that belong to an effect: where the scene (its lights and materials) does not call for the effect,
// nothing of it is simulated and the option changes nothing. That is no mistake of the command line, so it is
// said in a note.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "raster/options.h"
#include "scene/effects.h"
#include "scene/image.h"
#include "scene/world.h"

namespace CLI {
class App;
}

namespace gnomon::app {

/// The options on the command line, without "--".
std::vector<std::string> given_options(const CLI::App& command);

/// One note for each given option that has no effect: "--samples has no effect: no light has a size".
std::vector<std::string> options_without_effect(std::span<const std::string> given, const EffectPlan& plan);

/// These notes are for options that need lights with a size, directional ones, or several cascades.
std::vector<std::string> options_without_effect(std::span<const std::string> given,
                                                const raster::MapOptions& map, const Scene& scene,
                                                std::span<const std::uint32_t> lights);

/// These notes are for options of a page where no page is written.
std::vector<std::string> page_options_without_effect(std::span<const std::string> given);

/// These notes are for options of a picture where a heat map of primary rays takes its place.
std::vector<std::string> heatmap_options_without_effect(std::span<const std::string> given);

// A map that follows the camera by less than whole texels draws its shadow edges again at every step of the
// camera: they swim.

/// A note that names the lights whose map does so; empty where none does. Whether a map follows the camera is
/// found by moving it.
std::string swim_note(const World& world, const raster::MapOptions& map, ImageSize size,
                      std::span<const std::uint32_t> lights);

}  // namespace gnomon::app
