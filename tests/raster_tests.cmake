# The rasterizer. Everything named *_gl_test.cpp makes OpenGL contexts (OSMesa, and EGL where there is one).
gnomon_test(raster_gl_test
  SOURCES raster_acne_gl_test.cpp raster_alpha_gl_test.cpp raster_bias_gl_test.cpp raster_caster_bias_gl_test.cpp raster_clip_sides_test.cpp raster_triangle_runs_test.cpp raster_constants_gl_test.cpp
          raster_context_gl_test.cpp raster_custom_shader_test.cpp raster_depth_map_gl_test.cpp raster_filter_gl_test.cpp raster_filter_scenes_gl_test.cpp raster_frame_gl_test.cpp raster_ids_gl_test.cpp raster_instances_gl_test.cpp
          raster_limits_gl_test.cpp raster_picture_gl_test.cpp raster_present_gl_test.cpp raster_settings_test.cpp raster_shape_bounds_test.cpp
  LIBS gnomon::raster gnomon_raster_private)
# Each technique's frame against the same draw calls by hand; run by hand, not a test.
add_executable(technique_bench bench/technique_bench.cpp bench/minimal_program.cpp)
target_link_libraries(technique_bench PRIVATE gnomon_flags gnomon_warnings gnomon::raster gnomon_raster_private fmt::fmt)
gnomon_compile_together(technique_bench)
# Pictures made in bands, by both renderers.
gnomon_test(bands_gl_test
  SOURCES bands_gl_test.cpp
  LIBS gnomon::hybrid)
# What the driver translates, by the stage that runs then: the program stands before LLVM, and so exports a function of it.
gnomon_test(raster_translation_gl_test SOURCES raster_translation_gl_test.cpp LIBS small_scenes gnomon::hybrid ${CMAKE_DL_LIBS})
set_target_properties(raster_translation_gl_test PROPERTIES ENABLE_EXPORTS ON)
