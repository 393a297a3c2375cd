gnomon_test(effects_test
  SOURCES effects_soft_shadow_test.cpp effects_json_test.cpp effects_glossy_test.cpp effects_glass_test.cpp
    effects_indirect_test.cpp effects_antialiasing_test.cpp effects_cost_test.cpp support/allocation_count.cpp
  LIBS raytrace_support TBB::tbb)
