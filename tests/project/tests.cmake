# Checks of the project as a whole: its arrows, its formatting, and clang-tidy on the shared ground (scene/*.cpp) that
# both renderers stand on. Everything else is ./gnomon tidy's, which takes tens of minutes.
gnomon_test(project_arrows_test SOURCES project_arrows_test.cpp)

add_test(NAME project_format_test COMMAND "${CMAKE_CURRENT_LIST_DIR}/project_format_test.sh")
set_tests_properties(project_format_test PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 900)

add_test(NAME project_tidy_test
  COMMAND "${CMAKE_CURRENT_LIST_DIR}/project_tidy_test.sh" --together scene)
set_tests_properties(project_tidy_test PROPERTIES
  SKIP_RETURN_CODE 77 TIMEOUT 900 ENVIRONMENT "GNOMON_BUILD_DIR=${PROJECT_BINARY_DIR}")

# The commit in the program's version, from git or from an archive.
add_test(NAME project_commit_test COMMAND "${CMAKE_CURRENT_LIST_DIR}/project_commit_test.sh"
  "${PROJECT_SOURCE_DIR}" "${CMAKE_COMMAND}" "$<TARGET_FILE:gnomon_program>")

# ./gnomon and a build folder that is not what it was.
add_test(NAME project_script_test COMMAND "${CMAKE_CURRENT_LIST_DIR}/project_script_test.sh" "${PROJECT_SOURCE_DIR}")

# The threat model names tests that are there.
add_test(NAME project_threats_test COMMAND /usr/bin/python3 "${CMAKE_CURRENT_LIST_DIR}/project_threats_test.py")

# What comes from npm runs on Debian 12's Node.js.
add_test(NAME project_node_test COMMAND "${CMAKE_CURRENT_LIST_DIR}/project_node_test.sh" "${PROJECT_SOURCE_DIR}")

# A fault of GCC 12 in how masks of lanes are spilled, which raytrace/mask_bits-inl.h avoids: nowhere in the program.
add_test(NAME project_mask_spills_test COMMAND /usr/bin/python3 "${CMAKE_CURRENT_SOURCE_DIR}/tools/mask_spills.py"
  --self-test "$<TARGET_FILE:gnomon_program>")
set_tests_properties(project_mask_spills_test PROPERTIES SKIP_RETURN_CODE 77)

# The Debian package that cpack makes of this build.
add_test(NAME project_package_test
  COMMAND "${CMAKE_CURRENT_LIST_DIR}/project_package_test.sh" "${PROJECT_BINARY_DIR}" "${CMAKE_CURRENT_BINARY_DIR}/package")
set_tests_properties(project_package_test PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 900)

# The installed libraries, and the example that uses them.
add_test(NAME project_library_test COMMAND "${CMAKE_CURRENT_LIST_DIR}/project_library_test.sh"
  "${PROJECT_BINARY_DIR}" "${CMAKE_CURRENT_BINARY_DIR}/library" "${PROJECT_SOURCE_DIR}")
set_tests_properties(project_library_test PROPERTIES TIMEOUT 900)

# docs/notebook.md, block by block, where Python has pandas.
add_test(NAME docs_notebook_test COMMAND /usr/bin/python3 "${CMAKE_CURRENT_LIST_DIR}/docs_notebook_test.py"
  "$<TARGET_FILE:gnomon_program>" "${PROJECT_SOURCE_DIR}" "${CMAKE_CURRENT_BINARY_DIR}/notebook")
set_tests_properties(docs_notebook_test PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 900)

# What a new metric, setting, technique, shape, format or lesson takes, by examples.
add_test(NAME project_exercise_test COMMAND /usr/bin/python3 "${CMAKE_CURRENT_LIST_DIR}/project_exercise_test.py" "${PROJECT_SOURCE_DIR}")

# The sentences of the lab and of the grader, read through in one file.
add_test(NAME project_prose_test COMMAND /usr/bin/python3 "${CMAKE_CURRENT_LIST_DIR}/project_prose_test.py")

# Numbers that documents repeat: those of the confusion matrix.
add_test(NAME project_numbers_test COMMAND /usr/bin/python3 "${CMAKE_CURRENT_LIST_DIR}/project_numbers_test.py")

# The code that lessons show is the code that runs.
add_test(NAME project_lesson_code_test COMMAND /usr/bin/python3 "${CMAKE_CURRENT_LIST_DIR}/project_lesson_code_test.py")

# The lessons' drawings are what their script writes.
add_test(NAME docs_drawings_test COMMAND /usr/bin/python3 "${PROJECT_SOURCE_DIR}/docs/make_drawings.py" --check)
