# One test for each hard case that `gnomon verify` runs, with fewer rays.
set(hard_cases
  01_shared_edges 02_sliver 03_degenerate_triangles 04_coplanar_ray 05_distant_sphere 06_tangent_ray 07_inside_sphere
  08_direction_length 09_steep_plane 10_slab_faces 11_slab_corners 12_invalid_rays 13_equal_centroids 14_few_primitives
  15_bad_vertices 16_stadium 17_split_plane 18_cell_corners 19_self_hits 20_nested_spheres 21_instances
  22_light_in_plane 23_light_at_vertex 24_occluder_at_end 25_light_inside 26_coplanar_duplicates 27_contact_gap
  28_smooth_normals 29_critical_angle 30_invisible_glass 31_depth_range 32_behind_light 33_outside_map
  34_texel_boundaries 35_cube_seams 36_bias_convergence 37_far_from_origin 38_image_sizes
  39_non_finite_radiance 40_shrinking_lights 41_extreme_bias
  42_scale_invariance 43_coplanar_lights 44_stretched_triangles)

add_executable(hard_case_test "${CMAKE_CURRENT_LIST_DIR}/hard_case_test.cpp")
target_link_libraries(hard_case_test PRIVATE gnomon_flags gnomon_warnings gnomon::verify fmt::fmt)
foreach(case ${hard_cases})
  add_test(NAME hard_case_${case} COMMAND hard_case_test ${case})
endforeach()
add_test(NAME hard_case_list COMMAND hard_case_test --complete ${hard_cases})

# What the table says of rows that could not be tried.
gnomon_test(verify_rows_gl_test SOURCES verify_rows_gl_test.cpp LIBS gnomon::verify)

# izb and hybrid against the rays on random scenes; by hand 2,000 of them: build/release/tests/random_scenes_gl_test 2000
add_executable(random_scenes_gl_test "${CMAKE_CURRENT_LIST_DIR}/random_scenes_gl_test.cpp")
target_link_libraries(random_scenes_gl_test PRIVATE gnomon_flags gnomon_warnings gnomon::verify gnomon::hybrid test_places fmt::fmt)
add_test(NAME random_scenes_gl_test COMMAND random_scenes_gl_test 120)

# exact against rational numbers, triangle by triangle; by hand with 1e7: build/release/tests/exact_gmp_test 1e7
add_executable(exact_gmp_test "${CMAKE_CURRENT_LIST_DIR}/exact_gmp_test.cpp")
target_link_libraries(exact_gmp_test PRIVATE gnomon_flags gnomon_warnings gnomon::verify fmt::fmt TBB::tbb)
add_test(NAME exact_gmp_test COMMAND exact_gmp_test 2e5)

# robust against exact, and exact against rational numbers, on the same random scenes
add_executable(precisions_agree_test "${CMAKE_CURRENT_LIST_DIR}/precisions_agree_test.cpp")
target_link_libraries(precisions_agree_test PRIVATE gnomon_flags gnomon_warnings gnomon::verify fmt::fmt)
add_test(NAME precisions_agree_test COMMAND precisions_agree_test 60)
