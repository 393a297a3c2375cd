// The world on the device: vertices, triangles, shapes, materials. Positions are floats relative to a
// *reference point* near the camera's eye, rounded from doubles. Every matrix is composed in double
// precision. So a scene far from the origin keeps its precision. The structs are the twins of
// shaders/world.glsl, material.glsl and camera.glsl.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "raster/gl/gl_objects.h"
#include "raster/programs/programs.h"
#include "raster/world/triangle_runs.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "scene/world.h"
#include "shaders/shared_constants.h"

namespace gnomon::raster {

// Every texture of a scene in one array texture: their texels one after the other, in pages of 4096 x 4096.
// The shaders fetch and filter by hand (shaders/texture.glsl), so textures need not share a size. Private to
// raster.

struct TexelPages {
  Texture2D pages;  ///< RGBA8UI
  /// The sRGB decoding table, then {first texel, width, height, flags} per texture: a texel each.
  Buffer table;
  BufferTexture table_texels;

  /// Error (graphics): more texels than the context's array textures hold.
  static Expected<TexelPages> upload(Gl& gl, std::span<const Texture> textures);
  void bind() const;
};

struct CameraBlock {
  Mat4f clip_from_relative;
  Vec4f eye_and_reach, right_and_tan_x, up_and_tan_y, forward, size;
  glm::uvec4 counts;
  Vec4f ambient, background;
  Vec4f half_extent;
};

struct ShapeData {
  Vec4f center_and_radius, normal, tangent, bitangent, coefficients, box_min, box_max;
  std::uint32_t kind, material, primitive, function;
};

struct MaterialData {
  Vec4f diffuse_and_alpha, specular_and_shininess, emission_and_matte, uv_matrix, uv_offset_and_cutoff,
      emission_uv_matrix, emission_uv_offset_and_unlit;
  std::uint32_t diffuse_texture, emission_texture, shadow_flags, unused;
};

static_assert(sizeof(ShapeData) == shaders::shape_texel_count * sizeof(Vec4f));
static_assert(sizeof(MaterialData) == shaders::material_texel_count * sizeof(Vec4f));

/// The reference point for a camera: its eye, or the nearest point to it of the finite scene's box.
Vec3 reference_point(const World& world, const Vec3& eye);

/// The view that is drawn. An orthographic one's eye moves along its rays to where the world begins. What it sees is the same.
/// Floats count depths from there, and so are as precise as the world is deep.
View drawn_view(const World& world, const View& view);

/// The near distance of a drawn view's reversed depth, of an orthographic one the far distance (scene/camera.h). A pinhole
/// camera cuts nothing away there (depth clamp); nearer surfaces only share one depth.
double depth_reach(const World& world, const View& drawn);

class WorldBuffers {
 public:
  enum class Drawn : std::uint8_t {
    seen,    ///< by the eye
    casters  ///< of shadows, into a map
  };
  /// Error (graphics): more data than the context's buffers hold.
  static Expected<WorldBuffers> upload(Gl& gl, const World& world, const SceneFeatures& features);

  /// Rounds everything relative to this point; does nothing when it is the present one.
  void set_reference(const Vec3& reference);
  const Vec3& reference() const { return *reference_; }
  const World& world() const { return *world_; }
  /// Binds what the shaders read, and the vertex array of flattened triangles.
  void bind() const;
  std::uint32_t most_triangles() const { return most_; }
  /// Whether a SmallDrawing lives: then passes draw into a corner of their images, of drawn_part() of their size.
  bool draws_little() const { return most_ != all_triangles; }
  ImageSize drawn_part(ImageSize of) const;
  /// Draws every triangle with the program of its kind; all get the matrix. Blocks that it surely shows nothing of are left
  /// out; depths must be clamped (GL_DEPTH_CLAMP). seen: single-sided triangles are not drawn
  /// where their back is seen (GL_CULL_FACE is off before and after); else the caller's state holds for all. A front is
  /// that of the mesh in its own space, of mirrored parts, too.
  void draw_triangles(const TrianglePrograms& programs, const Mat4& clip_from_relative,
                      const Drawn& drawn) const;

 private:
  friend class SmallDrawing;
  static constexpr std::uint32_t all_triangles = ~0u;
  WorldBuffers(const Gl& gl, const World& world);
  void upload_fixed(const SceneFeatures& features);
  void attach_textures();
  void upload_indices();
  void upload_triangle_materials();
  void upload_vertices(const SceneFeatures& features);
  void set_vertex_arrays(const SceneFeatures& features);
  void start_kind(const TriangleProgram& program, bool kept, const Mat4& clip_from_relative) const;
  void write_parts();
  template <class Put>
  void for_each_stored(const Put& put) const;

  const Gl* gl_;
  const World* world_;
  StoredMeshes meshes_;
  std::optional<Vec3> reference_;
  TriangleRuns runs_;
  VertexArray vertex_array_, kept_vertex_array_;
  Buffer positions_, normals_, uvs_, colors_, indices_, triangle_materials_, planes_, shapes_, materials_;
  Buffer parts_, object_positions_;  ///< of kept parts; empty where there are none
  BufferTexture position_texels_, normal_texels_, uv_texels_, color_texels_, triangle_texels_,
      triangle_material_texels_, plane_texels_, object_position_texels_, shape_texels_, material_texels_,
      part_texels_;
  std::optional<TexelPages> texels_;
  /// Triangles that are drawn, of opaque ones and of others, flattened and kept, each.
  std::uint32_t most_ = all_triangles;
};

/// While it lives, few triangles are drawn, and into a corner of the images. What a device compiles or sets up at the
/// first use is there then, without the time of all. Programs, targets and state are those of the whole drawing.
class SmallDrawing {
 public:
  explicit SmallDrawing(WorldBuffers& world) : world_(world) { world_.most_ = 4096; }
  ~SmallDrawing() { world_.most_ = WorldBuffers::all_triangles; }
  SmallDrawing(const SmallDrawing&) = delete;
  SmallDrawing& operator=(const SmallDrawing&) = delete;

 private:
  WorldBuffers& world_;
};

}  // namespace gnomon::raster
