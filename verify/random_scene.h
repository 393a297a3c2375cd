// Small random scenes whose light lies where rounding decides: in the planes of faces, at corners, at an apex or a rim,
// inside bodies. What shall lie in an axis-parallel plane does so exactly, its coordinates being multiples of 1/8; half of the
// scenes are then rotated, scaled and moved, so that it does so but for rounding.
#pragma once

#include "raster/frame.h"
#include "raytrace/frame.h"
#include "scene/scene.h"
#include "verify/small_world.h"

namespace gnomon::verify {

/// Boxes, loose triangles, some of them nearly without an area, one or two planes, spheres, solids; some meshes stand twice,
/// have holes, or show their front alone; in a third of the scenes one of the shapes stands there once more in another
/// description (small_world.h); a camera and one light without size.
Scene random_scene(Random& random);

/// With its instances kept, if a mesh stands more than once.
World world_of(const Scene& scene);

struct Agreement {
  std::uint64_t asked =
      0;  ///< pixels that show the same primitive, face the light and are surely lit or surely shadowed
  std::uint64_t wrong = 0;  ///< of these, drawn otherwise than the rays say
};

/// A floor, a box and loose triangles under one light of this type, for what must not change with the numbers that
/// a scene is given in. Coordinates are multiples of 1/64. So sums with 1e7 and the middles of edges are exact, in
/// floats, too.
Scene invariant_scene(LightType type, Random random);

/// The first light's drawn visibility against the ray tracer's.
Agreement compare_with_rays(const Scene& scene, const raster::RasterFrame& drawn,
                            const raytrace::RayTracedFrame& traced);

// The same surface once more in another description, which is equal to it but for rounding.

/// A sphere as an ellipsoid or by its expression, a plane by its expression, a cylinder as a cone, any other solid by its
/// expression; frames are turned where the surface allows it. `reach`: world units, a half of how much of a plane there is.
Shape described_otherwise(const Shape& shape, double reach, Random& random);

/// A square in the plane of a shape's cap, larger than the cap; without triangles where the shape has none.
Mesh quad_in_cap(const Shape& shape, Random& random);

/// One shape of the scene in another description, among its shapes; or a square in the plane of its cap.
void add_twin(Scene& scene, Random& random);

}  // namespace gnomon::verify
