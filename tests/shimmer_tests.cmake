gnomon_test(shimmer_gl_test
  SOURCES shimmer_gl_test.cpp shimmer_parts_test.cpp support/small_scenes.cpp
  LIBS gnomon::compare nlohmann_json::nlohmann_json)
target_include_directories(shimmer_gl_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
gnomon_test(shimmer_program_gl_test SOURCES shimmer_program_gl_test.cpp app_process.cpp LIBS nlohmann_json::nlohmann_json)
add_dependencies(shimmer_program_gl_test gnomon_program)
