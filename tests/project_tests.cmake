# Checks of the project as a whole: its arrows, its formatting.
gnomon_test(project_arrows_test SOURCES project_arrows_test.cpp)

add_test(NAME project_format_test COMMAND "${CMAKE_CURRENT_SOURCE_DIR}/project_format_test.sh")
set_tests_properties(project_format_test PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 120)
