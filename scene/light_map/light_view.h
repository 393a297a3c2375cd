// The geometry of a light's depth map: which texel a world point looks up, and which ray a texel stands for.
// Both renderers and the comparison take it from here (shaders/light_map.glsl is the GLSL twin).
//
// Each face has an orthonormal frame (right, up, forward), forward = away from the light. Texel coordinates
// (u, v) run from (0, 0) to (size, size), v along `up` (OpenGL's window convention: row 0 is the lowest);
// texel (i, j) has its centre at (i + 1/2, j + 1/2). "Depth" is the coordinate along forward, in world units
// from `origin`; "distance" is measured along the light ray (equal to depth for an orthographic map).
//
// A face covers its own rectangle and range of depths (cascades), and an orthographic one may be *warped*
// along up (Wimmer et al. 2004). Let y be measured from the face's centre, b be its half extent along up and
// s its warp. The map then shows (x, y + s b^2) / (1 + s y). This keeps y = -b, b where they are and gives
// more texels to the end where y is low. Light rays stay parallel; a texel's column is then a prism over a
// trapezium.
#pragma once

#include <array>

#include "scene/base/expected.h"
#include "scene/math.h"
#include "scene/scene.h"
#include "scene/world.h"

namespace gnomon {

/// A short list of numbers that is part of an options struct: a size, a place, the ends of some slices. It holds up to six; an
/// empty one stands for "not given".
struct NumberList {
  std::array<double, 6> values{};
  int count = 0;

  constexpr bool empty() const { return count == 0; }
  double operator[](int i) const { return values[static_cast<std::size_t>(i)]; }
  /// Does nothing where the list is full.
  void push_back(double value) {
    if (static_cast<std::size_t>(count) < values.size()) values[static_cast<std::size_t>(count++)] = value;
  }
  const double* begin() const { return values.data(); }
  const double* end() const { return values.data() + count; }
  bool operator==(const NumberList&) const = default;
};

enum class LightProjection : std::uint8_t { orthographic, perspective };

struct LightFace {
  Vec3 right, up, forward;
  Vec2 center{0.0};         ///< the middle of an orthographic face, along right and up from LightView::origin
  Vec2 half_extent{1.0};    ///< along right and up: world units (orthographic), tangents of half-angles
                            ///< (perspective); of a warped face along right: at its centre
  double near_depth = 0.0;  ///< mapped to stored depth 0
  double far_depth = 1.0;   ///< mapped to stored depth 1 (of a warped face: at its low end)
  double warp = 0.0;        ///< orthographic: >= 0, times half_extent.y below 1; 1 / world units
};

struct LightView {
  LightProjection projection = LightProjection::orthographic;
  int size = 0;  ///< texels on a side
  int face_count =
      1;  ///< 6 for a point light, in the order +x -x +y -y +z -z; orthographic: cascades, finest first
  /// Gnomon's own maps have six at most; cascades and levels of another renderer's may be more.
  static constexpr std::size_t most_faces = 32;
  std::array<LightFace, most_faces> faces{};
  Vec3 origin{0.0};       ///< the light's position, or where depth is 0 and centres are measured from
  bool seamless = false;  ///< of a cube: no point falls beside the face that it belongs to
  bool reversed = false;  ///< stored depth is 1 at the near depth and 0 at the far one

  const LightFace& face(int i) const { return faces[static_cast<std::size_t>(i)]; }
  /// Gives every face this extent and these depths.
  void set_extent(const Vec2& half_extent, double near_depth, double far_depth);
  /// From the nearest near depth to the farthest far depth.
  Interval depth_range() const;
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

/// The middle of an orthographic face at depth 0; the light's position for a perspective one.
inline Vec3 face_origin(const LightView& view, const LightFace& face) {
  return view.origin + face.center.x * face.right + face.center.y * face.up;
}

/// Corners of a picture as shares of its half sides, in turn.
inline constexpr std::array<Vec2, 4> corner_places{Vec2{-1.0, -1.0}, Vec2{1.0, -1.0}, Vec2{1.0, 1.0},
                                                   Vec2{-1.0, 1.0}};
/// What a face covers, in the world: its corners at the near depth in the order of corner_places, then those at the far
/// depth.
std::array<Vec3, 8> face_corners(const LightView& view, int face);

/// Point lights choose the face of the largest |component|; ties go to x, then y, then z.
int cube_face(const Vec3& from_light);
/// The frames of a cube's faces in cube_face()'s order, 90 degrees wide, with depths from 0 to 1.
std::array<LightFace, 6> cube_faces();

/// A point in several cascades belongs to the first that holds it and the four texels around it; one in none,
/// to the last.
TexelCoordinate project_to_texel(const LightView& view, const Vec3& world);
/// Projects on the cascades from `first` on.
TexelCoordinate project_from_cascade(const LightView& view, int first, const Vec3& world);
/// Projects on a face that is chosen already.
TexelCoordinate project_to_face(const LightView& view, int face, const Vec3& world);

/// The light ray through map position (u, v) in texels, direction unit, t = distance. Starts at the light
/// (perspective) or at depth 0 (orthographic), with interval [-infinity, infinity] for orthographic maps,
/// whose casters may lie before depth 0, and [0, infinity] for perspective ones.
Ray texel_ray(const LightView& view, int face, double u, double v);

/// World width of one texel (its wider side), perpendicular to forward, at the given depth; of a warped face
/// at its centre.
double texel_world_size(const LightView& view, int face, double depth);
/// Returns the size of the texel in which a point falls.
double texel_world_size(const LightView& view, const TexelCoordinate& at);

/// Corners of a texel's column in turn (low x and y first): (x, y) along right and up from `origin`, at depth
/// 1 of a perspective map.
std::array<Vec2, 4> column_corners(const LightView& view, int face, int column, int row);

/// Whether a stored depth is that of a caster, not of an empty texel.
inline bool holds_caster(const LightView& view, double stored) {
  return view.reversed ? stored > 0.0 : stored < 1.0;
}

/// Stored depth in [0, 1] <-> depth in world units, on the ray at height v of a face (texels; only a warped
/// face depends on it). Orthographic: linear. Perspective: OpenGL's hyperbola with zero-to-one clip range: s
/// = f (z - n) / (z (f - n)). Warped: linear along each ray, times (1 - s b) / (1 + s y). Reversed: n and f
/// change places.
double stored_from_depth(const LightView& view, int face, double v, double depth);
double depth_from_stored(const LightView& view, int face, double v, double stored);

/// light_clip_from_relative, for points given relative to `reference` (camera-relative upload); z in [0, w].
Mat4 light_clip_from_relative(const LightView& view, int face, const Vec3& reference);

/// The window of a light's map where a user gives it, as an engine has it; what is left empty is fitted. Places and sizes
/// are world units. Of a spot or point light the depths alone can be given.
struct LightWindow {
  NumberList size{};  ///< width and height of the whole window, above 0
  NumberList
      origin{};  ///< where the light's camera stands: the window's middle, from which depths are counted
  /// Near and far, near < far; counted from the origin, or from the middle of what is finite; of a spot or point light
  /// from the light, above 0.
  NumberList depths{};
  bool empty() const { return size.empty() && origin.empty() && depths.empty(); }
  bool operator==(const LightWindow&) const = default;
};

/// Fits a map of size x size texels tightly around what matters: all finite casters, restricted for a
/// directional light to the part whose shadows the camera can see. Depth range: casters and receivers inside
/// the map. A scene of infinite planes alone gets the part of them that the camera sees within 50 times its
/// distance from them. Error (graphics) when nothing can be fitted;
/// (usage) a window's size or origin for a light that is not directional, or depths before a spot or point light.
Expected<LightView> fit_light_view(const World& world, const Light& light, const Camera& camera,
                                   double aspect, int size, const LightWindow& window = {});

// Where a directional light's own map lies, without its depths, which take a look at every triangle.

/// Whether the texels that fit_light_view() gives a directional light lie elsewhere for the one camera than for the
/// other. False where it gives none.
bool window_moves(const World& world, const Light& light, const std::array<Camera, 2>& cameras, double aspect,
                  int size, const LightWindow& window = {});

/// How the triangles and finite shapes of a world lie to an orthographic map of one face. A caster whose shadow can fall
/// into the window lies inside it across the light; one before the near plane is drawn at that plane, one beyond the far
/// plane is not drawn.
struct WindowCasters {
  std::uint64_t inside = 0;  ///< wholly inside the window, and between its depths
  std::uint64_t cut = 0;     ///< partly inside the window, or across a depth
  std::uint64_t beside = 0;  ///< wholly beside the window
  std::uint64_t before = 0;  ///< inside, wholly before the near plane
  std::uint64_t beyond = 0;  ///< inside, wholly beyond the far plane
  std::uint64_t count() const { return inside + cut + beside + before + beyond; }
};
WindowCasters window_casters(const World& world, const LightView& view);

}  // namespace gnomon
