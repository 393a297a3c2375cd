#include "raster/world_buffers.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <array>

#include "raster/expression_glsl.h"
#include "scene/solid.h"
#include "shaders/shared_constants.h"

namespace gnomon::raster {
namespace {

/// Of what mirrors or lets light through. A rasterizer without further rays has nothing to show for that share:
/// it is drawn as a matte surface of middle grey, on which shadows can be seen, not left out, which is black.
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
  out.specular_and_shininess = Vec4f(local * m.specular, m.shininess);
  out.emission_and_matte = Vec4f(m.emission, (1.0f - local) * matte_grey);
  out.uv_matrix = uv_matrix(m.texture_transform);
  out.uv_offset_and_cutoff = Vec4f(Vec2f(m.texture_transform.offset),
                                   m.alpha_mode == AlphaMode::mask ? m.alpha_cutoff : -1.0f, 0.0f);
  out.emission_uv_matrix = uv_matrix(m.emission_transform);
  out.emission_uv_offset_and_unlit = Vec4f(Vec2f(m.emission_transform.offset), m.unlit ? 1.0f : 0.0f, 0.0f);
  out.diffuse_texture = m.diffuse_texture, out.emission_texture = m.emission_texture;
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

Vec4f triangle_plane(const World& world, std::uint32_t triangle, const Vec3& reference) {
  const auto [a, b, c] = world.corners(triangle);
  const Vec3 n = glm::cross(b - a, c - a);
  const double length = glm::length(n);
  if (!(length > 0.0)) return Vec4f(0.0f);
  return Vec4f(Vec4(n, glm::dot(n, a - reference)) / length);
}

/// Triangles and vertices are texels of buffer textures.
Expected<void> check_size(const Gl& gl, const World& world) {
  GLint limit = 0;
  gl->GetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &limit);
  const auto check = [&](std::size_t got, const char* what) -> Expected<void> {
    if (got <= static_cast<std::size_t>(limit)) return {};
    return fail(ErrorKind::graphics,
                fmt::format("the scene is too large for this OpenGL's GL_MAX_TEXTURE_BUFFER_SIZE (got {} {}, "
                            "allowed {})",
                            got, what, limit));
  };
  if (const auto fits = check(world.triangles.size(), "triangles"); !fits) return fits;
  return check(world.positions.size(), "vertices");
}

/// put(i) for 0 ... count - 1, on every thread.
template <class Put>
void for_each_index(std::size_t count, const Put& put) {
  constexpr std::size_t at_a_time = 8192;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, at_a_time), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) put(i);
  });
}

}  // namespace

Vec3 reference_point(const World& world, const Vec3& eye) {
  if (world.finite_bounds.empty()) return eye;
  return glm::clamp(eye, world.finite_bounds.min, world.finite_bounds.max);
}

double near_distance(const World& world, const Vec3& eye) {
  double reach = world.finite_bounds.empty()
                     ? 0.0
                     : world.finite_bounds.diagonal() + glm::length(world.finite_bounds.center() - eye);
  for (const Shape& shape : world.shapes) {
    if (const auto* plane = std::get_if<Plane>(&shape.geometry))
      reach = std::max(reach, std::abs(glm::dot(plane->normal, plane->point - eye)));
  }
  return reach > 0.0 ? 1e-4 * reach : 1.0;
}

WorldBuffers::WorldBuffers(const Gl& gl, const World& world)
    : gl_(&gl),
      world_(&world),
      vertex_array_(gl),
      positions_(gl),
      normals_(gl),
      uvs_(gl),
      colors_(gl),
      indices_(gl),
      triangles_(gl),
      planes_(gl),
      shapes_(gl),
      materials_(gl),
      position_texels_(gl),
      normal_texels_(gl),
      uv_texels_(gl),
      color_texels_(gl),
      triangle_texels_(gl),
      plane_texels_(gl) {}

Expected<WorldBuffers> WorldBuffers::upload(Gl& gl, const World& world, const SceneFeatures& features) {
  if (const auto fits = check_size(gl, world); !fits) return fail(fits.error());
  WorldBuffers out(gl, world);
  out.upload_fixed(features);
  out.make_runs(features);
  if (features.textures) {
    auto texels = TexelPages::upload(gl, world.scene->textures);
    if (!texels) return fail(texels.error());
    out.texels_ = std::move(*texels);
  }
  if (auto ok = gl.check("uploading the scene"); !ok) return fail(ok.error());
  return out;
}

void WorldBuffers::upload_fixed(const SceneFeatures& features) {
  const World& world = *world_;
  using Corners = std::array<std::uint32_t, 3>;
  indices_.write(std::span<const Corners>(world.triangles));
  triangles_.fill<glm::uvec4>(world.triangles.size(), [&](std::span<glm::uvec4> out) {
    for_each_index(out.size(), [&](std::size_t i) {
      const Corners& t = world.triangles[i];
      out[i] = {t[0], t[1], t[2], world.triangle_material[i]};
    });
  });
  std::vector<MaterialData> materials;
  for (const Material& m : world.scene->materials) materials.push_back(material_data(m));
  materials_.write(std::span<const MaterialData>(materials));
  if (features.smooth_normals) normals_.write(std::span<const Vec3f>(world.normals));
  if (features.textures || features.alpha_mask) uvs_.write(std::span<const Vec2f>(world.uvs));
  if (features.vertex_colors) colors_.write(std::span<const Vec4f>(world.colors));
  vertex_array_.set_indices(indices_);
  vertex_array_.set_floats(shaders::position_attribute, positions_, 3);
  if (!features.alpha_mask) return;
  vertex_array_.set_floats(shaders::uv_attribute, uvs_, 2);
  if (features.vertex_colors) vertex_array_.set_floats(shaders::color_attribute, colors_, 4);
}

void WorldBuffers::attach_textures() {
  position_texels_.attach(positions_, GL_RGB32F);
  normal_texels_.attach(normals_, GL_RGB32F);
  uv_texels_.attach(uvs_, GL_RG32F);
  color_texels_.attach(colors_, GL_RGBA32F);
  triangle_texels_.attach(triangles_, GL_RGBA32UI);
  plane_texels_.attach(planes_, GL_RGBA32F);
}

void WorldBuffers::make_runs(const SceneFeatures& features) {
  const auto& materials = world_->scene->materials;
  for (std::uint32_t i = 0; i < world_->triangle_count(); ++i) {
    const Material& material = materials[world_->triangle_material[i]];
    const bool masked = features.alpha_mask && material.alpha_mode == AlphaMode::mask;
    const bool single = features.single_sided && !shows_back(material);
    if (runs_.empty() || runs_.back().masked != masked || runs_.back().single_sided != single)
      runs_.push_back({i, 0, masked, single});
    ++runs_.back().count;
  }
}

void WorldBuffers::set_reference(const Vec3& reference) {
  if (reference_ == reference) return;
  reference_ = reference;
  positions_.fill<Vec3f>(world_->positions.size(), [&](std::span<Vec3f> out) {
    for_each_index(out.size(), [&](std::size_t i) { out[i] = Vec3f(world_->positions[i] - reference); });
  });
  planes_.fill<Vec4f>(world_->triangles.size(), [&](std::span<Vec4f> out) {
    for_each_index(out.size(), [&](std::size_t i) {
      out[i] = triangle_plane(*world_, static_cast<std::uint32_t>(i), reference);
    });
  });
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
  plane_texels_.bind(shaders::planes_unit);
  shapes_.bind(GL_SHADER_STORAGE_BUFFER, shaders::shapes_buffer);
  materials_.bind(GL_SHADER_STORAGE_BUFFER, shaders::materials_buffer);
  if (texels_) texels_->bind();
}

void WorldBuffers::draw_triangles(const TriangleProgram& opaque, const TriangleProgram& masked,
                                  const Mat4& clip_from_relative, bool culls) const {
  if (culls) (*gl_)->CullFace(GL_BACK), (*gl_)->FrontFace(GL_CCW);
  for (const bool with_mask : {false, true}) {
    const TriangleProgram& program = with_mask ? masked : opaque;
    bool ready = false;
    for (const TriangleRun& run : runs_) {
      if (run.masked != with_mask) continue;
      if (!ready) program.use(), program.set_clip_from_relative(clip_from_relative), ready = true;
      program.set_first_primitive(run.first);
      if (culls) run.single_sided ? (*gl_)->Enable(GL_CULL_FACE) : (*gl_)->Disable(GL_CULL_FACE);
      const auto offset = static_cast<std::uintptr_t>(run.first) * 3 * sizeof(std::uint32_t);
      (*gl_)->DrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * run.count), GL_UNSIGNED_INT,
                           reinterpret_cast<const void*>(offset));
    }
  }
  if (culls) (*gl_)->Disable(GL_CULL_FACE);
}

}  // namespace gnomon::raster
