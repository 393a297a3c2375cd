// The same surface once more in another description, which is equal to it but for rounding.
#pragma once

#include "scene/scene.h"
#include "verify/random.h"

namespace gnomon::verify {

/// A sphere as an ellipsoid or by its expression, a plane by its expression, a cylinder as a cone, any other solid by its
/// expression; frames are turned where the surface allows it. `reach`: world units, a half of how much of a plane there is.
Shape described_otherwise(const Shape& shape, double reach, Random& random);

/// A square in the plane of a shape's cap, larger than the cap; without triangles where the shape has none.
Mesh quad_in_cap(const Shape& shape, Random& random);

/// One shape of the scene in another description, among its shapes; or a square in the plane of its cap.
void add_twin(Scene& scene, Random& random);

}  // namespace gnomon::verify
