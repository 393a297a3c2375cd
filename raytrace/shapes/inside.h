// Which closed objects hold a point. Spheres and solids are asked by their own function, meshes by the
// odd-crossings test. A point is inside when a ray from it crosses the mesh an odd number of times (Shimrat
// 1962, "Algorithm 112: position of point relative to polygon"). A ray that comes upon an edge or a corner
// says nothing sure, so another direction is tried.
//
// Objects are numbered as in World::object_of. An open mesh, an open solid and a plane hold nothing.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/world.h"

namespace gnomon::raytrace {

class InsideTest {
 public:
  /// Finds out which objects are closed. The world must outlive this.
  explicit InsideTest(const World& world);

  bool is_closed(std::uint32_t object) const { return objects_[object].closed; }
  /// Takes time linear in the object's triangles. On the surface itself either answer may come.
  bool contains(std::uint32_t object, const Vec3& point) const;

 private:
  struct Object {
    std::uint32_t first = 0, count = 0;  ///< primitives
    Aabb box;
    bool closed = false;
  };
  bool mesh_contains(const Object& object, const Vec3& point) const;

  const World* world_;
  std::vector<Object> objects_;
};

}  // namespace gnomon::raytrace
