// Building blocks for generated meshes: flat polygons, lofts, prisms, boxes, turned profiles, tubes.
// Conventions: counter-clockwise seen from outside; a solid's pieces share bitwise equal positions along
// their common edges, so that welding by position finds it closed; normals are per face where the shape has
// an edge and averaged where it is round; texture coordinates are metres on the face.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace gnomon {

/// Metres that stones run into each other, so that no two faces coincide.
inline constexpr double stone_overlap = 0.004;

/// A point of a turned profile: distance from the axis and height. `crease` splits the normals there.
struct ProfilePoint {
  double radius = 0.0;
  double height = 0.0;
  bool crease = false;
};

enum class Shading : std::uint8_t { flat, smooth };

class MeshBuilder {
 public:
  std::uint32_t vertex(const Vec3& position, const Vec3& normal, const Vec2& uv);
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);

  /// A convex flat polygon; its normal is that of Newell's method, its uv the two axes most along it.
  void polygon(std::span<const Vec3> corners);

  /// Joins rings of equally many points with quads and closes both ends with their (convex) caps. Seen from
  /// the last ring towards the first, a ring runs counter-clockwise. Closed; flat shading.
  void loft(std::span<const std::vector<Vec3>> rings);

  /// A box; its edges are chamfered by `bevel` (0: sharp).
  void box(const Vec3& min, const Vec3& max, double bevel = 0.0);

  /// A convex outline in the x-y plane, counter-clockwise, from z = back to z = front, the edges of both caps
  /// chamfered by `bevel`. `world_from_local` places it; it must not mirror.
  void prism(std::span<const Vec2> outline, double back, double front, double bevel,
             const Mat4& world_from_local);

  /// Turns a profile about the y axis. The profile runs so that the outside is on its right when y points up
  /// and the radius to the right (upwards on an outer wall). Closed when it begins and ends on the axis.
  void lathe(std::span<const ProfilePoint> profile, int segments);

  /// A round tube through `centers`, closed at both ends by flat caps.
  void tube(std::span<const Vec3> centers, std::span<const double> radii, int sides);

  /// Adds a copy of a mesh; the matrix must not mirror.
  void append(const Mesh& mesh, const Mat4& world_from_mesh);

  bool empty() const { return mesh_.triangles.empty(); }
  Mesh take() { return std::move(mesh_); }

 private:
  void quad(const std::array<Vec3, 4>& corners);
  Mesh mesh_;
};

/// The convex polygon moved inwards by `distance` on every side (counter-clockwise in, counter-clockwise
/// out).
std::vector<Vec2> inset(std::span<const Vec2> convex_outline, double distance);

/// Points of a polyline that rounds a semicircle or any arc: `count` segments from angle `from` to `to`
/// (radians).
std::vector<Vec2> arc(const Vec2& center, double radius, double from, double to, int count);

}  // namespace gnomon
