// What of a scene hangs together, and which of it a made camera does not look at: grounds, backdrops and shells around
// everything else.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/files/polygon.h"

namespace gnomon {

/// Triangles of one instance that share corners, welded by position; or one shape that is no plane.
struct ScenePart {
  Aabb box;            ///< in the world
  bool casts = false;  ///< some of it casts shadows
  /// Returns whether it is thin along an axis of the world, such as a sea or a wall.
  bool flat() const;
};

class SceneParts {
 public:
  /// The scene must outlive this.
  explicit SceneParts(const Scene& scene);

  const std::vector<ScenePart>& all() const { return parts_; }
  /// Visits all placed triangles of the meshes, each with the number of its part.
  template <class Visit>
  void visit_triangles(const Visit& visit) const {
    for (std::size_t i = 0; i < scene_->instances.size(); ++i) {
      const MeshInstance& instance = scene_->instances[i];
      const std::vector<std::uint32_t>& pieces = pieces_[instance.mesh];
      std::size_t triangle = 0;
      visit_placed(*scene_, instance, 0, pieces.size(),
                   [&](const PlacedTriangle& t) { visit(t, first_[i] + pieces[triangle++]); });
    }
  }
  /// Visits all shapes but planes, each with the number of its part.
  template <class Visit>
  void visit_shapes(const Visit& visit) const {
    std::uint32_t part = first_.back();
    for (const Shape& shape : scene_->shapes)
      if (!std::holds_alternative<Plane>(shape.geometry)) visit(shape, part++);
  }

 private:
  const Scene* scene_;
  std::vector<std::vector<std::uint32_t>> pieces_;  ///< by mesh: of each triangle
  std::vector<std::uint32_t> first_;  ///< by instance, the number of its first part; then that of the shapes
  std::vector<ScenePart> parts_;
};

/// What a made camera looks at, and what it leaves aside: flat parts that are large beside all else, and a shell that
/// holds all else and hides it.
struct Subject {
  std::vector<char> aside;  ///< by part
  Aabb box;                 ///< of what is looked at
  bool anything = false;    ///< some part was set aside
  bool in_shell = false;    ///< a shell was
};

/// Returns the subject as far as the parts' places tell it; no shell is set aside where `with_shell` is false.
Subject find_subject(const SceneParts& parts, bool with_shell);

/// Returns the box around a shape that is no plane.
Aabb box_of(const Shape& shape);

/// Visits the eight corners of a box.
template <class Visit>
void for_each_corner(const Aabb& box, const Visit& visit) {
  for (int corner = 0; corner < 8; ++corner)
    visit(Vec3((corner & 1) ? box.max.x : box.min.x, (corner & 2) ? box.max.y : box.min.y,
               (corner & 4) ? box.max.z : box.min.z));
}

/// Adds up, with add(sum, point), points whose hull holds all that is finite: corners of triangles, and of the boxes around
/// shapes.
template <class Sum, class Add, class Join>
Sum over_points(const Scene& scene, const Sum& none, const Add& add, const Join& join) {
  Sum sum = over_placed_triangles(
      scene, none,
      [&](Sum& of_triangles, const PlacedTriangle& t) {
        add(of_triangles, t.a), add(of_triangles, t.b), add(of_triangles, t.c);
      },
      join);
  const auto visit = [&](const Vec3& p) { add(sum, p); };
  for (const Shape& shape : scene.shapes)
    if (!std::holds_alternative<Plane>(shape.geometry)) for_each_corner(box_of(shape), visit);
  return sum;
}

}  // namespace gnomon
