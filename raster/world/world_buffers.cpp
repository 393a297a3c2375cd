#include "raster/world/world_buffers.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "raster/programs/expression_glsl.h"
#include "scene/base/parallel.h"
#include "scene/shapes/solid.h"
#include "shaders/shared_constants.h"

namespace gnomon::raster {
namespace {

/// Is the colour of what mirrors or lets light through. A rasterizer without further rays has nothing to show for that
/// share. It is drawn as a matte surface of middle grey, on which shadows can be seen, not left out, which is black.
constexpr float matte_grey = 0.5f;

/// Columns of rotation times scale.
Vec4f uv_matrix(const TextureTransform& t) {
  const double c = std::cos(t.rotation);
  const double s = std::sin(t.rotation);
  return Vec4f(glm::dvec4(c * t.scale.x, -s * t.scale.x, s * t.scale.y, c * t.scale.y));
}

MaterialData material_data(const Material& m) {
  const float local = std::max(0.0f, 1.0f - m.mirror - m.transmission);  // as in raytrace/shading/shade.h
  MaterialData out{};
  out.diffuse_and_alpha = Vec4f(local * m.diffuse, m.alpha);
  out.specular_and_shininess = Vec4f(m.unlit ? Vec3f(0.0f) : local * m.specular, m.shininess);
  out.emission_and_matte = Vec4f(m.emission, (1.0f - local) * matte_grey);
  out.uv_matrix = uv_matrix(m.texture_transform);
  out.uv_offset_and_cutoff = Vec4f(Vec2f(m.texture_transform.offset),
                                   m.alpha_mode == AlphaMode::mask ? m.alpha_cutoff : -1.0f, 0.0f);
  out.emission_uv_matrix = uv_matrix(m.emission_transform);
  out.emission_uv_offset_and_unlit = Vec4f(Vec2f(m.emission_transform.offset), m.unlit ? 1.0f : 0.0f, 0.0f);
  out.diffuse_texture = m.diffuse_texture, out.emission_texture = m.emission_texture;
  const int flags =
      (m.casts_shadow ? 0 : shaders::casts_none) | (m.receives_shadow ? 0 : shaders::receives_none);
  out.shadow_flags = static_cast<std::uint32_t>(flags);
  return out;
}

void fill_solid(const ShapeGeometry& solid, const Vec3& reference, ShapeData& out) {
  const ShapeFrame& frame = frame_of(solid);
  const Aabb box = local_box(solid);
  const auto* quadric = std::get_if<Quadric>(&solid);
  const bool uncut = quadric != nullptr && quadric->kind == QuadricKind::ellipsoid;
  out.center_and_radius = Vec4f(Vec4(frame.origin - reference, 0.0));
  out.tangent = Vec4f(Vec4(frame.axes[0], 0.0));
  out.bitangent = Vec4f(Vec4(frame.axes[1], 0.0));
  out.normal = Vec4f(Vec4(frame.axes[2], 0.0));
  out.box_min = Vec4f(Vec4(box.min, quadric != nullptr ? quadric->one : 0.0));
  out.box_max = Vec4f(Vec4(box.max, uncut ? 2.0 : is_closed(solid) ? 1.0 : 0.0));
  out.kind = shaders::shape_implicit;
  if (quadric != nullptr) {
    out.kind = shaders::shape_quadric;
    out.coefficients = Vec4f(Vec4(quadric->xx, quadric->yy, quadric->zz, quadric->z));
  } else if (const auto* torus = std::get_if<Torus>(&solid)) {
    out.kind = shaders::shape_torus;
    out.coefficients = Vec4f(Vec4(torus->major, torus->minor, 0.0, 0.0));
  }
}

ShapeData shape_data(const Shape& shape, std::uint32_t primitive, std::uint32_t function,
                     const Vec3& reference) {
  ShapeData out{};
  out.function = function;
  out.material = shape.material;
  out.primitive = primitive;
  if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
    out.kind = shaders::shape_sphere;
    out.center_and_radius = Vec4f(Vec4(sphere->center - reference, sphere->radius));
    return out;
  }
  if (is_solid(shape.geometry)) {
    fill_solid(shape.geometry, reference, out);
    return out;
  }
  const auto& plane = std::get<Plane>(shape.geometry);
  Vec3 tangent, bitangent;
  orthonormal_basis(plane.normal, tangent, bitangent);
  const Vec3 point = plane.point - reference;
  out.kind = shaders::shape_plane;
  out.center_and_radius = Vec4f(Vec4(point, 0.0));
  out.normal = Vec4f(Vec4(plane.normal, glm::dot(plane.normal, point)));
  out.tangent = Vec4f(Vec4(tangent, 0.0));
  out.bitangent = Vec4f(Vec4(bitangent, 0.0));
  return out;
}

Vec4f triangle_plane(const std::array<Vec3, 3>& corners, const Vec3& reference) {
  const auto& [a, b, c] = corners;
  const Vec3 n = glm::cross(b - a, c - a);
  const double length = glm::length(n);
  if (!(length > 0.0)) return Vec4f(0.0f);
  return Vec4f(Vec4(n, glm::dot(n, a - reference)) / length);
}

/// What the shaders read of the world are texels of buffer textures.
Expected<void> check_size(const Gl& gl, const World& world, const StoredMeshes& meshes) {
  const GLint limit = gl.integer(GL_MAX_TEXTURE_BUFFER_SIZE);
  struct Count {
    std::size_t got;
    const char* what;
  };
  for (const auto& [got, what] : {
           Count{meshes.all.triangles, "triangles"},
           Count{3 * std::size_t{meshes.all.vertices - meshes.flat.vertices}, "instanced coordinates"},
           Count{world.shapes.size() * shaders::shape_texel_count, "numbers of shapes"},
           Count{world.scene->materials.size() * shaders::material_texel_count, "numbers of materials"},
           Count{shaders::parts_header_texel_count + world.parts.size() * shaders::part_texel_count,
                 "numbers of instances"},
           Count{meshes.all.vertices, "vertices"},
       })
    if (got > static_cast<std::size_t>(limit))
      return fail(
          ErrorKind::graphics,
          fmt::format("the scene is too large for this OpenGL's GL_MAX_TEXTURE_BUFFER_SIZE (got {} {}, "
                      "allowed {})",
                      got, what, limit));
  return {};
}

/// put(i) for 0 ... count - 1, on every thread.
template <class Put>
void for_each_index(std::size_t count, const Put& put) {
  parallel_for(static_cast<std::uint32_t>(count), 8192, put);
}

}  // namespace

ImageSize WorldBuffers::drawn_part(ImageSize of) const {
  constexpr int corner = 64;  // pixels
  return draws_little() ? ImageSize{std::min(corner, of.width), std::min(corner, of.height)} : of;
}

WorldBuffers::WorldBuffers(const Gl& gl, const World& world)
    : gl_(&gl),
      world_(&world),
      meshes_(world),
      vertex_array_(gl),
      kept_vertex_array_(gl),
      positions_(gl),
      normals_(gl),
      uvs_(gl),
      colors_(gl),
      indices_(gl),
      triangle_materials_(gl),
      planes_(gl),
      shapes_(gl),
      materials_(gl),
      parts_(gl),
      object_positions_(gl),
      position_texels_(gl),
      normal_texels_(gl),
      uv_texels_(gl),
      color_texels_(gl),
      triangle_texels_(gl),
      triangle_material_texels_(gl),
      plane_texels_(gl),
      object_position_texels_(gl),
      shape_texels_(gl),
      material_texels_(gl),
      part_texels_(gl) {}

/// put(part, its mesh's place) for everything that is stored.
template <class Put>
void WorldBuffers::for_each_stored(const Put& put) const {
  for (const StoredMeshes::Stored& s : meshes_.stored) put(world_->parts[s.part], s.at);
}

Expected<WorldBuffers> WorldBuffers::upload(Gl& gl, const World& world, const SceneFeatures& features) {
  WorldBuffers out(gl, world);
  if (const auto fits = check_size(gl, world, out.meshes_); !fits) return fail(fits.error());
  out.upload_fixed(features);
  out.runs_ = TriangleRuns(world, out.meshes_, features);
  if (features.textures) {
    auto texels = TexelPages::upload(gl, world.scene->textures);
    if (!texels) return fail(texels.error());
    out.texels_ = std::move(*texels);
  }
  if (auto ok = gl.check("uploading the scene"); !ok) return fail(ok.error());
  return out;
}

void WorldBuffers::upload_fixed(const SceneFeatures& features) {
  upload_indices();
  upload_triangle_materials();
  std::vector<MaterialData> materials;
  for (const Material& m : world_->scene->materials) materials.push_back(material_data(m));
  materials_.write(std::span<const MaterialData>(materials));
  upload_vertices(features);
  set_vertex_arrays(features);
}

// Vertices of kept meshes have an array of their own, which begins with them.
void WorldBuffers::upload_indices() {
  using Corners = std::array<std::uint32_t, 3>;
  indices_.fill<Corners>(meshes_.all.triangles, [&](std::span<Corners> out) {
    for_each_stored([&](const WorldPart& part, const StoredMeshes::Place& at) {
      const std::uint32_t first = at.vertices - (part.kept() ? meshes_.flat.vertices : 0);
      for_each_index(part.triangle_count(), [&](std::uint32_t i) {
        const Corners t = part.triangle(i);
        out[at.triangles + i] = {first + t[0], first + t[1], first + t[2]};
      });
    });
  });
}

// Where all are of one material, it is written once.
void WorldBuffers::upload_triangle_materials() {
  const std::optional<std::uint32_t> every = meshes_.material_of_all(*world_);
  triangle_materials_.fill<std::uint32_t>(
      every ? 1 : meshes_.all.triangles, [&](std::span<std::uint32_t> out) {
        if (every) return void(out[0] = *every);
        for_each_stored([&](const WorldPart& part, const StoredMeshes::Place& at) {
          for_each_index(part.triangle_count(),
                         [&](std::uint32_t i) { out[at.triangles + i] = stored_material(part, i); });
        });
      });
}

void WorldBuffers::set_vertex_arrays(const SceneFeatures& features) {
  vertex_array_.set_floats(shaders::position_attribute, positions_, 3);
  if (features.instances) kept_vertex_array_.set_doubles(shaders::position_attribute, object_positions_, 3);
  for (const bool kept : {false, true}) {
    VertexArray& array = kept ? kept_vertex_array_ : vertex_array_;
    const std::uint32_t first = kept ? meshes_.flat.vertices : 0;
    array.set_indices(indices_);
    if (!features.alpha_mask || (kept && !features.instances)) continue;
    array.set_floats(shaders::uv_attribute, uvs_, 2, first);
    if (features.vertex_colors) array.set_floats(shaders::color_attribute, colors_, 4, first);
  }
}

void WorldBuffers::upload_vertices(const SceneFeatures& features) {
  const auto fill = [&]<class T>(Buffer& buffer, const auto& value) {
    buffer.fill<T>(meshes_.all.vertices, [&](std::span<T> out) {
      for_each_stored([&](const WorldPart& part, const StoredMeshes::Place& at) {
        for_each_index(part.vertex_count(), [&](std::uint32_t i) { out[at.vertices + i] = value(part, i); });
      });
    });
  };
  if (features.smooth_normals)
    fill.operator()<Vec3f>(normals_, [](const WorldPart& part, std::uint32_t i) {
      if (!part.kept()) return part.normal(i);
      return part.mesh->normals.empty() ? Vec3f(0.0f) : part.mesh->normals[i];
    });
  if (features.textures || features.alpha_mask)
    fill.operator()<Vec2f>(uvs_, [](const WorldPart& part, std::uint32_t i) {
      return part.mesh->uvs.empty() ? Vec2f(0.0f) : part.mesh->uvs[i];
    });
  if (features.vertex_colors)
    fill.operator()<Vec4f>(colors_, [](const WorldPart& part, std::uint32_t i) { return part.color(i); });
  object_positions_.fill<Vec3>(meshes_.all.vertices - meshes_.flat.vertices, [&](std::span<Vec3> out) {
    for_each_stored([&](const WorldPart& part, const StoredMeshes::Place& at) {
      if (part.kept())
        std::copy(part.mesh->positions.begin(), part.mesh->positions.end(),
                  out.begin() + (at.vertices - meshes_.flat.vertices));
    });
  });
}

void WorldBuffers::attach_textures() {
  position_texels_.attach(positions_, GL_RGB32F);
  normal_texels_.attach(normals_, GL_RGB32F);
  uv_texels_.attach(uvs_, GL_RG32F);
  color_texels_.attach(colors_, GL_RGBA32F);
  triangle_texels_.attach(indices_, GL_RGB32UI);
  triangle_material_texels_.attach(triangle_materials_, GL_R32UI);
  plane_texels_.attach(planes_, GL_RGBA32F);
  object_position_texels_.attach(object_positions_, GL_RG32UI);
  shape_texels_.attach(shapes_, GL_RGBA32UI);
  material_texels_.attach(materials_, GL_RGBA32UI);
  part_texels_.attach(parts_, GL_RGBA32UI);
}

void WorldBuffers::write_parts() {
  if (object_positions_.size() == 0) return;
  PartsHeader header;
  header.reference = Vec4(*reference_, 0.0);
  header.part_count = static_cast<std::uint32_t>(world_->parts.size());
  header.flat_vertices = meshes_.flat.vertices;
  std::vector<std::byte> bytes(sizeof header + world_->parts.size() * sizeof(PartData));
  std::memcpy(bytes.data(), &header, sizeof header);
  for (std::size_t i = 0; i < world_->parts.size(); ++i) {
    const PartData data = part_data(world_->parts[i], meshes_.of_part[i]);
    std::memcpy(bytes.data() + sizeof header + i * sizeof data, &data, sizeof data);
  }
  parts_.write(std::span<const std::byte>(bytes));
}

void WorldBuffers::set_reference(const Vec3& reference) {
  if (reference_ == reference) return;
  reference_ = reference;
  positions_.fill<Vec3f>(meshes_.flat.vertices, [&](std::span<Vec3f> out) {
    for_each_stored([&](const WorldPart& part, const StoredMeshes::Place& at) {
      if (!part.kept())
        for_each_index(part.vertex_count(),
                       [&](std::uint32_t i) { out[at.vertices + i] = Vec3f(part.position(i) - reference); });
    });
  });
  planes_.fill<Vec4f>(meshes_.flat.triangles, [&](std::span<Vec4f> out) {
    for_each_stored([&](const WorldPart& part, const StoredMeshes::Place& at) {
      if (!part.kept())
        for_each_index(part.triangle_count(), [&](std::uint32_t i) {
          out[at.triangles + i] = triangle_plane(part.corners(i), reference);
        });
    });
  });
  write_parts();
  std::vector<ShapeData> shapes;
  const FunctionTable table = function_table(*world_);
  for (std::size_t i = 0; i < world_->shapes.size(); ++i)
    shapes.push_back(shape_data(world_->shapes[i], world_->triangle_count() + static_cast<std::uint32_t>(i),
                                table.of_shape[i], reference));
  shapes_.write(std::span<const ShapeData>(shapes));
  attach_textures();  // to the memory that the buffers have now
}

void WorldBuffers::bind() const {
  (*gl_)->BindVertexArray(vertex_array_.id());
  position_texels_.bind(shaders::positions_unit);
  normal_texels_.bind(shaders::normals_unit);
  uv_texels_.bind(shaders::uvs_unit);
  color_texels_.bind(shaders::colors_unit);
  triangle_texels_.bind(shaders::triangles_unit);
  triangle_material_texels_.bind(shaders::triangle_materials_unit);
  plane_texels_.bind(shaders::planes_unit);
  if (object_positions_.size() > 0) {
    object_position_texels_.bind(shaders::object_positions_unit);
    part_texels_.bind(shaders::parts_unit);
  }
  shape_texels_.bind(shaders::shapes_unit);
  material_texels_.bind(shaders::materials_unit);
  if (texels_) texels_->bind();
}

void WorldBuffers::draw_triangles(const TrianglePrograms& programs, const Mat4& clip_from_relative,
                                  const Drawn& drawn) const {
  const bool culls = drawn == Drawn::seen;
  const std::vector<TriangleRun> runs =
      runs_.within(ClipSides(clip_from_relative, *reference_), drawn == Drawn::casters);
  if (culls) (*gl_)->CullFace(GL_BACK);
  for (const bool with_mask : {false, true}) {
    const TriangleProgram* used = nullptr;
    std::array<std::uint32_t, 2> left{most_, most_};  // of flattened triangles, and of kept instances
    for (const TriangleRun& run : runs) {
      const bool kept = run.part != no_id;
      const std::uint32_t count = std::min(run.count, left[kept ? 1 : 0]);
      if (run.masked != with_mask || count == 0) continue;
      left[kept ? 1 : 0] -= count;
      const TriangleProgram& program = *programs.of[with_mask ? 1 : 0][kept ? 1 : 0];
      if (used != &program) start_kind(program, kept, clip_from_relative), used = &program;
      program.set_first_primitive(run.first);
      if (kept) program.set_part(world_->parts[run.part].world_from_object);
      (*gl_)->FrontFace(run.inside_out ? GL_CW : GL_CCW);
      if (culls) run.single_sided ? (*gl_)->Enable(GL_CULL_FACE) : (*gl_)->Disable(GL_CULL_FACE);
      const auto offset = static_cast<std::uintptr_t>(run.at) * 3 * sizeof(std::uint32_t);
      (*gl_)->DrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * count), GL_UNSIGNED_INT,
                           reinterpret_cast<const void*>(offset));
    }
  }
  if (culls) (*gl_)->Disable(GL_CULL_FACE);
  (*gl_)->BindVertexArray(vertex_array_.id());
}

void WorldBuffers::start_kind(const TriangleProgram& program, bool kept,
                              const Mat4& clip_from_relative) const {
  program.use();
  program.set_clip_from_relative(clip_from_relative);
  if (kept) program.set_reference(*reference_);
  (*gl_)->BindVertexArray(kept ? kept_vertex_array_.id() : vertex_array_.id());
}

}  // namespace gnomon::raster
