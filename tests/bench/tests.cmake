# The speed figures; a short run of it is a test that it runs, not of how fast.
gnomon_test_support(bench_scenes SOURCES bench_scenes.cpp LIBS raytrace_support test_places)
add_executable(gnomon_bench "${CMAKE_CURRENT_LIST_DIR}/gnomon_bench.cpp" "${CMAKE_CURRENT_LIST_DIR}/tracer_bench.cpp" "${CMAKE_CURRENT_LIST_DIR}/ball_light.cpp" "${CMAKE_CURRENT_LIST_DIR}/embree_peer.cpp" "${CMAKE_CURRENT_LIST_DIR}/tinybvh_peer.cpp" "${CMAKE_CURRENT_LIST_DIR}/whole_bench.cpp"
  "${CMAKE_CURRENT_LIST_DIR}/command_cost.cpp" "${CMAKE_CURRENT_LIST_DIR}/scale_bench.cpp"
  ${PROJECT_SOURCE_DIR}/app/process/machine.cpp)
target_link_libraries(gnomon_bench PRIVATE gnomon_flags gnomon_warnings gnomon::benchmark test_places bench_scenes embree GTest::gtest TBB::tbb hwy::hwy CLI11::CLI11
  fmt::fmt nlohmann_json::nlohmann_json)
gnomon_compile_together(gnomon_bench)
# tinybvh (github.com/jbikker/tinybvh) is one header and no part of the set-up: -DGNOMON_TINYBVH=FOLDER says where it is.
find_path(GNOMON_TINYBVH tiny_bvh.h)
mark_as_advanced(GNOMON_TINYBVH)
if(GNOMON_TINYBVH)
  target_include_directories(gnomon_bench SYSTEM PRIVATE "${GNOMON_TINYBVH}")
  set_source_files_properties("${CMAKE_CURRENT_LIST_DIR}/tinybvh_peer.cpp" PROPERTIES COMPILE_OPTIONS "-mavx2;-mfma;-w"
    SKIP_UNITY_BUILD_INCLUSION ON)
endif()
# Of --json - the rows alone go to stdout.
add_test(NAME gnomon_bench_runs COMMAND sh -c
  "\"$1\" --scene teapot --runs 1 --size 160x90 --json - | /usr/bin/python3 -m json.tool" sh $<TARGET_FILE:gnomon_bench>)

# Whole processes against POV-Ray 3.7 and Blender's Cycles, where they are installed (they are no part of the set-up).
add_executable(programs_bench "${CMAKE_CURRENT_LIST_DIR}/programs_bench.cpp")
target_compile_definitions(programs_bench PRIVATE GNOMON_BENCH_FOLDER="${CMAKE_CURRENT_LIST_DIR}")
target_link_libraries(programs_bench PRIVATE gnomon_flags gnomon_warnings test_places bench_scenes CLI11::CLI11 fmt::fmt
  nlohmann_json::nlohmann_json)
find_program(GNOMON_POVRAY povray)
mark_as_advanced(GNOMON_POVRAY)
if(GNOMON_POVRAY)
  add_test(NAME povray_bench_pictures_alike COMMAND programs_bench --gnomon $<TARGET_FILE:gnomon_program> --scene teapot --runs 1
    --peer povray --width 320 --height 180 --out ${CMAKE_CURRENT_BINARY_DIR}/povray)
endif()

# Each technique's frame against the same draw calls by hand; run by hand, not a test.
add_executable(technique_bench "${CMAKE_CURRENT_LIST_DIR}/technique_bench.cpp" "${CMAKE_CURRENT_LIST_DIR}/minimal_program.cpp")
target_link_libraries(technique_bench PRIVATE gnomon_flags gnomon_warnings gnomon::raster gnomon_raster_private fmt::fmt)
gnomon_compile_together(technique_bench)
