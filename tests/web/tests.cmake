# The program for pages and Node (preset web), which ./gnomon web builds: skipped where it has not been built.
gnomon_node_test(web_node_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/web_node")
gnomon_node_test(web_gl_browser_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/web_gl")
# Half a minute of work, made once for both.
gnomon_node_test(web_site $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/web_site")
gnomon_node_test(web_lab_browser_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/web_lab" "${CMAKE_CURRENT_BINARY_DIR}/web_site")
gnomon_node_test(web_lessons_browser_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/web_site")
set_tests_properties(web_site PROPERTIES FIXTURES_SETUP web_site COST 200)
set_tests_properties(web_lab_browser_test web_lessons_browser_test PROPERTIES FIXTURES_REQUIRED web_site)
gnomon_node_test(web_package_browser_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/web_package")
