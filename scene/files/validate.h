// The last check of every format: what the renderers rely on and may assume.
#pragma once

#include <optional>

#include "scene/base/expected.h"
#include "scene/scene.h"

namespace gnomon {

/// Coordinates in world units are below this in magnitude, so that squares and areas stay finite in float
/// too.
inline constexpr double max_coordinate = 1e15;
inline constexpr double max_radiance = 1e30;

/// True when the matrix flattens space, judged against the lengths of its columns.
bool is_singular(const Mat3& matrix);

/// What is wrong with a camera, with Error::field "camera.target" and so on.
std::optional<Error> find_camera_defect(const Camera& camera);

/// The first thing that breaks the contract of load_scene (scene/load.h), as an error with the path inside the scene
/// ("meshes[2].positions[17]"); none if all is well. First indices, materials, coordinates and transforms: what must
/// hold before anything follows an index.
std::optional<Error> find_geometry_defect(const Scene& scene);

/// What may be wrong beside meshes and their instances; find_geometry_defect() comes first.
std::optional<Error> find_setting_defect(const Scene& scene);

}  // namespace gnomon
