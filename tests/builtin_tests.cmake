gnomon_test(builtin_test
  SOURCES builtin_generate_test.cpp builtin_parameters_test.cpp builtin_teapot_test.cpp builtin_texture_test.cpp
    builtin_overlap_test.cpp builtin_scenes_test.cpp
  LIBS gnomon::scene)
