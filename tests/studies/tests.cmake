# Sweeps: axes, journal and metrics; the engine against single comparisons; the command line with real signals.
gnomon_test(sweep_test SOURCES sweep_axis_test.cpp sweep_headline_test.cpp sweep_journal_test.cpp sweep_merge_test.cpp sweep_ssim_test.cpp LIBS gnomon::studies)
gnomon_test(sweep_engine_gl_test TIMEOUT 900
  SOURCES sweep_engine_gl_test.cpp sweep_edge_gl_test.cpp sweep_theory_gl_test.cpp tune_grid_gl_test.cpp sweep_cell_pictures_gl_test.cpp
  LIBS compare_support gnomon_studies_options)
gnomon_test(sweep_program_gl_test TIMEOUT 900 SOURCES sweep_program_gl_test.cpp tune_program_gl_test.cpp tune_lights_gl_test.cpp views_program_gl_test.cpp LIBS gnomon::compare nlohmann_json::nlohmann_json)
add_dependencies(sweep_program_gl_test gnomon_programs)

# Two results of one scene.
gnomon_test(diff_pixels_test SOURCES diff_pixels_test.cpp LIBS gnomon::studies)
gnomon_test(diff_program_gl_test SOURCES diff_program_gl_test.cpp annotate_program_gl_test.cpp LIBS app_process gnomon::scene nlohmann_json::nlohmann_json)
add_dependencies(diff_program_gl_test gnomon_programs)
gnomon_test(check_program_gl_test SOURCES check_program_gl_test.cpp LIBS app_process nlohmann_json::nlohmann_json)
add_dependencies(check_program_gl_test gnomon_programs)
# The three files of docs/ci.md.
add_test(NAME check_docs_test COMMAND /usr/bin/python3 -B "${CMAKE_CURRENT_LIST_DIR}/check_docs_test.py" "$<TARGET_FILE:gnomon_program>"
  "${PROJECT_SOURCE_DIR}" "${CMAKE_CURRENT_BINARY_DIR}/check_docs")
set_tests_properties(check_docs_test PROPERTIES SKIP_RETURN_CODE 77)

gnomon_test(shimmer_gl_test
  SOURCES shimmer_gl_test.cpp shimmer_parts_test.cpp
  LIBS small_scenes gnomon::studies nlohmann_json::nlohmann_json)
gnomon_test(shimmer_program_gl_test SOURCES shimmer_program_gl_test.cpp LIBS app_process gnomon::scene nlohmann_json::nlohmann_json)
add_dependencies(shimmer_program_gl_test gnomon_programs)

gnomon_test(judge_gl_test PARTS 3
  SOURCES judge_gl_test.cpp judge_parts_gl_test.cpp judge_values_gl_test.cpp judge_described_gl_test.cpp
          judge_content_gl_test.cpp judge_far_plane_gl_test.cpp judge_own_test_gl_test.cpp
  LIBS capture_support fmt::fmt nlohmann_json::nlohmann_json)
gnomon_test(judge_advice_gl_test TIMEOUT 900 SOURCES judge_advice_gl_test.cpp LIBS capture_support fmt::fmt nlohmann_json::nlohmann_json)
gnomon_test(judge_pictures_gl_test SOURCES judge_pictures_gl_test.cpp judge_words_gl_test.cpp
  LIBS capture_support fmt::fmt nlohmann_json::nlohmann_json)
gnomon_test(judge_keys_gl_test SOURCES judge_keys_gl_test.cpp LIBS capture_support fmt::fmt nlohmann_json::nlohmann_json)
gnomon_test(judge_faults_gl_test SOURCES judge_faults_gl_test.cpp judge_places_gl_test.cpp LIBS capture_support fmt::fmt nlohmann_json::nlohmann_json)
gnomon_test(judge_bad_captures_test SOURCES judge_bad_captures_test.cpp judge_schema_test.cpp judge_several_test.cpp LIBS gnomon::judge fmt::fmt nlohmann_json::nlohmann_json)
gnomon_test(judge_identify_gl_test
  SOURCES judge_identify_gl_test.cpp
  LIBS capture_support fmt::fmt nlohmann_json::nlohmann_json)
# The adapters on real engines, as far as they are installed.
gnomon_node_test(adapters_browser_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/adapters_browser")
gnomon_node_test(adapters_lab_browser_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/adapters_lab_browser")
gnomon_node_test(adapters_blender_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/adapters_blender")
# The adapter for frames that RenderDoc recorded: its numbers, for which Debian's Python and NumPy are enough.
foreach(test renderdoc_casters_test renderdoc_fit_test renderdoc_forms_test renderdoc_frame_test)
  add_test(NAME ${test} COMMAND /usr/bin/python3 -B "${CMAKE_CURRENT_LIST_DIR}/${test}.py" "${PROJECT_SOURCE_DIR}/adapters/renderdoc")
  set_tests_properties(${test} PROPERTIES SKIP_RETURN_CODE 77)
endforeach()
# The same on recorded frames of common designs, which are no part of the project.
add_test(NAME renderdoc_designs_test COMMAND /usr/bin/python3 -B "${CMAKE_CURRENT_LIST_DIR}/renderdoc_designs_test.py"
  $<TARGET_FILE:gnomon_program> "${PROJECT_SOURCE_DIR}/../shared/findings/engines" "${CMAKE_CURRENT_BINARY_DIR}/renderdoc_designs")
set_tests_properties(renderdoc_designs_test PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 900)
# The same on frames of real engines, as far as these and RenderDoc are installed.
add_test(NAME renderdoc_engine_test COMMAND /usr/bin/python3 -B "${CMAKE_CURRENT_LIST_DIR}/renderdoc_engine_test.py"
  $<TARGET_FILE:gnomon_program> "${PROJECT_SOURCE_DIR}" "${CMAKE_CURRENT_BINARY_DIR}/renderdoc_engine")
set_tests_properties(renderdoc_engine_test PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 1500)
# The same of web pages, as far as a browser that RenderDoc can record is installed.
add_test(NAME renderdoc_page_test COMMAND /usr/bin/python3 -B "${CMAKE_CURRENT_LIST_DIR}/renderdoc_page_test.py"
  $<TARGET_FILE:gnomon_program> "${PROJECT_SOURCE_DIR}" "${CMAKE_CURRENT_BINARY_DIR}/renderdoc_page")
set_tests_properties(renderdoc_page_test PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 900)

# gnomon grade: answers that are alike; and the program on shaders with known faults.
gnomon_test(grade_alike_test SOURCES grade_alike_test.cpp grade_rules_test.cpp LIBS gnomon::grade)
gnomon_test(grade_gl_test
  SOURCES grade_gl_test.cpp grade_rubrics_gl_test.cpp grade_class_gl_test.cpp
  LIBS app_process nlohmann_json::nlohmann_json PARTS 5)
add_dependencies(grade_gl_test gnomon_programs)
gnomon_test(functions_split_test SOURCES functions_split_test.cpp LIBS gnomon::functions gnomon::raytrace gnomon::scene)
gnomon_test(grade_functions_gl_test
  SOURCES grade_functions_gl_test.cpp grade_filter_gl_test.cpp grade_platforms_gl_test.cpp grade_macros_gl_test.cpp
  LIBS gnomon::grade app_process nlohmann_json::nlohmann_json PARTS 4)
add_dependencies(grade_functions_gl_test gnomon_programs)

# The pages of sweeps and films in a real browser.
gnomon_node_test(shimmer_browser_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/shimmer_browser")
gnomon_node_test(sweep_browser_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/sweep_browser")
