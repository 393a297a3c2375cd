// What the ray tracer finds for rays at the surfaces of the intersection figures (report/page/src/lessons), whose
// numbers the page works out by itself.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "scene/expected.h"

namespace gnomon::app::lessons {

/// `kind`: box, triangle, sphere, implicit. {"checks": [{from, to, t}]}: rays in the plane z = 0 from one point towards another, and the
/// distance of the first hit or null; of a triangle "checks" [{corners [[x, y], …], t}]: seen along a ray down the z axis,
/// corners at depths 2, 3 and 5. Error (internal): no such kind.
Expected<nlohmann::ordered_json> intersection_checks(const std::string& kind);

}  // namespace gnomon::app::lessons
