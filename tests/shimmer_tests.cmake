gnomon_test(shimmer_gl_test
  SOURCES shimmer_gl_test.cpp shimmer_parts_test.cpp
  LIBS small_scenes gnomon::studies nlohmann_json::nlohmann_json)
gnomon_test(shimmer_program_gl_test SOURCES shimmer_program_gl_test.cpp LIBS app_process gnomon::scene nlohmann_json::nlohmann_json)
add_dependencies(shimmer_program_gl_test gnomon_program)
