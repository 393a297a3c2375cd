// The shape that a technique gives the map: which faces it has, what they cover, and how the shaders are
// told. Private to raster.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "raster/options.h"
#include "scene/camera.h"
#include "scene/light_map/light_view.h"

namespace gnomon::raster {

/// Error (usage): the technique has no map for this light; says which lights it has one for.
Expected<void> check_light(Technique technique, const Light& light);

/// The technique's fit looks at the surfaces that the camera sees.
bool fits_to_samples(const MapOptions& options);

/// `visible`: read only where fits_to_samples().
Expected<LightView> fit_map(const World& world, const Light& light, const Camera& camera, double aspect,
                            const MapOptions& options, std::span<const Vec3> visible);

/// Widens the window of an orthographic map that is not warped by `margin` on each side. Moves that of any
/// orthographic map across the light by `shift`. Both are in world units.
void move_window(const Vec3& shift, double margin, LightView& view);

/// MapOptions::snap of an orthographic map of one face without a warp; of any other nothing.
void snap_window(LightView& view, bool keep_size = false);

/// Whether two maps have the same texels at the same places.
bool same_window(const LightView& a, const LightView& b);

/// What shaders/light_map.glsl is to know, besides the light's type.
std::vector<std::string> map_defines(const MapOptions& options);

}  // namespace gnomon::raster
