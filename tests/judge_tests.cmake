gnomon_test(judge_gl_test
  SOURCES judge_gl_test.cpp judge_parts_gl_test.cpp judge_values_gl_test.cpp judge_described_gl_test.cpp
          judge_content_gl_test.cpp judge_own_test_gl_test.cpp
  LIBS capture_support fmt::fmt nlohmann_json::nlohmann_json)
gnomon_test(judge_bad_captures_test SOURCES judge_bad_captures_test.cpp judge_several_test.cpp LIBS gnomon::studies nlohmann_json::nlohmann_json)
gnomon_test(judge_identify_gl_test
  SOURCES judge_identify_gl_test.cpp
  LIBS capture_support fmt::fmt nlohmann_json::nlohmann_json)
# The adapters on real engines, as far as they are installed.
gnomon_node_test(adapters_browser_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/adapters_browser")
gnomon_node_test(adapters_blender_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/adapters_blender")
