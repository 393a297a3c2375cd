# The program for pages and Node (preset web), which ./gnomon web builds: skipped where it has not been built.
gnomon_node_test(web_node_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/web_node")
gnomon_node_test(web_gl_browser_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/web_gl")
gnomon_node_test(web_lab_browser_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/web_lab")
gnomon_node_test(web_lessons_browser_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/web_lessons")
gnomon_node_test(web_package_browser_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/web_package")
