gnomon_test(raytrace_test
  SOURCES raytrace_hits_test.cpp raytrace_shapes_test.cpp raytrace_verdict_test.cpp raytrace_frame_test.cpp
    raytrace_sheets_test.cpp support/raytrace_support.cpp
  LIBS gnomon::raytrace TBB::tbb)
target_include_directories(raytrace_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})

gnomon_test(raytrace_packet_test
  SOURCES raytrace_packet_test.cpp support/raytrace_support.cpp
  LIBS gnomon::raytrace TBB::tbb hwy::hwy)
target_include_directories(raytrace_packet_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})

gnomon_test(raytrace_accel_test
  SOURCES raytrace_accel_test.cpp support/raytrace_support.cpp
  LIBS gnomon::raytrace TBB::tbb)
target_include_directories(raytrace_accel_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})

# Real models, against Embree: a comparator, never behind the user's own result.
find_package(embree 3 REQUIRED)
gnomon_test(raytrace_models_test
  SOURCES raytrace_models_test.cpp support/raytrace_support.cpp
  LIBS gnomon::raytrace embree TBB::tbb)
target_include_directories(raytrace_models_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
