// What a light's shadow is cast from. A light's strength and direction at a surface are its centre's; its shape says which
// share of it the surface sees. Disc and rectangle shine from both sides, as a point does.
//
// Each shape's file beside this one says all that is known of it. It tells how its points are drawn, what body and what box
// hold it, and what it is to a shader. A new shape is a struct here with its place in LightExtent, its file, and its keys
// in scene/files/scene.schema.json. Where a shader looks up its points in a way of their own, there are lines of
// shaders/technique/pcss.glsl, too. What is read, written, checked and turned follows from its measures.
#pragma once

#include <string_view>
#include <variant>
#include <vector>

#include "scene/base/parallel.h"
#include "scene/math.h"

namespace gnomon {

struct Light;
struct LightFace;
class JsonObject;

/// A number or a vector of a shape, by its name in files and results. Lengths lie in [0, max_coordinate], angles in
/// [0, pi/2]; a normal is a unit vector; a side leads from the centre to the middle of an edge.
struct ShapeMeasure {
  enum class Kind : std::uint8_t { length, angle, normal, side };
  std::string_view key;
  Kind kind;
  double* number = nullptr;        ///< a length or an angle
  Vec3* vector = nullptr;          ///< a normal or a side
  std::string_view degrees_key{};  ///< an angle's where files have it in degrees
};
using ShapeMeasures = std::vector<ShapeMeasure>;

/// A convex body around all that is sampled of a light with a size: its corners, and a ball.
struct LightHull {
  std::vector<Vec3> corners;  ///< their convex hull holds the whole light
  Vec3 center{0.0};
  double radius = 0.0;  ///< of a ball around the center that holds the whole light
};

/// Where the world lies that a light shines on; a sun is put at a distance from it that depends on `reach`.
struct LitWorld {
  Vec3 middle{0.0};
  double reach = 0.0;  ///< no coordinate of a receiver is larger
};

/// Leads from a point of the world to points of a light, evenly over the light's solid angle or area.
struct LightSampler {
  Vec3 from, center;
  /// The light's point for a point of the unit square; a sun's direction.
  Vec3 (*aim)(const LightSampler&, const Vec2& square) = nullptr;
  Vec3 axis{0.0}, u{0.0}, v{0.0};  ///< a cone's basis, or the half-axes u and v of an area
  double cap = 0.0;                ///< 1 - cos of the cone's half-angle
  double distance = 0.0, radius = 0.0;
};

/// Two vectors from the light's centre that span it for the shader: half the sides of a rectangle, radii of a disc. A
/// sphere's radius stands in x of the first; a sun's two are tangents at unit distance.
struct ShaderArea {
  Vec3 u{0.0}, v{0.0};
};

/// The centre alone: a hard light.
struct PointShape {
  static constexpr std::string_view name = "point", shader_define{};
  static constexpr bool is_sun = false;
  bool operator==(const PointShape&) const = default;
  double size() const { return 0.0; }
  bool resize(double) { return false; }
  ShapeMeasures measures() { return {}; }
  Vec3 half_extent() const { return Vec3(0.0); }
  LightHull hull(const Light& light, const LitWorld& world) const;
  void set_up(LightSampler& sampler, const Light& light) const;
  ShaderArea shader_area(const LightFace&) const { return {}; }
};

/// What a directional light's rays come from: a cone of directions.
struct SunDisc {
  double angular_diameter = 0.0;  ///< full angle, in [0, pi/2]; the sun's is 0.0093
  static constexpr std::string_view name = "sun", shader_define = "AREA_SUN";
  static constexpr bool is_sun = true;
  bool operator==(const SunDisc&) const = default;
  double size() const;  ///< the angular diameter in degrees
  bool resize(double size);
  ShapeMeasures measures();
  Vec3 half_extent() const;
  LightHull hull(const Light& light, const LitWorld& world) const;
  void set_up(LightSampler& sampler, const Light& light) const;
  ShaderArea shader_area(const LightFace& face) const;
};

struct SphereLight {
  double radius = 0.0;  ///< >= 0, around the light's position; so the disc's
  static constexpr std::string_view name = "sphere", shader_define = "AREA_SPHERE";
  static constexpr bool is_sun = false;
  bool operator==(const SphereLight&) const = default;
  double size() const { return radius; }
  bool resize(double size);
  ShapeMeasures measures();
  Vec3 half_extent() const;
  LightHull hull(const Light& light, const LitWorld& world) const;
  void set_up(LightSampler& sampler, const Light& light) const;
  ShaderArea shader_area(const LightFace& face) const;
};

struct DiscLight {
  double radius = 0.0;
  Vec3 normal{0.0, -1.0, 0.0};  ///< unit
  static constexpr std::string_view name = "disc", shader_define = "AREA_DISC";
  static constexpr bool is_sun = false;
  bool operator==(const DiscLight&) const = default;
  double size() const { return radius; }
  bool resize(double size);
  ShapeMeasures measures();
  Vec3 half_extent() const;
  LightHull hull(const Light& light, const LitWorld& world) const;
  void set_up(LightSampler& sampler, const Light& light) const;
  ShaderArea shader_area(const LightFace& face) const;
};

struct RectangleLight {
  Vec3 half_width{0.0}, half_height{0.0};  ///< from the centre to the middles of two sides; orthogonal
  static constexpr std::string_view name = "rectangle", shader_define = "AREA_RECTANGLE";
  static constexpr bool is_sun = false;
  bool operator==(const RectangleLight&) const = default;
  double size() const;  ///< half a diagonal
  bool resize(double size);
  ShapeMeasures measures();
  Vec3 half_extent() const;
  LightHull hull(const Light& light, const LitWorld& world) const;
  void set_up(LightSampler& sampler, const Light& light) const;
  ShaderArea shader_area(const LightFace& face) const;
  /// Files may say width, height, normal and up in place of the measures; false where they do not.
  static constexpr std::string_view form_keys[] = {"width", "height", "normal", "up"};
  bool read_form(const JsonObject& object, const Vec3& normal);
};

/// The table of shapes. A directional light has a point or a sun's disc, every other any other.
using LightExtent = std::variant<PointShape, SunDisc, SphereLight, DiscLight, RectangleLight>;

std::string_view shape_name(const LightExtent& extent);
/// The define of shaders/technique/pcss.glsl.
std::string_view shape_define(const LightExtent& extent);
bool is_sun_shape(const LightExtent& extent);
/// What --light-size sets: of a sun the angular diameter in degrees, of a lamp the radius of its sphere or disc, or half a
/// rectangle's diagonal. 0: a hard light.
double shape_size(const LightExtent& extent);
/// False where the shape cannot have the size: a point, and a rectangle without sides.
bool resize_shape(LightExtent& extent, double size);
/// They point into the extent.
ShapeMeasures shape_measures(LightExtent& extent);
void turn_shape(LightExtent& extent, FunctionRef<Vec3(const Vec3&)> turned);
/// Half the light's box; of a sun that of its directions.
Vec3 shape_half_extent(const LightExtent& extent);
LightHull light_hull(const Light& light, const LitWorld& world);
LightSampler light_sampler(const Light& light, const Vec3& from);
ShaderArea shape_shader_area(const LightExtent& extent, const LightFace& face);

/// What the shapes' files share: the corners of a square with half-sides u and v, widened against the rounding of samples
/// on its rim; the same around a disc; and a direction of a sampler's cone.
std::vector<Vec3> square_around(const Vec3& center, const Vec3& u, const Vec3& v);
std::vector<Vec3> square_around_disc(const Vec3& center, const Vec3& normal, double radius);
struct ConeDirection {
  Vec3 direction;
  double versine;         ///< 1 - cos of its angle to the axis
  double spread, radius;  ///< their product is the sine of that angle
};
ConeDirection cone_direction(const LightSampler& sampler, const Vec2& square);

}  // namespace gnomon
