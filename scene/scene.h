// The scene model: what the files say, before any renderer touches it. Plain data.
// Conventions: right-handed; column vectors; matrices are named destination_from_source; colours are linear
// RGB with Rec. 709 primaries; lengths are world units; angles are radians.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scene/image.h"
#include "scene/light_shape/light_shape.h"
#include "scene/math.h"
#include "scene/shapes/expression.h"

namespace gnomon {

/// An 8-bit RGBA texture as stored in its file. Row 0 is the top row; texture coordinate v = 0 is that row
/// (glTF convention; loaders of v-up formats flip v). RGB is sRGB-encoded when `srgb`; alpha is always
/// linear.
struct Texture {
  std::string name;
  ImageSize size;
  std::vector<glm::u8vec4> texels;
  bool srgb = true;
  bool nearest = false;                   ///< nearest texel instead of bilinear
  bool repeat_s = true, repeat_t = true;  ///< false: clamp to edge
};

/// uv' = offset + R(rotation) * (scale * uv); KHR_texture_transform's order and sense.
struct TextureTransform {
  Vec2 offset{0.0};
  Vec2 scale{1.0};
  double rotation = 0.0;
};

enum class AlphaMode : std::uint8_t { opaque, mask };

/// Blinn-Phong with Whitted's mirror and transmission terms (Whitted 1980, eq. 2; Blinn 1977).
/// A surface shows (1 - mirror - transmission) of its local shading. Mirror and transmission are fractions in
/// [0, 1]; on a surface with transmission > 0, Fresnel splits that share between the reflected and the
/// refracted ray.
struct Material {
  std::string name;
  Vec3f diffuse{0.8f};      ///< albedo in [0, 1]; times the diffuse texture
  Vec3f specular{0.0f};     ///< Blinn-Phong specular colour in [0, 1]
  float shininess = 32.0f;  ///< Blinn-Phong exponent, > 0
  Vec3f emission{0.0f};     ///< radiance; times the emission texture
  float mirror = 0.0f;
  float transmission = 0.0f;
  float ior = 1.5f;        ///< > 0
  Vec3f absorption{0.0f};  ///< Beer-Lambert coefficient per world unit, >= 0
  float roughness = 0.0f;  ///< of mirror and transmission (glossy); 0 is sharp; the GGX alpha's root
  int priority = 0;        ///< where glass overlaps, the highest is there; of equals the one entered last
  bool thin = false;  ///< transmission through a sheet without inside: straight on, or blurred by roughness
  std::uint32_t diffuse_texture = no_id;
  TextureTransform texture_transform{};
  std::uint32_t emission_texture = no_id;
  TextureTransform emission_transform{};
  bool unlit = false;  ///< its local shading is its diffuse colour; no light changes it, and it casts shadows
  bool double_sided = true;  ///< false: its back does not stop what sees (see shows_back)
  bool casts_shadow = true;  ///< false: it is in no map, and no shadow ray meets it; it is seen all the same
  bool receives_shadow = true;  ///< false: all light that it faces arrives, in both renderers
  AlphaMode alpha_mode = AlphaMode::opaque;
  float alpha = 1.0f;         ///< times the texture's alpha and the vertex colour's
  float alpha_cutoff = 0.5f;  ///< mask: a hit with alpha < cutoff is no hit, in both renderers' shadows too
};

/// Whether a triangle's back is seen by the eye, and by mirrored, refracted and gathered rays: they go through that of
/// a single-sided material. Its front is the side from which its corners run counter-clockwise, in the mesh's own
/// space (glTF 2.0, section 3.7.4). Both sides cast shadows. A body of glass is always seen from inside, too; shapes
/// have one surface and are seen from both sides.
inline bool shows_back(const Material& m) {
  return m.double_sided || (m.transmission > 0.0f && !m.thin);
}

/// A triangle mesh in object space. normals, uvs and colors are empty or have one entry per position.
struct Mesh {
  std::string name;
  std::vector<Vec3> positions;
  std::vector<Vec3f> normals;
  std::vector<Vec2f> uvs;
  std::vector<Vec4f> colors;  ///< linear, with alpha: times the material's diffuse colour and alpha
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> triangle_materials;  ///< one per triangle, or empty: the instance's material
};

struct MeshInstance {
  std::string name;
  std::uint32_t mesh = 0;
  Mat4 world_from_object{1.0};
  std::uint32_t material = 0;  ///< for meshes without triangle_materials
};

struct Sphere {
  Vec3 center{0.0};
  double radius = 1.0;
};

/// Infinite plane { p : dot(normal, p - point) = 0 }, seen from both sides; normal is unit length.
/// Texture coordinates are (dot(tangent, p - point), dot(bitangent, p - point)) of orthonormal_basis(normal).
struct Plane {
  Vec3 point{0.0};
  Vec3 normal{0.0, 1.0, 0.0};
};

/// A rigid frame; local = transpose(axes) * (p - origin).
struct ShapeFrame {
  Vec3 origin{0.0};
  Mat3 axes{1.0};  ///< columns: the local x, y and z axis in the world; orthonormal, right-handed
};

enum class QuadricKind : std::uint8_t { ellipsoid, cylinder, cone, paraboloid, hyperboloid };

/// xx x^2 + yy y^2 + zz z^2 + z z + one = 0 in its frame, less than 0 inside, cut to a range of z.
/// scene/shapes/solid.h makes them.
struct Quadric {
  QuadricKind kind = QuadricKind::ellipsoid;
  ShapeFrame frame;
  double xx = 1.0, yy = 1.0, zz = 1.0, z = 0.0, one = -1.0;
  Aabb box{Vec3(-1.0), Vec3(1.0)};  ///< local bounds; its z range is where the surface is cut
  bool closed = true;  ///< flat caps where the cut leaves a hole (an ellipsoid is not cut); else open
};

/// Around the local z axis; 0 < minor < major.
struct Torus {
  ShapeFrame frame;
  double major = 1.0, minor = 0.25;
};

/// f(x, y, z) = 0 in its frame, inside a box; less than 0 inside the body.
struct Implicit {
  ShapeFrame frame;
  Aabb box{Vec3(-1.0), Vec3(1.0)};  ///< local
  std::string text;                 ///< of the function
  Expression function;
  bool closed = false;  ///< the box's faces close the body where f < 0; else the surface ends there
};

struct Shape {
  std::string name;
  std::variant<Sphere, Plane, Quadric, Torus, Implicit> geometry;
  std::uint32_t material = 0;
};

enum class LightType : std::uint8_t { directional, point, spot };

inline constexpr int max_shadow_samples = 65536;
inline constexpr int max_samples = 65536;  ///< of a pixel, a rough surface, or the light around a point

struct Light {
  std::string name;
  LightType type = LightType::directional;
  Vec3 position{0.0};              ///< point and spot
  Vec3 direction{0.0, -1.0, 0.0};  ///< unit, the way the light travels; directional and spot
  Vec3f intensity{1.0f};     ///< directional: irradiance at normal incidence; point, spot: radiant intensity
  double inner_angle = 0.0;  ///< spot: half-angle of full intensity
  double outer_angle = pi / 4.0;  ///< spot: half-angle where the light ends; inner < outer < pi/2
  LightExtent extent{};           ///< a point, or of size zero: a hard light
  int shadow_samples = 64;        ///< rays per point to a light with size, in [1, max_shadow_samples]
  bool operator==(const Light&) const = default;
};

/// A pinhole camera, or an orthographic one: its rays are parallel, and start in the plane through the eye.
struct Camera {
  Vec3 eye{0.0, 1.0, 5.0};
  Vec3 target{0.0};
  Vec3 up{0.0, 1.0, 0.0};
  double vertical_fov = pi / 4.0;  ///< full angle, in (0, pi); of a pinhole camera
  /// What the picture's height covers, world units; 0: a pinhole camera. Distance changes nothing's size then.
  double orthographic_height = 0.0;
  int samples_per_pixel = 1;  ///< antialiasing of the ray-traced picture; 1: the pixel's centre
  bool orthographic() const { return orthographic_height > 0.0; }
  bool operator==(const Camera&) const = default;
};

struct NamedCamera {
  std::string name;
  Camera camera;
};

struct Scene {
  std::string name;
  std::string path;    ///< as given by the user, or the built-in name
  std::string sha256;  ///< of the main file's bytes, hex
  Camera camera;
  std::vector<Light> lights;
  std::vector<Material> materials;  ///< never empty after loading
  std::vector<Texture> textures;
  std::vector<Mesh> meshes;
  std::vector<MeshInstance> instances;
  std::vector<Shape> shapes;
  Vec3f ambient{0.0f};     ///< constant ambient radiance, times diffuse
  Vec3f background{0.0f};  ///< radiance of rays that leave the scene
  std::optional<double>
      exposure;              ///< linear factor for 8-bit pictures; none: chosen from the ray-traced picture
  int max_depth = 8;         ///< recursion limit of the ray tracer
  int glossy_samples = 16;   ///< rays from each point of a rough mirror or glass, in [1, max_samples]
  int indirect_samples = 0;  ///< rays from each point to gather light reflected once, <= max_samples; 0: none
  std::vector<std::string> notes;  ///< what the loader made up or could not use, one sentence each
  /// Tells that the file draws nothing, such as one of points alone: all that is shown was made for it.
  bool is_empty_model = false;
};

}  // namespace gnomon
