// Instances that repeat another one exactly, as exporters leave them by the thousand.
#pragma once

#include "scene/scene.h"

namespace gnomon {

/// Takes out every instance that has the mesh, the matrix and the material of one before it, and says so in a note. Nothing of it
/// could be seen, for of equal depths the first wins; but each ray and each texel would meet them all. Glass stays: light goes
/// through one after the other.
void leave_out_repeated_instances(Scene& scene);

}  // namespace gnomon
