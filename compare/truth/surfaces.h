// Which primitives belong to one connected surface: the triangles that share a corner (vertices welded by
// position), through any number of others; a shape is a surface of its own.
#pragma once

#include <mutex>

#include "raytrace/frame.h"
#include "raytrace/huge_array.h"
#include "raytrace/sheets/sheets.h"

namespace gnomon::compare {

class Surfaces {
 public:
  /// Both must outlive this. Nothing is worked out before the first question.
  Surfaces(const World& world, const raytrace::Topology& topology) : world_(world), topology_(topology) {}
  bool same(std::uint32_t a, std::uint32_t b) const;
  /// Works it out now, on every thread: a question asked by one of many threads leaves the others waiting.
  void prepare() const;

 private:
  void connect() const;
  const World& world_;
  const raytrace::Topology& topology_;
  mutable std::once_flag once_;
  /// Holds for each welded vertex the lowest of its surface. For instances that share their mesh's numbers
  /// (Topology::shared) it holds those of the first alone.
  mutable raytrace::HugeArray<std::uint32_t> parent_;
};

/// Whether two neighbouring pixels see one smooth surface: the same shape, or triangles whose normals differ by 25
/// degrees at most. The surface between those must not bend more than these normals say. A table's top and the
/// floor beyond its edge face the same way, but what connects them does not lie in their planes.
bool on_smooth_surface(const raytrace::SurfacePoint& a, const raytrace::SurfacePoint& b, const World& world);

}  // namespace gnomon::compare
