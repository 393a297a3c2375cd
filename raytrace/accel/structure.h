// Every structure but the default one (raytrace/bvh/bvh.h) and brute force, behind one function. What they are is in
// raytrace/accel/any_structure.h, so that the default one's kernels are compiled without them.
#pragma once

#include "raytrace/tracer.h"
#include "scene/base/parallel.h"

namespace gnomon::raytrace {

struct BoxRay;
struct Structure;

/// Whether `accel` lives in a Structure.
bool has_structure(Accel accel);
Structure build_structure(const World& world, Accel accel);

struct StructureSize {
  std::uint64_t nodes = 0, bytes = 0;  ///< without the primitives
};
StructureSize size_of(const Structure& structure);

/// What a traversal reports to: visit(place in leaf order); true ends it.
using LeafVisitor = FunctionRef<bool(std::uint32_t leaf)>;

/// traverse() of the one that it holds; given `work`, adds what is tested.
bool traverse_structure(const Structure& structure, BoxRay& ray, WorkCounts* work, const LeafVisitor& visit);

}  // namespace gnomon::raytrace
