# It replaces operator new and delete: where a test's own code sees both, GCC takes its free() for a mismatch.
set_source_files_properties(support/allocation_count.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
gnomon_test(effects_test
  SOURCES effects_soft_shadow_test.cpp effects_json_test.cpp effects_glossy_test.cpp effects_glass_test.cpp
    effects_indirect_test.cpp effects_antialiasing_test.cpp effects_cost_test.cpp effects_terminator_test.cpp support/allocation_count.cpp
  LIBS raytrace_support TBB::tbb)
