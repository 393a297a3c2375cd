gnomon_test_support(raytrace_support SOURCES ../support/raytrace_support.cpp LIBS gnomon::small_world)

gnomon_test(raytrace_test
  SOURCES raytrace_hits_test.cpp raytrace_shapes_test.cpp raytrace_visibility_test.cpp raytrace_frame_test.cpp
    raytrace_edge_on_test.cpp raytrace_apex_test.cpp raytrace_methods_test.cpp raytrace_sheets_test.cpp raytrace_builder_test.cpp raytrace_leaf_primitives_test.cpp
  LIBS raytrace_support TBB::tbb)

gnomon_test(raytrace_solids_test
  SOURCES raytrace_solids_test.cpp raytrace_solid_sheets_test.cpp raytrace_twins_test.cpp
  LIBS raytrace_support TBB::tbb)

gnomon_test(raytrace_packet_test
  SOURCES raytrace_packet_test.cpp raytrace_packet_masks_test.cpp raytrace_packet_parts_test.cpp raytrace_edge_setup_test.cpp
  LIBS raytrace_support TBB::tbb hwy::hwy)

gnomon_test(raytrace_wide_test
  SOURCES raytrace_wide_test.cpp raytrace_wide_tree_test.cpp raytrace_wide_interval_test.cpp
    raytrace_light_shaft_test.cpp
  LIBS raytrace_support TBB::tbb hwy::hwy)

gnomon_test(raytrace_cells_test
  SOURCES raytrace_cells_test.cpp
  LIBS raytrace_support TBB::tbb hwy::hwy)

gnomon_test(raytrace_accel_test
  SOURCES raytrace_accel_test.cpp raytrace_sides_test.cpp
  LIBS raytrace_support TBB::tbb)

gnomon_test(raytrace_two_level_test
  SOURCES raytrace_two_level_test.cpp raytrace_instances_test.cpp
  LIBS raytrace_support TBB::tbb)

# Real models, against Embree: a comparator, never behind the user's own result.
gnomon_test(raytrace_models_test
  SOURCES raytrace_models_test.cpp
  LIBS raytrace_support embree TBB::tbb)

# It replaces operator new and delete: where a test's own code sees both, GCC takes its free() for a mismatch.
set_source_files_properties("${CMAKE_CURRENT_SOURCE_DIR}/support/allocation_count.cpp" PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
gnomon_test(effects_test
  SOURCES effects_soft_shadow_test.cpp effects_json_test.cpp effects_glossy_test.cpp effects_glass_test.cpp
    effects_indirect_test.cpp effects_antialiasing_test.cpp effects_cost_test.cpp effects_terminator_test.cpp ../support/allocation_count.cpp
  LIBS raytrace_support TBB::tbb)
