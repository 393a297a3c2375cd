gnomon_test(core_geometry_test SOURCES core_geometry_test.cpp core_paging_test.cpp scene_cascade_test.cpp support/small_scenes.cpp LIBS gnomon::scene fmt::fmt)
target_include_directories(core_geometry_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
