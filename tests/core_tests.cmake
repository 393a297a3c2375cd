gnomon_test(core_geometry_test SOURCES core_geometry_test.cpp scene_cascade_test.cpp scene_light_fit_test.cpp
  LIBS small_scenes fmt::fmt)
gnomon_test(core_freed_memory_test SOURCES core_freed_memory_test.cpp LIBS gnomon::scene)
gnomon_test(core_parallel_test SOURCES core_parallel_test.cpp LIBS gnomon::scene)
gnomon_test(core_run_program_test SOURCES core_run_program_test.cpp LIBS gnomon::scene)
gnomon_test_support(through_float SOURCES support/through_float.cpp LIBS gnomon::scene)
gnomon_test(core_rounding_test SOURCES core_rounding_test.cpp LIBS through_float)
