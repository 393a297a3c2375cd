// One renderer's picture as a file: PNG for the eye, or EXR with everything that the renderer knows of each
// pixel.
#pragma once

#include <optional>
#include <string>

#include "raster/frame.h"
#include "raytrace/frame.h"
#include "scene/base/expected.h"
#include "scene/camera.h"
#include "scene/files/pictures/image_io.h"
#include "scene/world.h"

namespace gnomon::app {

/// The picture's factor: what was asked for, else the scene's own, else auto_exposure of this picture.
double choose_exposure(const std::optional<std::optional<double>>& asked, const Scene& scene,
                       const ColorImage& color);
/// Tells the exposure without a picture; nothing where the picture would have to be looked at.
std::optional<double> known_exposure(const std::optional<std::optional<double>>& asked, const Scene& scene);

/// Every EXR holds R,G,B (linear radiance), object.V and primitive.V (-1 for background). With several
/// lights, a light's channels carry its name in front ("sun.gap.V").
///
/// Raster, per light: drawn.V (1 lit, 0 shadowed), gap.V (world units), texel_uv.U/V (texels), distance.V (to
/// the light, world units).
Expected<void> write_picture(const std::string& path, const World& world, const raster::RasterFrame& frame,
                             double exposure);
/// Ray tracer: position.X/Y/Z, normal.X/Y/Z, Z (depth along the view direction; infinity for background), and
/// per light truth.V (1 lit, 0 shadowed, 0.5 uncertain).
Expected<void> write_picture(const std::string& path, const World& world,
                             const raytrace::RayTracedFrame& frame, double exposure);

/// An EXR's channels, of a frame that may be a band of the picture.
std::vector<Channel> exr_channels(const World& world, const raster::RasterFrame& frame);
std::vector<Channel> exr_channels(const World& world, const raytrace::RayTracedFrame& frame);

}  // namespace gnomon::app
