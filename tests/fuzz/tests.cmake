# Fuzz targets (tests/fuzz): one per loader, one that builds small worlds, and one for each other text that comes from
# outside: captures, rubrics, what a sweep left behind, command lines. Everywhere they replay their seeds and a fixed
# series of mutations; with clang and -DGNOMON_FUZZ=ON they are libFuzzer programs as well:
#   build/fuzz/tests/fuzz_json -rss_limit_mb=2048 -timeout=10 CORPUS

gnomon_test_support(fuzz_inputs SOURCES load_as.cpp LIBS gnomon::scene)
gnomon_test_support(fuzz_replay SOURCES fuzz_replay.cpp LIBS fuzz_inputs)

function(gnomon_fuzz_target name)
  add_executable(fuzz_replay_${name} "${CMAKE_CURRENT_SOURCE_DIR}/fuzz/fuzz_${name}.cpp")
  target_link_libraries(fuzz_replay_${name} PRIVATE gnomon_flags gnomon_warnings fuzz_replay ${ARGN})
  file(GLOB crashes CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/crashes/${name}/*)
  add_test(NAME fuzz_replay_${name} COMMAND fuzz_replay_${name} --mutations 400 ${crashes})
  set_tests_properties(fuzz_replay_${name} PROPERTIES TIMEOUT 900)
  if(GNOMON_FUZZ)
    add_executable(fuzz_${name} "${CMAKE_CURRENT_SOURCE_DIR}/fuzz/fuzz_${name}.cpp")
    target_link_libraries(fuzz_${name} PRIVATE gnomon_flags gnomon_warnings fuzz_inputs ${ARGN})
    target_link_options(fuzz_${name} PRIVATE -fsanitize=fuzzer)
  endif()
endfunction()

foreach(target json gltf obj mtl ply)
  gnomon_fuzz_target(${target})
endforeach()
gnomon_fuzz_target(world gnomon::raytrace)
gnomon_fuzz_target(capture gnomon::judge)
gnomon_fuzz_target(sweep gnomon::studies)
gnomon_fuzz_target(rubric gnomon::grade)
gnomon_fuzz_target(words gnomon_app_commands gnomon_studies_commands gnomon_verify_commands gnomon_judge_commands gnomon_grade_commands gnomon_lab_commands gnomon_benchmark_commands)
