#include "raster/izb_pass.h"

#include <fmt/format.h>

#include <array>

#include "scene/solid.h"
#include "shaders/shared_constants.h"

namespace gnomon::raster {
namespace {

/// The twin of the uniform block in shaders/izb/izb.glsl.
struct IzbBlock {
  Vec4 eye, right_and_tan_x, up_and_tan_y, forward, light, reference, origin;
  std::array<Vec4, 6> face_right, face_up, face_forward;
  glm::ivec4 size;
};

struct DoubleShape {
  Vec4 center_and_radius, normal;
};

constexpr std::size_t point_bytes = 3 * sizeof(double), error_bytes = 3 * sizeof(float), link_bytes = 8,
                      shadow_bytes = 4;

DoubleShape double_shape(const Shape& shape) {
  if (const auto* sphere = std::get_if<Sphere>(&shape.geometry))
    return {Vec4(sphere->center, sphere->radius), Vec4(0.0)};
  const auto& plane = std::get<Plane>(shape.geometry);
  return {Vec4(plane.point, 0.0), Vec4(plane.normal, 0.0)};
}

}  // namespace

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
      no_target_(gl) {}

Expected<void> IzbPass::upload_world(const World& world) {
  if (world_ == &world) return {};
  vertices_.write(std::span<const Vec3>(world.positions));
  std::vector<DoubleShape> shapes;
  for (const Shape& shape : world.shapes) {
    if (is_solid(shape.geometry))
      return fail(
          ErrorKind::usage,
          fmt::format(
              "technique izb tests triangles, spheres and planes exactly (got shape '{}'); hybrid and "
              "raytrace are exact for every shape",
              shape.name));
    shapes.push_back(double_shape(shape));
  }
  shapes_.write(std::span<const DoubleShape>(shapes));
  if (auto ok = gl_->check("uploading the scene in double precision"); !ok) return ok;
  world_ = &world;
  return {};
}

Expected<void> IzbPass::reserve_pixels(ImageSize size) {
  if (size == size_) return {};
  GLint64 limit = 0;
  (*gl_)->GetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &limit);
  const std::size_t allowed = static_cast<std::size_t>(limit) / point_bytes;
  if (size.pixels() > allowed)
    return fail(
        ErrorKind::graphics,
        fmt::format("the picture is too large for technique izb on this OpenGL (got {} x {} = {} pixels, "
                    "allowed {}: GL_MAX_SHADER_STORAGE_BLOCK_SIZE)",
                    size.width, size.height, size.pixels(), allowed));
  points_.reserve(point_bytes * size.pixels());
  normals_.reserve(point_bytes * size.pixels());
  errors_.reserve(error_bytes * size.pixels());
  links_.reserve(link_bytes * size.pixels());
  shadows_.reserve(shadow_bytes * size.pixels());
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
  const View& camera = *job.camera;
  const LightView& view = job.view;
  IzbBlock block{};
  block.eye = Vec4(camera.eye, 0.0);
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

Expected<const Program*> IzbPass::program(Stage stage, LightType light) {
  const auto key = std::pair(stage, light);
  if (const auto found = programs_.find(key); found != programs_.end()) return &found->second;
  std::vector<std::string_view> defines;
  defines.emplace_back(light == LightType::directional ? "DIRECTIONAL" : "PERSPECTIVE");
  if (light == LightType::point) defines.emplace_back("CUBE");
  if (stage == Stage::spheres) defines.emplace_back("SPHERE");
  if (cache_->features().alpha_mask) defines.emplace_back("ALPHA_MASK");
  if (cache_->features().alpha_mask && cache_->features().textures) defines.emplace_back("TEXTURES");
  const std::string_view vertex = stage == Stage::insert      ? "fullscreen.vert"
                                  : stage == Stage::triangles ? "izb/triangle.vert"
                                                              : "impostor.vert";
  auto made =
      Program::link(*gl_, vertex, stage == Stage::insert ? "izb/insert.frag" : "izb/block.frag", defines);
  if (!made) return fail(made.error());
  return &programs_.emplace(key, std::move(*made)).first->second;
}

void IzbPass::bind_all() const {
  block_.bind(GL_UNIFORM_BUFFER, shaders::izb_block);
  vertices_.bind(GL_SHADER_STORAGE_BUFFER, shaders::izb_vertices_buffer);
  shapes_.bind(GL_SHADER_STORAGE_BUFFER, shaders::izb_shapes_buffer);
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
  const ImageSize size = job.camera->size;
  gl->NamedFramebufferParameteri(no_target_.id(), GL_FRAMEBUFFER_DEFAULT_WIDTH, size.width);
  gl->NamedFramebufferParameteri(no_target_.id(), GL_FRAMEBUFFER_DEFAULT_HEIGHT, size.height);
  gl->ClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
  gl->Viewport(0, 0, size.width, size.height);
  job.camera_pass->bind_visibility();
  (*insert)->use();
  gl->ProgramUniform1ui((*insert)->id(), shaders::triangle_count_uniform, job.world.world().triangle_count());
  gl->DrawArrays(GL_TRIANGLES, 0, 3);
  gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  return {};
}

Expected<void> IzbPass::block(const MapJob& job) {
  const Gl& gl = *gl_;
  const World& world = job.world.world();
  const auto triangles = program(Stage::triangles, job.light.type);
  if (!triangles) return fail(triangles.error());
  gl->NamedFramebufferParameteri(no_target_.id(), GL_FRAMEBUFFER_DEFAULT_WIDTH, job.view.size);
  gl->NamedFramebufferParameteri(no_target_.id(), GL_FRAMEBUFFER_DEFAULT_HEIGHT, job.view.size);
  gl->ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  gl->Viewport(0, 0, job.view.size, job.view.size);
  for (int face = 0; face < job.view.face_count; ++face) {
    (*triangles)->use();
    gl->ProgramUniform1i((*triangles)->id(), shaders::face_uniform, face);
    gl->DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(6 * world.triangle_count()));
    const Projection projection = face_projection(job.view, face);
    for (std::size_t i = 0; i < world.shapes.size(); ++i) {
      if (!std::holds_alternative<Sphere>(world.shapes[i].geometry)) continue;  // planes: with the receivers
      const auto bounds = shape_bounds(projection, world.shapes[i]);
      if (!bounds) continue;
      const auto spheres = program(Stage::spheres, job.light.type);
      if (!spheres) return fail(spheres.error());
      (*spheres)->use();
      const Vec4f rectangle(Vec4(bounds->min - projection.pixel, bounds->max + projection.pixel));
      gl->ProgramUniform4f((*spheres)->id(), shaders::rectangle_uniform, rectangle.x, rectangle.y,
                           rectangle.z, rectangle.w);
      gl->ProgramUniform1i((*spheres)->id(), shaders::shape_uniform, static_cast<int>(i));
      gl->ProgramUniform1i((*spheres)->id(), shaders::face_uniform, face);
      gl->DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    }
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
