# What a comparison is written as.
gnomon_test(outputs_test
  SOURCES outputs_text_test.cpp outputs_time_difference_test.cpp outputs_verdict_test.cpp outputs_json_test.cpp outputs_figures_test.cpp outputs_pictures_test.cpp outputs_flip_test.cpp
  LIBS gnomon::studies nlohmann_json::nlohmann_json OpenImageIO::OpenImageIO TBB::tbb)

# The report page in a real browser: sample pages are written first, then looked at.
add_executable(outputs_sample "${CMAKE_CURRENT_LIST_DIR}/outputs_sample_main.cpp")
target_link_libraries(outputs_sample PRIVATE gnomon_flags gnomon_warnings gnomon::studies nlohmann_json::nlohmann_json)

# A test in JavaScript; skipped visibly where node, or what the test needs besides, is not there.
find_program(GNOMON_NODE node)
function(gnomon_node_test name)
  if(GNOMON_NODE)
    add_test(NAME ${name} COMMAND ${GNOMON_NODE} "${CMAKE_CURRENT_SOURCE_DIR}/${name}.mjs" ${ARGN})
  else()
    add_test(NAME ${name} COMMAND ${CMAKE_COMMAND} -E echo "skipped: node is not installed")
    set_tests_properties(${name} PROPERTIES SKIP_REGULAR_EXPRESSION "skipped: node")
  endif()
  set_tests_properties(${name} PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 900)
endfunction()
gnomon_node_test(report_browser_test $<TARGET_FILE:outputs_sample> "${CMAKE_CURRENT_BINARY_DIR}/report_browser")
gnomon_node_test(report_numbers_test $<TARGET_FILE:outputs_sample> "${CMAKE_CURRENT_BINARY_DIR}/report_numbers")
gnomon_node_test(report_probe_browser_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/report_probe")
gnomon_node_test(report_views_browser_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/report_views")
gnomon_node_test(report_section_browser_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/report_section")
gnomon_node_test(report_hybrid_browser_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/report_hybrid")
gnomon_node_test(shimmer_browser_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/shimmer_browser")
gnomon_node_test(lessons_browser_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/lessons_browser")
gnomon_node_test(sweep_browser_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/sweep_browser")
gnomon_node_test(report_built_page_test "${CMAKE_CURRENT_BINARY_DIR}/report_built_page")
gnomon_node_test(gltf_validator_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/gltf_validator")
