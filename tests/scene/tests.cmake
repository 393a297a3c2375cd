gnomon_test(core_geometry_test SOURCES core_geometry_test.cpp scene_cascade_test.cpp scene_light_fit_test.cpp
  LIBS small_scenes fmt::fmt)
# Fits of maps call inline functions of scene/ that the linker takes from here: at -Og they cost nine times as much.
set_target_properties(core_geometry_test PROPERTIES TEST_IS_BUSY ON)
gnomon_test(core_freed_memory_test SOURCES core_freed_memory_test.cpp LIBS gnomon::scene)
gnomon_test(core_parallel_test SOURCES core_parallel_test.cpp LIBS gnomon::scene)
gnomon_test(core_run_program_test SOURCES core_run_program_test.cpp LIBS gnomon::scene)
gnomon_test_support(through_float SOURCES ../support/through_float.cpp LIBS gnomon::scene)
gnomon_test(core_rounding_test SOURCES core_rounding_test.cpp LIBS through_float)

gnomon_test(scene_files_test
  SOURCES scene_bad_input_test.cpp scene_expression_test.cpp scene_foreign_test.cpp scene_gltf_errors_test.cpp scene_gltf_materials_test.cpp scene_gltf_packed_test.cpp scene_gltf_poses_test.cpp scene_gltf_test.cpp scene_ground_test.cpp scene_image_decode_test.cpp scene_image_test.cpp scene_interior_test.cpp scene_json_errors_test.cpp scene_json_test.cpp scene_made_view_test.cpp scene_model_files_test.cpp scene_texture_memory_test.cpp
    scene_obj_alpha_test.cpp scene_obj_test.cpp scene_path_status_test.cpp scene_paths_test.cpp scene_ply_test.cpp scene_schema_test.cpp scene_tessellate_test.cpp scene_texture_test.cpp
    scene_staged_folder_test.cpp
    scene_write_file_test.cpp
  LIBS gnomon::scene fmt::fmt nlohmann_json::nlohmann_json)

# Scenes written as glTF and read again; the ray tracer says whether their shadows are the same.
gnomon_test(scene_gltf_writer_test SOURCES scene_gltf_writer_test.cpp
  LIBS gnomon::raytrace gnomon::scene nlohmann_json::nlohmann_json)

# A program of its own: its rename() and others stand before those of the system.
gnomon_test(scene_output_faults_test SOURCES scene_output_faults_test.cpp
  LIBS gnomon::scene ${CMAKE_DL_LIBS})

gnomon_test(builtin_test
  SOURCES builtin_generate_test.cpp builtin_parameters_test.cpp builtin_teapot_test.cpp builtin_texture_test.cpp
    builtin_overlap_test.cpp builtin_scenes_test.cpp
  LIBS gnomon::scene)

# What export writes, by the validator of glTF.
gnomon_node_test(gltf_validator_test $<TARGET_FILE:gnomon_program> "${CMAKE_CURRENT_BINARY_DIR}/gltf_validator")
