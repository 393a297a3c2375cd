# Other processors: one small program (arm64_small_test.sh); the whole of it once a week (arm64.sh).
add_executable(small_rays "${CMAKE_CURRENT_LIST_DIR}/small_rays.cpp")
target_link_libraries(small_rays PRIVATE gnomon_flags gnomon_warnings gnomon::raytrace)
add_test(NAME arm64_small_test COMMAND "${CMAKE_CURRENT_LIST_DIR}/arm64_small_test.sh" "$<TARGET_FILE:small_rays>"
  "${CMAKE_CURRENT_BINARY_DIR}/arm64_small")
set_tests_properties(arm64_small_test PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 600)
