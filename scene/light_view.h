// The geometry of a light's depth map: which texel a world point looks up, and which ray a texel stands for.
// Both renderers and the comparison take it from here (shaders/light_view.glsl is the GLSL twin).
//
// Each face has an orthonormal frame (right, up, forward), forward = away from the light. Texel coordinates
// (u, v) run from (0, 0) to (size, size), v along `up` (OpenGL's window convention: row 0 is the lowest);
// texel (i, j) has its centre at (i + 1/2, j + 1/2). "Depth" is the coordinate along forward, in world units
// from `origin`; "distance" is measured along the light ray (equal to depth for an orthographic map).
#pragma once

#include <array>

#include "scene/expected.h"
#include "scene/ray.h"
#include "scene/scene.h"
#include "scene/world.h"

namespace gnomon {

enum class LightProjection : std::uint8_t { orthographic, perspective };

struct LightFace {
  Vec3 right, up, forward;
};

struct LightView {
  LightProjection projection = LightProjection::orthographic;
  int size = 0;        ///< texels on a side
  int face_count = 1;  ///< 6 for a point light, in the order +x -x +y -y +z -z
  std::array<LightFace, 6> faces{};
  Vec3 origin{0.0};  ///< the light's position, or the centre of the orthographic map at depth 0
  Vec2 half_extent{
      1.0};  ///< along right and up: world units (orthographic), tangents of half-angles (perspective)
  double near_depth = 0.0;  ///< mapped to stored depth 0
  double far_depth = 1.0;   ///< mapped to stored depth 1
};

/// Where a world point falls in the map.
struct TexelCoordinate {
  int face = 0;
  double u = 0.0, v = 0.0;  ///< texels
  double depth = 0.0;  ///< along forward; <= 0 means behind a perspective light (u, v are then meaningless)
  double distance = 0.0;  ///< along the light ray
  bool inside = false;    ///< on the map: 0 <= u, v < size, and depth > 0 for a perspective map
  int column() const { return static_cast<int>(std::floor(u)); }
  int row() const { return static_cast<int>(std::floor(v)); }
};

/// Point lights choose the face of the largest |component|; ties go to x, then y, then z.
int cube_face(const Vec3& from_light);

TexelCoordinate project_to_texel(const LightView& view, const Vec3& world);
/// The same on a face already chosen.
TexelCoordinate project_to_face(const LightView& view, int face, const Vec3& world);

/// The light ray through map position (u, v) in texels, direction unit, t = distance. Starts at the light
/// (perspective) or at depth 0 (orthographic), with interval [-infinity, infinity] for orthographic maps,
/// whose casters may lie before depth 0, and [0, infinity] for perspective ones.
Ray texel_ray(const LightView& view, int face, double u, double v);

/// World width of one texel (its wider side), perpendicular to forward, at the given depth.
double texel_world_size(const LightView& view, double depth);

/// The four planes of a texel's column of light rays: p is inside iff dot(normal, p - view.origin) >= offset
/// for all. Normals are unit length. The column of a perspective map also needs depth > 0.
struct HalfSpace {
  Vec3 normal;
  double offset;
};
std::array<HalfSpace, 4> column_planes(const LightView& view, int face, int column, int row);

/// Stored depth in [0, 1] <-> depth in world units. Orthographic: linear. Perspective: OpenGL's hyperbola
/// with zero-to-one clip range: s = f (z - n) / (z (f - n)).
double stored_from_depth(const LightView& view, double depth);
double depth_from_stored(const LightView& view, double stored);

/// light_clip_from_relative, for points given relative to `reference` (camera-relative upload); z in [0, w].
Mat4 light_clip_from_relative(const LightView& view, int face, const Vec3& reference);

/// Fits a map of size x size texels tightly around what matters: all finite casters, restricted for a
/// directional light to the part whose shadows the camera can see. Depth range: casters and receivers inside
/// the map. A scene of infinite planes alone gets the part of them that the camera sees within 50 times its
/// distance from them. Error (graphics) when nothing can be fitted.
Expected<LightView> fit_light_view(const World& world, const Light& light, const Camera& camera,
                                   double aspect, int size);

}  // namespace gnomon
