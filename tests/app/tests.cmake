# The command line: its values, its signals, and the program seen from outside.
find_package(rapidcheck REQUIRED)
# 800 starts of the program.
gnomon_test(app_test PARTS 8
  SOURCES app_heatmap_test.cpp app_values_test.cpp app_interrupt_test.cpp app_lesson_gl_test.cpp app_lessons_site_test.cpp app_completion_test.cpp app_docs_gl_test.cpp app_faults_gl_test.cpp app_few_resources_gl_test.cpp app_grade_page_test.cpp app_page_policy_gl_test.cpp app_limited_process_test.cpp app_many_lights_gl_test.cpp app_missing_program_test.cpp app_names_gl_test.cpp app_no_data_lost_gl_test.cpp app_shaders_gl_test.cpp app_answers_gl_test.cpp app_bench_gl_test.cpp app_repeated_commands_test.cpp app_cli_gl_test.cpp app_usage_gl_test.cpp app_technique_options_gl_test.cpp app_time_budget_gl_test.cpp app_pictures_gl_test.cpp app_judge_gl_test.cpp
  LIBS app_process gnomon_app_commands gnomon_studies_commands gnomon_verify_commands gnomon_judge_commands gnomon_grade_commands gnomon_lab_commands gnomon_benchmark_commands gnomon::scene OpenImageIO::OpenImageIO nlohmann_json::nlohmann_json rapidcheck rapidcheck_gtest)
add_dependencies(app_test gnomon_programs fault_injector)

# The commands that take a tenth of a second, single files and whole folders, with a call of the C library failing here and there:
# around those that publish, and of all kinds, and with what somebody planted in their folders; then memory, threads and descriptors
# alone; then signals that interrupt calls. A sanitizer has its own malloc().
if(NOT GNOMON_SANITIZE)
  set(campaign /usr/bin/python3 "${CMAKE_CURRENT_SOURCE_DIR}/faults/campaign.py" "$<TARGET_FILE:gnomon_program>"
    "$<TARGET_FILE:fault_injector>")
  add_test(NAME faults_test COMMAND ${campaign} --points 50
    --only diff --only export --only merge --only shaders --only "grade --new" --only plan --only scenes --only completion --only "man page")
  add_test(NAME faults_resources_test COMMAND ${campaign} --points 36 --kind malloc --kind large-malloc --kind thread --kind descriptor
    --only export --only merge --only shaders)
  add_test(NAME faults_interrupted_test COMMAND ${campaign} --points 40 --error EINTR
    --only export --only merge --only shaders --only "grade --new")
  set_tests_properties(faults_test faults_resources_test faults_interrupted_test PROPERTIES TIMEOUT 1200)
endif()

# What lies in the way of outputs, and a umask.
gnomon_test(hostile_folders_test SOURCES app_hostile_folders_test.cpp LIBS app_process)
add_dependencies(hostile_folders_test gnomon_programs fault_injector)

# The lessons' own commands, and the fault that each of them shows.
gnomon_test(lesson_faults_gl_test TIMEOUT 900 SOURCES lesson_faults_gl_test.cpp LIBS app_process gnomon::report nlohmann_json::nlohmann_json)
add_dependencies(lesson_faults_gl_test gnomon_programs)

# The conformance suite that gnomon export writes.
gnomon_test(export_suite_test SOURCES export_suite_test.cpp LIBS gnomon::app gnomon::scene)

# The lessons of the site, with their live figures.
gnomon_node_test(lessons_browser_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/lessons_browser")
gnomon_node_test(lectures_browser_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/lectures_browser")
