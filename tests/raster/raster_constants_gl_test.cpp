// GLSL and C++ read shaders/shared_constants.h alike, and the structs of both languages have one layout.
#include "raster/passes/light_block.h"
#include "raster/programs/gl_program.h"
#include "raster/world/world_buffers.h"
#include "shaders/shared_constants.h"
#include "tests/support/raster_fixture.h"

namespace gnomon::test {
namespace {

struct Named {
  const char* name;
  int value;
};

// Every `const int` of the header; the count below catches one that is added there and not here.
constexpr Named constants[] = {
#define GNOMON_NAMED(name) \
  { #name, shaders::name }
    GNOMON_NAMED(camera_block),
    GNOMON_NAMED(light_block),
    GNOMON_NAMED(clip_from_relative_uniform),
    GNOMON_NAMED(first_primitive_uniform),
    GNOMON_NAMED(rectangle_uniform),
    GNOMON_NAMED(shape_uniform),
    GNOMON_NAMED(face_uniform),
    GNOMON_NAMED(cull_uniform),
    GNOMON_NAMED(shape_in_frame_uniform),
    GNOMON_NAMED(viewport_uniform),
    GNOMON_NAMED(layer_uniform),
    GNOMON_NAMED(step_uniform),
    GNOMON_NAMED(blur_radius_uniform),
    GNOMON_NAMED(positions_unit),
    GNOMON_NAMED(normals_unit),
    GNOMON_NAMED(uvs_unit),
    GNOMON_NAMED(colors_unit),
    GNOMON_NAMED(triangles_unit),
    GNOMON_NAMED(triangle_materials_unit),
    GNOMON_NAMED(planes_unit),
    GNOMON_NAMED(object_positions_unit),
    GNOMON_NAMED(part_columns_uniform),
    GNOMON_NAMED(reference_uniform),
    GNOMON_NAMED(caster_bias_uniform),
    GNOMON_NAMED(parts_unit),
    GNOMON_NAMED(parts_header_texel_count),
    GNOMON_NAMED(part_texel_count),
    GNOMON_NAMED(shapes_unit),
    GNOMON_NAMED(materials_unit),
    GNOMON_NAMED(textures_unit),
    GNOMON_NAMED(shape_texel_count),
    GNOMON_NAMED(material_texel_count),
    GNOMON_NAMED(srgb_texel_count),
    GNOMON_NAMED(visibility_unit),
    GNOMON_NAMED(depth_map_unit),
    GNOMON_NAMED(texel_pages_unit),
    GNOMON_NAMED(present_unit),
    GNOMON_NAMED(moments_unit),
    GNOMON_NAMED(position_attribute),
    GNOMON_NAMED(uv_attribute),
    GNOMON_NAMED(color_attribute),
    GNOMON_NAMED(primitive_output),
    GNOMON_NAMED(solid_distance_output),
    GNOMON_NAMED(radiance_output),
    GNOMON_NAMED(record_output),
    GNOMON_NAMED(flags_output),
    GNOMON_NAMED(visibility_output),
    GNOMON_NAMED(flag_outside_map),
    GNOMON_NAMED(casts_none),
    GNOMON_NAMED(receives_none),
    GNOMON_NAMED(flag_face_shift),
    GNOMON_NAMED(shape_sphere),
    GNOMON_NAMED(shape_plane),
    GNOMON_NAMED(cull_none),
    GNOMON_NAMED(cull_front),
    GNOMON_NAMED(cull_back),
    GNOMON_NAMED(texture_srgb),
    GNOMON_NAMED(texture_nearest),
    GNOMON_NAMED(texture_repeat_s),
    GNOMON_NAMED(texture_repeat_t),
    GNOMON_NAMED(page_width),
    GNOMON_NAMED(page_height),
    GNOMON_NAMED(solid_from_frame_uniform),
    GNOMON_NAMED(external_visibility_unit),
    GNOMON_NAMED(solid_distance_unit),
    GNOMON_NAMED(shape_quadric),
    GNOMON_NAMED(shape_torus),
    GNOMON_NAMED(shape_implicit),
    GNOMON_NAMED(izb_block),
    GNOMON_NAMED(izb_vertices_unit),
    GNOMON_NAMED(izb_shapes_unit),
    GNOMON_NAMED(izb_points_unit),
    GNOMON_NAMED(izb_normals_unit),
    GNOMON_NAMED(izb_errors_unit),
    GNOMON_NAMED(izb_links_unit),
    GNOMON_NAMED(double_shape_texel_count),
    GNOMON_NAMED(izb_points_buffer),
    GNOMON_NAMED(izb_normals_buffer),
    GNOMON_NAMED(izb_errors_buffer),
    GNOMON_NAMED(izb_links_buffer),
    GNOMON_NAMED(izb_shadows_buffer),
    GNOMON_NAMED(izb_heads_image),
    GNOMON_NAMED(peel_uniform),
    GNOMON_NAMED(triangle_count_uniform),
    GNOMON_NAMED(first_layer_unit),
    GNOMON_NAMED(second_layer_unit),
#undef GNOMON_NAMED
};

std::vector<int> read_in_glsl(raster::Gl& gl) {
  std::string source =
      "#include \"shared_constants.h\"\nlayout(local_size_x = 1) in;\n"
      "layout(std430, binding = 0) buffer Out { int values[]; };\nvoid main() {\n";
  int index = 0;
  for (const Named& c : constants) source += "  values[" + std::to_string(index++) + "] = " + c.name + ";\n";
  source += "}\n";
  const auto program = raster::Program::link_compute(gl, source);
  EXPECT_TRUE(program.has_value()) << program.error().message();
  if (!program) return {};
  std::vector<int> values(std::size(constants), -1);
  raster::Buffer buffer(gl);
  buffer.write(std::span<const int>(values));
  buffer.bind(GL_SHADER_STORAGE_BUFFER, 0);
  program->use();
  gl->DispatchCompute(1, 1, 1);
  gl->MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  gl->GetNamedBufferSubData(buffer.id(), 0, static_cast<GLsizeiptr>(values.size() * sizeof(int)),
                            values.data());
  EXPECT_TRUE(gl.check("reading the constants").has_value());
  return values;
}

GLint block_size(const raster::Gl& gl, GLuint program, GLenum interface, const char* name) {
  const GLuint index = gl->GetProgramResourceIndex(program, interface, name);
  EXPECT_NE(index, GL_INVALID_INDEX) << name;
  const GLenum property = GL_BUFFER_DATA_SIZE;
  GLint size = 0;
  gl->GetProgramResourceiv(program, interface, index, 1, &property, 1, nullptr, &size);
  return size;
}

class SharedConstants : public testing::Test {
 protected:
  void SetUp() override {
    context_ = software_context();
    ASSERT_NE(context_, nullptr);
    ASSERT_TRUE(context_->make_current());
    auto gl = raster::Gl::load(*context_);
    ASSERT_TRUE(gl.has_value());
    gl_ = std::move(*gl);
  }
  std::unique_ptr<raster::Context> context_;
  std::unique_ptr<raster::Gl> gl_;
};

TEST_F(SharedConstants, HaveTheSameValuesInBothLanguages) {
  const std::vector<int> values = read_in_glsl(*gl_);
  ASSERT_EQ(values.size(), std::size(constants));
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_EQ(values[i], constants[i].value) << constants[i].name;
}

TEST_F(SharedConstants, NoneIsForgottenHere) {
  const std::string text = raster::expand_shader("shared_constants.h", {});
  std::size_t count = 0;
  for (std::size_t at = text.find("const int "); at != std::string::npos;
       at = text.find("const int ", at + 1))
    ++count;
  EXPECT_EQ(count, std::size(constants));
}

TEST_F(SharedConstants, BlocksHaveTheSizesOfTheirTwins) {
  const raster::SceneFeatures features{.textures = true, .specular = true, .smooth_normals = true};
  const raster::ShadePermutation permutation{.first_light = true, .slope_bias = true};
  const auto program = raster::link_shade_program(*gl_, permutation, features);
  ASSERT_TRUE(program.has_value()) << program.error().message();
  const GLuint id = program->id();
  EXPECT_EQ(block_size(*gl_, id, GL_UNIFORM_BLOCK, "Camera"),
            static_cast<GLint>(sizeof(raster::CameraBlock)));
  EXPECT_EQ(block_size(*gl_, id, GL_UNIFORM_BLOCK, "Light"), static_cast<GLint>(sizeof(raster::LightBlock)));
}

TEST_F(SharedConstants, AShaderErrorNamesItsFileAndLine) {
  const auto program =
      raster::Program::link_compute(*gl_, "#include \"sphere.glsl\"\nvoid main() { nonsense(); }\n");
  ASSERT_FALSE(program.has_value());
  EXPECT_EQ(program.error().kind, ErrorKind::internal);
  EXPECT_NE(program.error().reason.find("0=compute 1=sphere.glsl"), std::string::npos)
      << program.error().reason;
  EXPECT_NE(program.error().reason.find("nonsense"), std::string::npos) << program.error().reason;
}

// The search for a solid's roots is long, and its compilation longer: 50 s in the programs that shade the
// scene "shapes", before they took the impostor's answer. Nothing but the impostors may include it.
TEST(ShaderText, ShadingSearchesForNoRoot) {
  const std::string_view solids[] = {"SOLIDS", "QUADRIC", "TORUS", "TECHNIQUE hard", "DIRECTIONAL"};
  EXPECT_EQ(raster::expand_shader("shade.frag", solids).find("march_next"), std::string::npos);
  const std::string_view torus[] = {"SOLID", "TORUS"};
  EXPECT_NE(raster::expand_shader("impostor_camera.frag", torus).find("march_next"), std::string::npos);
}

}  // namespace
}  // namespace gnomon::test
