// A parallel loop inside another one is skipped, in part or whole, once the outer one is given up because an error
// ended one of its threads: what the loop was to make is then not there. Who needs it asks here first.
#pragma once

#include <exception>

#include "scene/base/parallel.h"

namespace gnomon::raytrace {

/// Never seen outside: the outer loop already has the error that ends it.
struct GivenUp : std::exception {
  const char* what() const noexcept override { return "part of a work that an error ended"; }
};

/// After a parallel loop that may lie inside another one. Throws GivenUp when the work around it was given up.
inline void leave_if_given_up() {
  if (is_given_up()) throw GivenUp();
}

}  // namespace gnomon::raytrace
