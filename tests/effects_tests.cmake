gnomon_test(effects_test
  SOURCES effects_soft_shadow_test.cpp effects_json_test.cpp support/raytrace_support.cpp
  LIBS gnomon::raytrace TBB::tbb)
target_include_directories(effects_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
