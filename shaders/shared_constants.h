// Constants that GLSL and C++ share: binding points, attribute and output locations, codes and flags.
// Included by both languages (GLSL's `const int` is C++'s); raster_constants_gl_test.cpp holds the two
// readings together.
#ifndef GNOMON_SHARED_CONSTANTS_H
#define GNOMON_SHARED_CONSTANTS_H
#ifdef __cplusplus
namespace gnomon::shaders {
#endif

// Uniform blocks
const int camera_block = 0;
const int light_block = 1;
const int izb_block = 2;

// Uniforms of one draw call
const int clip_from_relative_uniform = 0;
const int first_primitive_uniform = 1;
const int rectangle_uniform = 0;
const int shape_uniform = 1;
const int face_uniform = 2;
const int cull_uniform = 3;
const int shape_in_frame_uniform = 4;
const int solid_from_frame_uniform = 5;
const int viewport_uniform = 0;
const int layer_uniform = 0;
const int step_uniform = 1;
const int blur_radius_uniform = 2;
const int peel_uniform = 9;
const int triangle_count_uniform = 6;
const int part_columns_uniform = 10;  // and the next three
const int reference_uniform = 14;
const int caster_bias_uniform = 15;

// Shader storage buffers
const int izb_points_buffer = 10;
const int izb_normals_buffer = 11;
const int izb_errors_buffer = 12;
const int izb_links_buffer = 13;
const int izb_shadows_buffer = 14;

// Images
const int izb_heads_image = 0;

// Texture units
const int visibility_unit = 0;
const int depth_map_unit = 1;
const int texel_pages_unit = 2;
const int present_unit = 3;
const int moments_unit = 4;
const int external_visibility_unit = 15;
const int solid_distance_unit = 5;
const int colors_unit = 6;
const int first_layer_unit = 8;  // midpoint maps
const int second_layer_unit = 9;
const int positions_unit = 10;  // buffer textures
const int normals_unit = 11;
const int uvs_unit = 12;
const int triangles_unit = 13;
const int triangle_materials_unit = 7;
const int planes_unit = 14;
const int object_positions_unit = 16;
const int shapes_unit = 17;
const int materials_unit = 18;
const int textures_unit = 19;
const int parts_unit = 25;
const int izb_vertices_unit = 6;
const int izb_shapes_unit = 20;
const int izb_points_unit = 21;
const int izb_normals_unit = 22;
const int izb_errors_unit = 23;
const int izb_links_unit = 24;

// Texels of four numbers that one element takes of these buffer textures; the textures come after the 256 values of
// the sRGB table, a texel each.
const int shape_texel_count = 8;
const int material_texel_count = 8;
const int parts_header_texel_count = 4;
const int part_texel_count = 16;
const int double_shape_texel_count = 14;
const int srgb_texel_count = 256;

// Vertex attributes
const int position_attribute = 0;
const int uv_attribute = 1;
const int color_attribute = 2;

// Fragment outputs of the camera's pass
const int primitive_output = 0;
const int solid_distance_output = 1;  // multiples of pixel_direction(), where a solid is visible

// Fragment outputs of the shading pass
const int radiance_output = 0;
const int record_output = 1;
const int flags_output = 2;
const int visibility_output = 3;

// Bits of the flags output: lookup outside the map, and the cube face above it
const int flag_outside_map = 1;
// A material's shadow_flags
const int casts_none = 1;
const int receives_none = 2;
const int flag_face_shift = 1;

// Shapes
const int shape_sphere = 0;
const int shape_plane = 1;
const int shape_quadric = 2;
const int shape_torus = 3;
const int shape_implicit = 4;

// Which sides of a shape a depth map keeps (raster::Cull)
const int cull_none = 0;
const int cull_front = 1;
const int cull_back = 2;

// Texture flags
const int texture_srgb = 1;
const int texture_nearest = 2;
const int texture_repeat_s = 4;
const int texture_repeat_t = 8;

// Texels of all textures lie one after the other in pages (layers) of this width and height.
const int page_width = 4096;
const int page_height = 4096;

// Depth of a reversed-depth camera image where nothing is drawn, and of a light's map.
const float camera_clear_depth = 0.0f;
const float map_clear_depth = 1.0f;

#ifdef __cplusplus
}  // namespace gnomon::shaders
#endif
#endif
