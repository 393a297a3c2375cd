# The hard cases stand apart from the command line, so that their tests do too; and so do the small scenes they are made of,
# which the tests of rays share.
add_library(gnomon_small_world STATIC verify/random.cpp verify/small_world.cpp verify/twin.cpp)
add_library(gnomon::small_world ALIAS gnomon_small_world)
target_link_libraries(gnomon_small_world PUBLIC gnomon_flags gnomon::raytrace gnomon::scene
  PRIVATE gnomon_warnings fmt::fmt)

add_library(gnomon_verify STATIC
  verify/case_boxes.cpp verify/case_far.cpp verify/case_glass.cpp verify/case_invariance.cpp verify/case_lights.cpp verify/case_nested_glass.cpp verify/case_offsets.cpp
  verify/case_radiance.cpp verify/case_small_lights.cpp
  verify/case_map_depth.cpp verify/case_map_places.cpp verify/case_map_sizes.cpp verify/drawn_world.cpp
  verify/adversarial.cpp verify/case_rational.cpp verify/case_rays.cpp verify/case_shared_edges.cpp verify/case_spheres.cpp verify/case_stretched.cpp verify/case_structures.cpp
  verify/case_triangles.cpp verify/cases.cpp verify/oracle.cpp verify/random_scene.cpp verify/rational.cpp verify/run.cpp)
add_library(gnomon::verify ALIAS gnomon_verify)
target_link_libraries(gnomon_verify PUBLIC gnomon_flags gnomon::small_world gnomon::raster gnomon::raytrace gnomon::scene
  PRIVATE gnomon_warnings fmt::fmt gmpxx gmp)
