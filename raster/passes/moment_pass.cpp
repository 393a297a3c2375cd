#include "raster/passes/moment_pass.h"

#include <fmt/core.h>

#include <bit>

#include "raster/gl/fill.h"
#include "raster/technique_traits.h"
#include "shaders/shared_constants.h"

namespace gnomon::raster {

const int MomentPass::unit = shaders::moments_unit;

namespace {

constexpr int cube_mip_levels = 3;  // above level 0; each doubles the border that seamless lookups need

GLenum moment_format(Technique technique) {
  const int floats = traits_of(technique).floats_per_texel;
  return floats == 1 ? GL_R32F : floats == 2 ? GL_RG32F : GL_RGBA32F;
}

std::uint64_t bytes_per_texel(GLenum format) {
  return format == GL_R32F ? 4 : format == GL_RG32F ? 8 : 16;
}

int levels_of(int side) {
  return std::bit_width(static_cast<unsigned>(side));
}

}  // namespace

int moment_border(const FilterOptions& filter, LightType light) {
  if (light != LightType::point) return 0;
  return filter.blur_radius_texels + (filter.mipmaps ? 1 << cube_mip_levels : 1);
}

int moment_max_level(const FilterOptions& filter, LightType light, int map_size) {
  const int most = levels_of(map_size + 2 * moment_border(filter, light)) - 1;
  return light == LightType::point ? std::min(cube_mip_levels, most) : most;
}

namespace {

/// "MOMENTS_VSM" of vsm.
std::string kind_define(Technique technique) {
  std::string define = "MOMENTS_";
  for (const char c : technique_name(technique)) define += static_cast<char>(c - 'a' + 'A');
  return define;
}

std::vector<std::string> moment_defines(const MapOptions& options, const Light& light) {
  return {kind_define(options.technique), define("MOMENT_BORDER", moment_border(options.filter, light.type))};
}

TechniqueShader moment_lookup(const MapOptions& options, const Light& light) {
  TechniqueShader shader{std::string(technique_name(options.technique)), moment_defines(options, light)};
  if (!options.filter.mipmaps) return shader;
  shader.defines.emplace_back("MIPMAPS");
  shader.defines.push_back(define("MAX_LEVEL", moment_max_level(options.filter, light.type, options.size)));
  return shader;
}

std::unique_ptr<TechniquePass> make_moment_pass(Gl& gl, ProgramCache& programs) {
  return std::make_unique<MomentPass>(gl, programs);
}

constexpr std::string_view moment_stages[] = {"moments.frag", "blur.frag"};

constexpr TechniqueDrawing draw_with(Vec4 (*moments)(const FilterOptions& filter)) {
  return {.shader = moment_lookup,
          .make_pass = make_moment_pass,
          .stages = moment_stages,
          .stages_decide = true,
          .moments = moments};
}

}  // namespace

extern const TechniqueDrawing vsm_drawing = draw_with(nullptr);
extern const TechniqueDrawing esm_drawing =
    draw_with([](const FilterOptions& f) { return Vec4(f.esm_exponent, 0.0, 0.0, 0.0); });
extern const TechniqueDrawing evsm_drawing = draw_with([](const FilterOptions& f) {
  return Vec4(f.evsm_positive_exponent, f.evsm_negative_exponent, 0.0, 0.0);
});
extern const TechniqueDrawing msm_drawing =
    draw_with([](const FilterOptions& f) { return Vec4(0.0, 0.0, f.moment_bias, 0.0); });

std::vector<std::string> moment_shader(const MapOptions& options, const Light& light, const LightView& view) {
  std::vector<std::string> defines = moment_defines(options, light);
  if (light.type != LightType::directional) defines.emplace_back("PERSPECTIVE");
  if (light.type == LightType::point) defines.emplace_back("CUBE");
  if (view.reversed) defines.emplace_back("REVERSED");
  return defines;
}

Expected<void> MomentPass::prepare(const MapJob& job) {
  Gl& gl = *gl_;
  const FilterOptions& filter = job.options.filter;
  const int side = job.view.size + 2 * moment_border(filter, job.light.type);
  const int levels = filter.mipmaps ? moment_max_level(filter, job.light.type, job.view.size) + 1 : 1;
  const GLenum format = moment_format(job.options.technique);
  const ImageSize size{side, side};
  // Converted once, blurred along rows and along columns; mipmaps are not counted.
  texels_ = size.pixels() * static_cast<std::uint64_t>(job.view.face_count) *
            (filter.blur_radius_texels > 0 ? 3 : 1);
  const bool same = moments_ && moments_.size() == size && moments_.layers() == job.view.face_count &&
                    moments_.format() == format && moments_.levels() == levels;
  if (same && !faces_.empty()) return {};
  faces_.clear();
  moments_ = Texture2D();
  row_means_ = Texture2D();
  moments_ = Texture2D(gl, format, size, job.view.face_count, levels);
  moments_.set_linear_filtering();
  row_means_ = Texture2D(gl, format, size, 1);
  const std::string what = fmt::format("{0} moments of {1} x {1} texels", job.view.face_count, side);
  if (auto ok = gl.check(what); !ok) return ok;
  row_target_ = Framebuffer(gl);
  row_target_.attach(GL_COLOR_ATTACHMENT0, row_means_, 0);
  row_target_.draw_to(1);
  row_target_.clear_color();
  std::vector<Framebuffer> faces;
  for (int face = 0; face < job.view.face_count; ++face) {
    faces.emplace_back(gl);
    faces.back().attach(GL_COLOR_ATTACHMENT0, moments_, face);
    faces.back().draw_to(1);
    if (auto ok = faces.back().check_complete(); !ok) return ok;
    faces.back().clear_color();
  }
  faces_ = std::move(faces);
  return gl.check(what);
}

void MomentPass::set_state(ImageSize drawn) const {
  const Gl& gl = *gl_;
  gl->ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  gl->Viewport(0, 0, drawn.width, drawn.height);
  gl->Disable(GL_DEPTH_TEST);
  gl->Disable(GL_CULL_FACE);
  gl->Disable(GL_SCISSOR_TEST);
  gl->Disable(GL_BLEND);
}

Expected<void> MomentPass::draw(const MapJob& job) {
  const Gl& gl = *gl_;
  const auto convert = programs_->fullscreen("moments.frag", moment_shader(job.options, job.light, job.view));
  if (!convert) return fail(convert.error());
  const auto blur_program = programs_->fullscreen("blur.frag", {});
  if (!blur_program) return fail(blur_program.error());
  const ImageSize drawn = job.world.drawn_part(moments_.size());
  set_state(drawn);
  job.world.bind();
  job.map.bind_for_lookup();
  (*convert)->use();
  for (std::size_t face = 0; face < faces_.size(); ++face) {
    gl->ProgramUniform1i((*convert)->id(), shaders::layer_uniform, static_cast<int>(face));
    gl->BindFramebuffer(GL_FRAMEBUFFER, faces_[face].id());
    fill(gl, drawn);
  }
  if (job.options.filter.blur_radius_texels > 0)
    blur(**blur_program, job.options.filter.blur_radius_texels, drawn);
  if (moments_.levels() > 1) gl->GenerateTextureMipmap(moments_.id());
  return {};
}

void MomentPass::blur(const Program& program, int radius, ImageSize drawn) {
  const Gl& gl = *gl_;
  program.use();
  gl->ProgramUniform1i(program.id(), shaders::blur_radius_uniform, radius);
  for (std::size_t face = 0; face < faces_.size(); ++face) {
    moments_.bind(unit);
    gl->ProgramUniform1i(program.id(), shaders::layer_uniform, static_cast<int>(face));
    gl->ProgramUniform2i(program.id(), shaders::step_uniform, 1, 0);
    gl->BindFramebuffer(GL_FRAMEBUFFER, row_target_.id());
    fill(gl, drawn);
    row_means_.bind(unit);
    gl->ProgramUniform1i(program.id(), shaders::layer_uniform, 0);
    gl->ProgramUniform2i(program.id(), shaders::step_uniform, 0, 1);
    gl->BindFramebuffer(GL_FRAMEBUFFER, faces_[face].id());
    fill(gl, drawn);
  }
}

std::uint64_t MomentPass::bytes() const {
  std::uint64_t texels = row_means_.size().pixels();
  for (int level = 0; level < moments_.levels(); ++level) {
    const auto side = static_cast<std::uint64_t>(std::max(1, moments_.size().width >> level));
    texels += side * side * faces_.size();
  }
  return texels * bytes_per_texel(moments_.format());
}

}  // namespace gnomon::raster
