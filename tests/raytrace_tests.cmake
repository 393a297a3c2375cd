gnomon_test_support(raytrace_support SOURCES support/raytrace_support.cpp LIBS gnomon::small_world)

gnomon_test(raytrace_test
  SOURCES raytrace_hits_test.cpp raytrace_shapes_test.cpp raytrace_visibility_test.cpp raytrace_frame_test.cpp
    raytrace_edge_on_test.cpp raytrace_apex_test.cpp raytrace_methods_test.cpp raytrace_sheets_test.cpp raytrace_builder_test.cpp raytrace_leaf_primitives_test.cpp
  LIBS raytrace_support TBB::tbb)

gnomon_test(raytrace_solids_test
  SOURCES raytrace_solids_test.cpp raytrace_solid_sheets_test.cpp raytrace_twins_test.cpp
  LIBS raytrace_support TBB::tbb)

gnomon_test(raytrace_packet_test
  SOURCES raytrace_packet_test.cpp raytrace_packet_masks_test.cpp raytrace_packet_parts_test.cpp raytrace_edge_setup_test.cpp
  LIBS raytrace_support TBB::tbb hwy::hwy)

gnomon_test(raytrace_wide_test
  SOURCES raytrace_wide_test.cpp raytrace_wide_tree_test.cpp raytrace_wide_interval_test.cpp
    raytrace_light_shaft_test.cpp
  LIBS raytrace_support TBB::tbb hwy::hwy)

gnomon_test(raytrace_cells_test
  SOURCES raytrace_cells_test.cpp
  LIBS raytrace_support TBB::tbb hwy::hwy)

gnomon_test(raytrace_accel_test
  SOURCES raytrace_accel_test.cpp raytrace_sides_test.cpp
  LIBS raytrace_support TBB::tbb)

gnomon_test(raytrace_two_level_test
  SOURCES raytrace_two_level_test.cpp raytrace_instances_test.cpp
  LIBS raytrace_support TBB::tbb)

# Real models, against Embree: a comparator, never behind the user's own result.
gnomon_test(raytrace_models_test
  SOURCES raytrace_models_test.cpp
  LIBS raytrace_support embree TBB::tbb)

# The speed figures; a short run of it is a test that it runs, not of how fast.
gnomon_test_support(bench_scenes SOURCES bench/bench_scenes.cpp LIBS raytrace_support test_places)
add_executable(gnomon_bench bench/gnomon_bench.cpp bench/tracer_bench.cpp bench/ball_light.cpp bench/embree_peer.cpp bench/tinybvh_peer.cpp
  ${PROJECT_SOURCE_DIR}/app/process/large_pages.cpp ${PROJECT_SOURCE_DIR}/app/process/machine.cpp)
target_link_libraries(gnomon_bench PRIVATE gnomon_flags gnomon_warnings gnomon::benchmark test_places bench_scenes embree TBB::tbb hwy::hwy CLI11::CLI11
  fmt::fmt nlohmann_json::nlohmann_json)
gnomon_compile_together(gnomon_bench)
# tinybvh (github.com/jbikker/tinybvh) is one header and no part of the set-up: -DGNOMON_TINYBVH=FOLDER says where it is.
find_path(GNOMON_TINYBVH tiny_bvh.h)
mark_as_advanced(GNOMON_TINYBVH)
if(GNOMON_TINYBVH)
  target_include_directories(gnomon_bench SYSTEM PRIVATE "${GNOMON_TINYBVH}")
  set_source_files_properties(bench/tinybvh_peer.cpp PROPERTIES COMPILE_OPTIONS "-mavx2;-mfma;-w"
    SKIP_UNITY_BUILD_INCLUSION ON)
endif()
# Of --json - the rows alone go to stdout.
add_test(NAME gnomon_bench_runs COMMAND sh -c
  "\"$1\" --scene teapot --runs 1 --size 160x90 --json - | /usr/bin/python3 -m json.tool" sh $<TARGET_FILE:gnomon_bench>)

# Whole processes against POV-Ray 3.7 and Blender's Cycles, where they are installed (they are no part of the set-up).
add_executable(programs_bench bench/programs_bench.cpp)
target_compile_definitions(programs_bench PRIVATE GNOMON_BENCH_FOLDER="${CMAKE_CURRENT_SOURCE_DIR}/bench")
target_link_libraries(programs_bench PRIVATE gnomon_flags gnomon_warnings test_places bench_scenes CLI11::CLI11 fmt::fmt
  nlohmann_json::nlohmann_json)
find_program(GNOMON_POVRAY povray)
mark_as_advanced(GNOMON_POVRAY)
if(GNOMON_POVRAY)
  add_test(NAME povray_bench_pictures_alike COMMAND programs_bench --gnomon $<TARGET_FILE:gnomon_program> --scene teapot --runs 1
    --peer povray --width 320 --height 180 --out ${CMAKE_CURRENT_BINARY_DIR}/povray)
endif()
