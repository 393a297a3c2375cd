#include "raster/passes/izb_pass.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "scene/shapes/solid.h"
#include "shaders/shared_constants.h"

namespace gnomon::raster {
namespace {

/// The twin of the uniform block in shaders/izb/izb.glsl.
struct IzbBlock {
  Vec4 eye, right_and_tan_x, up_and_tan_y, forward, half_extent, light, reference, origin;
  std::array<Vec4, 6> face_right, face_up, face_forward;
  glm::ivec4 size;
};

/// The twin of DoubleShape there.
struct DoubleShape {
  Vec4 center_and_radius, normal, tangent, bitangent, coefficients, box_min, box_max;
};

static_assert(sizeof(DoubleShape) == sizeof(std::uint32_t) * 4 * shaders::double_shape_texel_count);

constexpr std::size_t point_bytes = 3 * sizeof(double), error_bytes = 3 * sizeof(float), link_bytes = 8,
                      shadow_bytes = 4;

DoubleShape double_solid(const ShapeGeometry& solid) {
  const ShapeFrame& frame = frame_of(solid);
  const Aabb box = local_box(solid);
  DoubleShape out{};
  out.center_and_radius = Vec4(frame.origin, is_convex(solid) ? 1.0 : 0.0);
  out.tangent = Vec4(frame.axes[0], 0.0);
  out.bitangent = Vec4(frame.axes[1], 0.0);
  out.normal = Vec4(frame.axes[2], 0.0);
  double constant = 0.0;
  bool uncut = false;
  if (const auto* quadric = std::get_if<Quadric>(&solid)) {
    uncut = quadric->kind == QuadricKind::ellipsoid;
    constant = quadric->one;
    out.coefficients = Vec4(quadric->xx, quadric->yy, quadric->zz, quadric->z);
  } else if (const auto* torus = std::get_if<Torus>(&solid)) {
    out.coefficients = Vec4(torus->major, torus->minor, 0.0, 0.0);
  }
  out.box_min = Vec4(box.min, constant);
  out.box_max = Vec4(box.max, uncut ? 2.0 : is_closed(solid) ? 1.0 : 0.0);
  return out;
}

DoubleShape double_shape(const Shape& shape) {
  if (is_solid(shape.geometry)) return double_solid(shape.geometry);
  DoubleShape out{};
  if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
    out.center_and_radius = Vec4(sphere->center, sphere->radius);
    return out;
  }
  const auto& plane = std::get<Plane>(shape.geometry);
  out.center_and_radius = Vec4(plane.point, 0.0);
  out.normal = Vec4(plane.normal, 0.0);
  return out;
}

constexpr std::string_view izb_stages[] = {"izb/triangle.vert", "izb/insert.frag", "izb/block.frag"};

}  // namespace

extern const TechniqueDrawing izb_drawing{
    .shader = [](const MapOptions&, const Light&) -> TechniqueShader {
      return {"izb", {}};
    },
    .make_pass = [](Gl& gl, ProgramCache& programs) -> std::unique_ptr<TechniquePass> {
      return std::make_unique<IzbPass>(gl, programs);
    },
    .stages = izb_stages,
    .stages_decide = true,
    .reads_gap = false};

IzbPass::IzbPass(Gl& gl, ProgramCache& programs)
    : gl_(&gl),
      cache_(&programs),
      block_(gl),
      vertices_(gl),
      shapes_(gl),
      points_(gl),
      normals_(gl),
      errors_(gl),
      links_(gl),
      shadows_(gl),
      vertex_bits_(gl),
      shape_bits_(gl),
      point_bits_(gl),
      normal_bits_(gl),
      error_texels_(gl),
      link_texels_(gl),
      no_target_(gl) {}

Expected<void> IzbPass::upload_world(const World& world) {
  if (world_ == &world) return {};
  if (world.keeps_instances())
    return fail(ErrorKind::graphics,
                "technique izb holds every vertex in double precision, and this scene's instances are kept "
                "(allowed: --instances flatten)");
  GLint limit = 0;
  (*gl_)->GetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &limit);
  constexpr std::size_t texels = 2;  // of three 32-bit numbers: a vertex
  const std::size_t allowed = static_cast<std::size_t>(limit) / texels;
  if (world.vertex_count() > allowed)
    return fail(
        ErrorKind::graphics,
        fmt::format("the scene is too large for technique izb on this OpenGL (got {} vertices, allowed "
                    "{}: GL_MAX_TEXTURE_BUFFER_SIZE)",
                    world.vertex_count(), allowed));
  vertices_.fill<Vec3>(world.vertex_count(), [&](std::span<Vec3> out) {
    for (const WorldPart& part : world.parts)
      for (std::uint32_t v = 0; v < part.vertex_count(); ++v) out[part.first_vertex + v] = part.position(v);
  });
  vertex_bits_.attach(vertices_, GL_RGB32UI);
  std::vector<DoubleShape> shapes;
  for (const Shape& shape : world.shapes) shapes.push_back(double_shape(shape));
  shapes_.write(std::span<const DoubleShape>(shapes));
  shape_bits_.attach(shapes_, GL_RGBA32UI);
  if (auto ok = gl_->check("uploading the scene in double precision"); !ok) return ok;
  world_ = &world;
  return {};
}

std::size_t IzbPass::most_pixels(const Gl& gl) {
  GLint64 limit = 0;
  gl->GetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &limit);
  GLint texels = 0;  // two for a pixel's point, and for its normal
  gl->GetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &texels);
  return std::min(static_cast<std::size_t>(limit) / point_bytes, static_cast<std::size_t>(texels) / 2);
}

Expected<void> IzbPass::reserve_pixels(ImageSize size) {
  if (size == size_) return {};
  const std::size_t allowed = most_pixels(*gl_);
  if (size.pixels() > allowed)
    return fail(
        ErrorKind::graphics,
        fmt::format("the picture is too large for technique izb on this OpenGL (got {} x {} = {} pixels, "
                    "allowed {} by its storage blocks and buffer textures)",
                    size.width, size.height, size.pixels(), allowed));
  points_.reserve(point_bytes * size.pixels());
  normals_.reserve(point_bytes * size.pixels());
  errors_.reserve(error_bytes * size.pixels());
  links_.reserve(link_bytes * size.pixels());
  shadows_.reserve(shadow_bytes * size.pixels());
  point_bits_.attach(points_, GL_RGB32UI);
  normal_bits_.attach(normals_, GL_RGB32UI);
  error_texels_.attach(errors_, GL_RGB32F);
  link_texels_.attach(links_, GL_RG32UI);
  if (auto ok = gl_->check("the lists of technique izb"); !ok) return ok;
  size_ = size;
  return {};
}

Expected<void> IzbPass::prepare(const MapJob& job) {
  if (auto ok = upload_world(job.world.world()); !ok) return ok;
  if (auto ok = reserve_pixels(job.camera_pass->size()); !ok) return ok;
  const ImageSize size{job.view.size, job.view.size};
  if (!heads_ || heads_.size() != size || heads_.layers() != job.view.face_count) {
    heads_ = Texture2D();
    heads_ = Texture2D(*gl_, GL_R32UI, size, job.view.face_count);
    if (auto ok = gl_->check("the grid of technique izb"); !ok) return ok;
  }
  write_block(job);
  return {};
}

void IzbPass::write_block(const MapJob& job) {
  const View camera = drawn_view(job.world.world(), *job.camera);  // from which solids' distances count
  const LightView& view = job.view;
  IzbBlock block{};
  block.eye = Vec4(camera.eye, 0.0);
  block.half_extent = Vec4(camera.half_x, camera.half_y, 0.0, 0.0);
  block.right_and_tan_x = Vec4(camera.right, camera.tan_half_x);
  block.up_and_tan_y = Vec4(camera.up, camera.tan_half_y);
  block.forward = Vec4(camera.forward, 0.0);
  block.light =
      Vec4(job.light.type == LightType::directional ? job.light.direction : job.light.position, 0.0);
  block.reference = Vec4(job.world.reference(), 0.0);
  block.origin = Vec4(face_origin(view, view.face(0)), 0.0);
  for (int i = 0; i < view.face_count; ++i) {
    const LightFace& face = view.face(i);
    const auto k = static_cast<std::size_t>(i);
    block.face_right[k] = Vec4(face.right, face.half_extent.x);
    block.face_up[k] = Vec4(face.up, face.half_extent.y);
    block.face_forward[k] = Vec4(face.forward, 0.0);
  }
  block.size = glm::ivec4(camera.size.width, camera.size.height, view.size,
                          static_cast<int>(job.world.world().shapes.size()));
  block_.write_one(block);
}

IzbPass::Stage IzbPass::stage_of(const Shape& shape) {
  switch (impostor_kind(shape)) {
    case ImpostorKind::quadric:
      return Stage::quadrics;
    case ImpostorKind::torus:
      return Stage::tori;
    case ImpostorKind::implicit:
      return Stage::implicits;
    case ImpostorKind::sphere:
    case ImpostorKind::plane:
      break;
  }
  return Stage::spheres;
}

Expected<const Program*> IzbPass::program(Stage stage, LightType light, std::uint32_t function) {
  const auto key = std::tuple(stage, light, function);
  if (const auto found = programs_.find(key); found != programs_.end()) return &found->second;
  const SceneFeatures& features = cache_->features();
  const bool insert = stage == Stage::insert;
  const std::size_t functions = features.functions.functions.size();
  // A receiver may be any solid, a blocker is of one kind; only the latter is searched for along rays.
  const std::string text =
      insert ? functions_define(features.functions, 0, functions, {FunctionForm::gradient64})
             : functions_define(features.functions, function, stage == Stage::implicits ? 1 : 0,
                                {FunctionForm::slope, FunctionForm::gradient64});
  std::vector<std::string_view> defines;
  const auto add = [&](bool wanted, std::string_view name) {
    if (wanted) defines.push_back(name);
  };
  add(light == LightType::directional, "DIRECTIONAL");
  add(light != LightType::directional, "PERSPECTIVE");
  add(light == LightType::point, "CUBE");
  add(stage == Stage::spheres, "SPHERE");
  add(insert && features.solids(), "SOLIDS");
  add(stage >= Stage::quadrics, "SOLID");
  add(stage == Stage::quadrics || (insert && features.quadrics), "QUADRIC");
  add(stage == Stage::tori || (insert && features.tori), "TORUS");
  add(!text.empty(), "IMPLICIT");
  add(!text.empty(), text);
  add(features.alpha_mask, "ALPHA_MASK");
  add(features.non_casters, "NON_CASTERS");
  add(features.alpha_mask && features.textures, "TEXTURES");
  add(features.alpha_mask && features.vertex_colors, "VERTEX_COLORS");
  const std::string_view vertex = insert                      ? "fullscreen.vert"
                                  : stage == Stage::triangles ? "izb/triangle.vert"
                                                              : "impostor.vert";
  auto made = Program::link(*gl_, vertex, insert ? "izb/insert.frag" : "izb/block.frag", defines);
  if (!made) return fail(made.error());
  return &programs_.emplace(key, std::move(*made)).first->second;
}

void IzbPass::bind_all() const {
  block_.bind(GL_UNIFORM_BUFFER, shaders::izb_block);
  vertex_bits_.bind(shaders::izb_vertices_unit);
  shape_bits_.bind(shaders::izb_shapes_unit);
  point_bits_.bind(shaders::izb_points_unit);
  normal_bits_.bind(shaders::izb_normals_unit);
  error_texels_.bind(shaders::izb_errors_unit);
  link_texels_.bind(shaders::izb_links_unit);
  points_.bind(GL_SHADER_STORAGE_BUFFER, shaders::izb_points_buffer);
  normals_.bind(GL_SHADER_STORAGE_BUFFER, shaders::izb_normals_buffer);
  errors_.bind(GL_SHADER_STORAGE_BUFFER, shaders::izb_errors_buffer);
  links_.bind(GL_SHADER_STORAGE_BUFFER, shaders::izb_links_buffer);
  shadows_.bind(GL_SHADER_STORAGE_BUFFER, shaders::izb_shadows_buffer);
  (*gl_)->BindImageTexture(shaders::izb_heads_image, heads_.id(), 0, GL_TRUE, 0, GL_READ_WRITE, GL_R32UI);
}

Expected<void> IzbPass::draw(const MapJob& job) {
  const Gl& gl = *gl_;
  job.world.bind();
  bind_all();
  gl->BindFramebuffer(GL_FRAMEBUFFER, no_target_.id());
  gl->Disable(GL_DEPTH_TEST);
  gl->Disable(GL_CULL_FACE);
  gl->Disable(GL_BLEND);
  gl->Disable(GL_SCISSOR_TEST);
  if (auto ok = insert(job); !ok) return ok;
  if (auto ok = block(job); !ok) return ok;
  gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  return {};
}

Expected<void> IzbPass::insert(const MapJob& job) {
  const Gl& gl = *gl_;
  const auto insert = program(Stage::insert, job.light.type);
  if (!insert) return fail(insert.error());
  const GLuint nothing = 0;
  gl->ClearTexImage(heads_.id(), 0, GL_RED_INTEGER, GL_UNSIGNED_INT, &nothing);
  const ImageSize size = job.camera_pass->size();
  gl->NamedFramebufferParameteri(no_target_.id(), GL_FRAMEBUFFER_DEFAULT_WIDTH, size.width);
  gl->NamedFramebufferParameteri(no_target_.id(), GL_FRAMEBUFFER_DEFAULT_HEIGHT, size.height);
  gl->ClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
  gl->Viewport(0, 0, size.width, size.height);
  job.camera_pass->bind_visibility();
  (*insert)->use();
  gl->ProgramUniform1ui((*insert)->id(), shaders::triangle_count_uniform, job.world.world().triangle_count());
  gl->DrawArrays(GL_TRIANGLES, 0, 3);
  gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                    GL_TEXTURE_FETCH_BARRIER_BIT);
  return {};
}

Expected<void> IzbPass::block(const MapJob& job) {
  const Gl& gl = *gl_;
  const std::uint32_t count = std::min(job.world.world().triangle_count(), job.world.most_triangles());
  const auto triangles = program(Stage::triangles, job.light.type);
  if (!triangles) return fail(triangles.error());
  gl->NamedFramebufferParameteri(no_target_.id(), GL_FRAMEBUFFER_DEFAULT_WIDTH, job.view.size);
  gl->NamedFramebufferParameteri(no_target_.id(), GL_FRAMEBUFFER_DEFAULT_HEIGHT, job.view.size);
  gl->ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  gl->Viewport(0, 0, job.view.size, job.view.size);
  for (int face = 0; face < job.view.face_count; ++face) {
    (*triangles)->use();
    gl->ProgramUniform1i((*triangles)->id(), shaders::face_uniform, face);
    gl->DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(6 * count));
    if (auto ok = block_shapes(job, face); !ok) return ok;
  }
  return {};
}

// Planes are tested with the receivers, which need no list for them.
Expected<void> IzbPass::block_shapes(const MapJob& job, int face) {
  const Gl& gl = *gl_;
  const World& world = job.world.world();
  const Projection projection = face_projection(job.view, face);
  for (std::size_t i = 0; i < world.shapes.size(); ++i) {
    const Shape& shape = world.shapes[i];
    if (std::holds_alternative<Plane>(shape.geometry)) continue;
    if (!world.scene->materials[shape.material].casts_shadow) continue;
    const auto bounds = shape_bounds(projection, shape);
    if (!bounds) continue;
    const auto found = program(stage_of(shape), job.light.type, cache_->features().functions.of_shape[i]);
    if (!found) return fail(found.error());
    (*found)->use();
    const GLuint id = (*found)->id();
    const Vec4f rectangle(Vec4(bounds->min - projection.pixel, bounds->max + projection.pixel));
    gl->ProgramUniform4f(id, shaders::rectangle_uniform, rectangle.x, rectangle.y, rectangle.z, rectangle.w);
    gl->ProgramUniform1i(id, shaders::shape_uniform, static_cast<int>(i));
    gl->ProgramUniform1i(id, shaders::face_uniform, face);
    gl->DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }
  return {};
}

void IzbPass::bind_for_lookup() const {
  shadows_.bind(GL_SHADER_STORAGE_BUFFER, shaders::izb_shadows_buffer);
}

std::uint64_t IzbPass::texels() const {
  return heads_.size().pixels() * static_cast<std::uint64_t>(heads_.layers());
}

std::uint64_t IzbPass::bytes() const {
  return 4 * texels() + (2 * point_bytes + error_bytes + link_bytes + shadow_bytes) * size_.pixels();
}

}  // namespace gnomon::raster
