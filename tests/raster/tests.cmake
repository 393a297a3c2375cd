# The rasterizer. Everything named *_gl_test.cpp makes OpenGL contexts (OSMesa, and EGL where there is one).
gnomon_test(raster_gl_test
  SOURCES raster_acne_gl_test.cpp raster_alpha_gl_test.cpp raster_bias_gl_test.cpp raster_caster_bias_gl_test.cpp raster_clip_sides_test.cpp raster_triangle_runs_test.cpp raster_constants_gl_test.cpp
          raster_context_gl_test.cpp raster_custom_shader_test.cpp raster_depth_map_gl_test.cpp raster_filter_gl_test.cpp raster_filter_scenes_gl_test.cpp raster_frame_gl_test.cpp raster_ids_gl_test.cpp raster_instances_gl_test.cpp
          raster_limits_gl_test.cpp raster_picture_gl_test.cpp raster_present_gl_test.cpp raster_settings_test.cpp raster_shape_bounds_test.cpp
  LIBS gnomon::judge gnomon::raster gnomon_raster_private)
# Pictures made in bands, by both renderers.
gnomon_test(bands_gl_test
  SOURCES bands_gl_test.cpp
  LIBS gnomon::hybrid)
# What the driver translates, by the stage that runs then: the program stands before LLVM, and so exports a function of it.
gnomon_test(raster_translation_gl_test SOURCES raster_translation_gl_test.cpp LIBS small_scenes gnomon::hybrid ${CMAKE_DL_LIBS})
set_target_properties(raster_translation_gl_test PROPERTIES ENABLE_EXPORTS ON)

# The techniques that change the map's geometry or what it stores.
gnomon_test(technique_gl_test TIMEOUT 900
  SOURCES technique_bias_gl_test.cpp technique_cascade_gl_test.cpp technique_izb_gl_test.cpp technique_twin_gl_test.cpp
  LIBS compare_support)
# Orthographic cameras, in both renderers and every technique.
gnomon_test(orthographic_gl_test SOURCES orthographic_gl_test.cpp LIBS compare_support gnomon::hybrid)
# Objects that cast no shadow, or receive none.
gnomon_test(casting_gl_test SOURCES casting_gl_test.cpp LIBS compare_support gnomon::hybrid)
