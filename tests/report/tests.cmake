# The report page in a real browser: sample pages are written first, then looked at.
add_executable(outputs_sample "${CMAKE_CURRENT_LIST_DIR}/report_sample_main.cpp")
target_link_libraries(outputs_sample PRIVATE gnomon_flags gnomon_warnings gnomon::judge gnomon::studies nlohmann_json::nlohmann_json)

gnomon_node_test(report_browser_test $<TARGET_FILE:outputs_sample> "${CMAKE_CURRENT_BINARY_DIR}/report_browser")
gnomon_node_test(report_numbers_test $<TARGET_FILE:outputs_sample> "${CMAKE_CURRENT_BINARY_DIR}/report_numbers")
gnomon_node_test(report_probe_browser_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/report_probe")
gnomon_node_test(report_views_browser_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/report_views")
gnomon_node_test(report_section_browser_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/report_section")
gnomon_node_test(report_hybrid_browser_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/report_hybrid")
gnomon_node_test(report_built_page_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/report_built_page")
