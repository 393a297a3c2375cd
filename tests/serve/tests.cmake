# The lab as a page, served by the program: what it answers and to whom, and the page in a real browser.
gnomon_node_test(serve_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/serve")
gnomon_node_test(serve_hostile_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/serve_hostile")
gnomon_node_test(serve_browser_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/serve_browser")
