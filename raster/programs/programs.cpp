#include "raster/programs/programs.h"

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>
#include <type_traits>

#include "shaders/shared_constants.h"

namespace gnomon::raster {
namespace {

/// The names that a permutation defines.
class Defines {
 public:
  Defines& add(bool wanted, std::string_view name) {
    if (wanted) names_.push_back(name);
    return *this;
  }
  operator std::span<const std::string_view>() const { return names_; }

 private:
  std::vector<std::string_view> names_;
};

template <class Typed>
Expected<Typed> typed(Expected<Program> program) {
  if (!program) return fail(program.error());
  Typed result;
  static_cast<Program&>(result) = std::move(*program);
  return result;
}

}  // namespace

std::string define(const char* name, int value) {
  return fmt::format("{} {}", name, value);
}

std::string functions_define(const FunctionTable& table, std::size_t first, std::size_t count,
                             std::initializer_list<FunctionForm> forms) {
  if (count == 0) return {};
  return "IMPLICIT_FUNCTIONS " + functions_glsl(table, first, count, std::span(forms.begin(), forms.size()));
}

SceneFeatures scene_features(const EffectPlan& plan, const World& world) {
  SceneFeatures features;
  features.textures = plan.simulates(Effect::textures);
  features.alpha_mask = plan.simulates(Effect::alpha_mask);
  features.specular = plan.simulates(Effect::specular);
  features.emission = plan.simulates(Effect::emission);
  features.vertex_colors = plan.simulates(Effect::vertex_colors);
  features.unlit = plan.simulates(Effect::unlit);
  features.single_sided = plan.simulates(Effect::single_sided);
  features.smooth_normals = world.has_normals();
  for (const Material& m : world.scene->materials) {
    features.non_casters = features.non_casters || !m.casts_shadow;
    features.non_receivers = features.non_receivers || !m.receives_shadow;
  }
  features.instances = world.keeps_instances();
  for (const Shape& shape : world.shapes) {
    features.quadrics = features.quadrics || std::holds_alternative<Quadric>(shape.geometry);
    features.tori = features.tori || std::holds_alternative<Torus>(shape.geometry);
  }
  features.functions = function_table(world);
  return features;
}

Expected<TriangleProgram> TriangleProgram::link(const Gl& gl, const Permutation& p) {
  const auto defines = Defines()
                           .add(p.primitive_ids, "PRIMITIVE_IDS")
                           .add(p.alpha_mask, "ALPHA_MASK")
                           .add(p.textures && p.alpha_mask, "TEXTURES")
                           .add(p.vertex_colors && p.alpha_mask, "VERTEX_COLORS")
                           .add(p.peel, "PEEL")
                           .add(p.reversed, "REVERSED")
                           .add(p.caster_bias, "CASTER_BIAS")
                           .add(p.perspective, "PERSPECTIVE")
                           .add(p.warp, "WARP")
                           .add(p.instances, "INSTANCES")
                           .add(p.kept, "KEPT");
  const bool has_fragments = p.primitive_ids || p.alpha_mask || p.peel || p.caster_bias;
  auto program = typed<TriangleProgram>(
      Program::link(gl, "triangle.vert", has_fragments ? "triangle.frag" : "", defines));
  if (program) program->reads_primitive_ = p.primitive_ids || p.alpha_mask;
  return program;
}

void TriangleProgram::set_clip_from_relative(const Mat4& matrix) const {
  const Mat4f rounded(matrix);
  gl()->ProgramUniformMatrix4fv(id(), shaders::clip_from_relative_uniform, 1, GL_FALSE,
                                glm::value_ptr(rounded));
}

void TriangleProgram::set_first_primitive(std::uint32_t primitive) const {
  if (reads_primitive_) gl()->ProgramUniform1ui(id(), shaders::first_primitive_uniform, primitive);
}

void TriangleProgram::set_part(const Mat4& world_from_object) const {
  std::array<Vec3, 4> columns;
  for (int c = 0; c < 4; ++c) columns[static_cast<std::size_t>(c)] = Vec3(world_from_object[c]);
  gl()->ProgramUniform3dv(id(), shaders::part_columns_uniform, 4, glm::value_ptr(columns[0]));
}

void TriangleProgram::set_reference(const Vec3& reference) const {
  gl()->ProgramUniform3dv(id(), shaders::reference_uniform, 1, glm::value_ptr(reference));
}

void TrianglePrograms::set_peel(int face, float step) const {
  for (const auto& programs : of)
    for (const TriangleProgram* program : programs)
      if (program != nullptr) program->set_peel(face, step);
}

void TriangleProgram::set_peel(int face, float step) const {
  gl()->ProgramUniform2f(id(), shaders::peel_uniform, static_cast<float>(face), step);
}

namespace {

void set_caster_uniform(const Program& program, const Gl& gl, const CasterBias& bias, int face) {
  gl->ProgramUniform4f(program.id(), shaders::caster_bias_uniform, static_cast<float>(bias.constant_world),
                       static_cast<float>(bias.slope), static_cast<float>(bias.texel_world),
                       static_cast<float>(face));
}

}  // namespace

void TrianglePrograms::set_caster_bias(const CasterBias& bias, int face) const {
  for (const auto& programs : of)
    for (const TriangleProgram* program : programs)
      if (program != nullptr) program->set_caster_bias(bias, face);
}

void TriangleProgram::set_caster_bias(const CasterBias& bias, int face) const {
  set_caster_uniform(*this, gl(), bias, face);
}

void ImpostorProgram::set_caster_bias(const CasterBias& bias, int face) const {
  set_caster_uniform(*this, gl(), bias, face);
}

void ImpostorProgram::set_peel(int face, float step) const {
  gl()->ProgramUniform2f(id(), shaders::peel_uniform, static_cast<float>(face), step);
}

ImpostorKind impostor_kind(const Shape& shape) {
  static_assert(std::variant_size_v<ShapeGeometry> == 5, "the order of ImpostorKind is that of the geometry");
  return static_cast<ImpostorKind>(shape.geometry.index());
}

Expected<ImpostorProgram> ImpostorProgram::link(const Gl& gl, const Permutation& p,
                                                const FunctionTable& functions) {
  const bool implicit = p.kind == ImpostorKind::implicit;
  const std::string text = functions_define(functions, p.function, implicit ? 1 : 0,
                                            {FunctionForm::slope, FunctionForm::gradient});
  const auto defines = Defines()
                           .add(p.kind == ImpostorKind::sphere, "SPHERE")
                           .add(p.kind >= ImpostorKind::quadric, "SOLID")
                           .add(p.kind == ImpostorKind::quadric, "QUADRIC")
                           .add(p.kind == ImpostorKind::torus, "TORUS")
                           .add(implicit, "IMPLICIT")
                           .add(implicit, text)
                           .add(p.perspective, "PERSPECTIVE")
                           .add(p.warp, "WARP")
                           .add(p.reversed, "REVERSED")
                           .add(p.peel, "PEEL")
                           .add(p.caster_bias, "CASTER_BIAS")
                           .add(p.alpha_mask, "ALPHA_MASK")
                           .add(p.textures && p.alpha_mask, "TEXTURES");
  return typed<ImpostorProgram>(
      Program::link(gl, "impostor.vert", p.camera ? "impostor_camera.frag" : "impostor_map.frag", defines));
}

void ImpostorProgram::set_shape(int index, const ClipRectangle& rectangle, const Vec4& in_frame) const {
  gl()->ProgramUniform1i(id(), shaders::shape_uniform, index);
  const Vec4f corners(Vec4(rectangle.min, rectangle.max));
  gl()->ProgramUniform4fv(id(), shaders::rectangle_uniform, 1, glm::value_ptr(corners));
  const Vec4f rounded(in_frame);
  gl()->ProgramUniform4fv(id(), shaders::shape_in_frame_uniform, 1, glm::value_ptr(rounded));
}

void ImpostorProgram::set_solid(const Mat4& solid_from_frame) const {
  const Mat4f rounded(solid_from_frame);
  gl()->ProgramUniformMatrix4fv(id(), shaders::solid_from_frame_uniform, 1, GL_FALSE,
                                glm::value_ptr(rounded));
}

void ImpostorProgram::set_face(int face, Cull cull) const {
  gl()->ProgramUniform1i(id(), shaders::face_uniform, face);
  const int code = cull == Cull::none ? shaders::cull_none
                                      : (cull == Cull::front ? shaders::cull_front : shaders::cull_back);
  gl()->ProgramUniform1i(id(), shaders::cull_uniform, code);
}

Expected<Program> link_shade_program(const Gl& gl, const ShadePermutation& p, const SceneFeatures& features) {
  const bool lit = !p.no_light;
  const std::size_t functions = features.functions.functions.size();
  const std::string text = functions_define(features.functions, 0, functions, {FunctionForm::gradient});
  const std::string technique = "TECHNIQUE " + p.technique.name;
  auto defines = Defines()
                     .add(true, technique)
                     .add(p.no_light, "NO_LIGHT")
                     .add(p.first_light, "FIRST_LIGHT")
                     .add(p.records, "RECORDS")
                     .add(lit && p.light == LightType::directional, "DIRECTIONAL")
                     .add(lit && p.light == LightType::spot, "SPOT")
                     .add(lit && p.light != LightType::directional, "PERSPECTIVE")
                     .add(lit && p.light == LightType::point, "CUBE")
                     .add(p.slope_bias, "SLOPE_BIAS")
                     .add(p.normal_offset, "NORMAL_OFFSET")
                     .add(p.receiver_plane, "RECEIVER_PLANE")
                     .add(features.textures, "TEXTURES")
                     .add(features.alpha_mask, "ALPHA_MASK")
                     .add(features.specular, "SPECULAR")
                     .add(features.emission, "EMISSION")
                     .add(features.vertex_colors, "VERTEX_COLORS")
                     .add(features.unlit, "UNLIT")
                     .add(features.non_receivers, "NON_RECEIVERS")
                     .add(features.smooth_normals, "SMOOTH_NORMALS")
                     .add(features.solids(), "SOLIDS")
                     .add(features.instances, "INSTANCES")
                     .add(features.quadrics, "QUADRIC")
                     .add(features.tori, "TORUS")
                     .add(functions > 0, "IMPLICIT")
                     .add(functions > 0, text);
  for (const std::string& define : p.technique.defines) defines.add(true, define);
  return Program::link(gl, "fullscreen.vert", "shade.frag", defines);
}

namespace {

template <class Key, class Value, class Link>
Expected<const Value*> find_or_link(std::map<Key, Value>& cache, const std::type_identity_t<Key>& key,
                                    const Link& link) {
  if (const auto found = cache.find(key); found != cache.end()) return &found->second;
  Expected<Value> made = link();
  if (!made) return fail(made.error());
  return &cache.emplace(key, std::move(*made)).first->second;
}

}  // namespace

Expected<TrianglePrograms> ProgramCache::triangles(TriangleProgram::Permutation key) {
  key.textures = features_.textures, key.vertex_colors = features_.vertex_colors;
  key.instances = features_.instances;
  TrianglePrograms programs;
  for (const bool masked : {false, true})
    for (const bool kept : {false, true}) {
      if ((masked && !features_.alpha_mask) || (kept && !features_.instances)) continue;
      key.alpha_mask = masked, key.kept = kept;
      const auto program = find_or_link(triangles_, key, [&] { return TriangleProgram::link(*gl_, key); });
      if (!program) return fail(program.error());
      programs.of[masked ? 1 : 0][kept ? 1 : 0] = *program;
    }
  return programs;
}

Expected<const ImpostorProgram*> ProgramCache::impostor(const World& world, std::size_t shape,
                                                        ImpostorProgram::Permutation key) {
  const Material& material = world.scene->materials[world.shapes[shape].material];
  key.textures = features_.textures;
  key.alpha_mask = features_.alpha_mask && material.alpha_mode == AlphaMode::mask;
  key.kind = impostor_kind(world.shapes[shape]);
  key.function = features_.functions.of_shape[shape];
  return find_or_link(impostors_, key, [&] { return ImpostorProgram::link(*gl_, key, features_.functions); });
}

Expected<const Program*> ProgramCache::fullscreen(const std::string& fragment,
                                                  const std::vector<std::string>& defines) {
  return find_or_link(fullscreens_, {fragment, defines}, [&] {
    const std::vector<std::string_view> names(defines.begin(), defines.end());
    return Program::link(*gl_, "fullscreen.vert", fragment, names);
  });
}

void ProgramCache::forget(const std::set<std::string>& files) {
  const auto forget_in = [&](auto& programs) {
    std::erase_if(programs, [&](const auto& made) { return made.second.reads(files); });
  };
  forget_in(triangles_);
  forget_in(impostors_);
  forget_in(shades_);
  forget_in(fullscreens_);
}

Expected<const Program*> ProgramCache::shade(const ShadePermutation& key) {
  return find_or_link(shades_, key, [&] { return link_shade_program(*gl_, key, features_); });
}

}  // namespace gnomon::raster
