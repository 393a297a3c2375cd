gnomon_test(compare_lists_test SOURCES compare_lists_test.cpp LIBS gnomon::compare hwy::hwy)
gnomon_test(compare_connected_surfaces_test SOURCES compare_connected_surfaces_test.cpp LIBS small_scenes raytrace_support gnomon::compare)

gnomon_test(compare_closed_form_gl_test TIMEOUT 900
  SOURCES compare_closed_form_gl_test.cpp compare_derived_bias_gl_test.cpp compare_filter_gl_test.cpp compare_other_sizes_gl_test.cpp compare_terminator_gl_test.cpp
          compare_units_test.cpp
  LIBS compare_support nlohmann_json::nlohmann_json)
gnomon_test(compare_confusion_gl_test TIMEOUT 900
  SOURCES compare_confusion_gl_test.cpp
  LIBS compare_support fmt::fmt nlohmann_json::nlohmann_json)
gnomon_test(compare_models_gl_test TIMEOUT 1200
  SOURCES compare_models_gl_test.cpp
  LIBS compare_support embree TBB::tbb nlohmann_json::nlohmann_json)
gnomon_test(compare_solids_gl_test TIMEOUT 900
  SOURCES compare_solids_gl_test.cpp compare_stored_surface_gl_test.cpp compare_surfaces_gl_test.cpp
  LIBS gnomon::compare)

# The same scene in other numbers: the same labels. GNOMON_INVARIANCE=N: N scenes, every technique under every light.
gnomon_test(compare_invariance_gl_test SOURCES compare_invariance_gl_test.cpp LIBS gnomon::verify gnomon::compare gnomon::hybrid)
# Instances of glTF files, kept and flattened.
gnomon_test(gltf_instances_gl_test
  SOURCES gltf_instances_gl_test.cpp
  LIBS gnomon::compare nlohmann_json::nlohmann_json)
# A comparison in bands against the whole.
gnomon_test(compare_bands_gl_test TIMEOUT 900
  SOURCES compare_bands_gl_test.cpp
  LIBS gnomon::report gnomon::hybrid nlohmann_json::nlohmann_json)

# What a comparison is written as.
gnomon_test(outputs_test
  SOURCES outputs_text_test.cpp outputs_time_difference_test.cpp outputs_verdict_test.cpp outputs_tune_page_test.cpp outputs_json_test.cpp outputs_figures_test.cpp outputs_pictures_test.cpp outputs_flip_test.cpp
  LIBS gnomon::studies nlohmann_json::nlohmann_json OpenImageIO::OpenImageIO TBB::tbb)

# What compare and tune advise, taken and drawn again (CONTRIBUTING.md has the long form).
add_test(NAME advice_test COMMAND /usr/bin/python3 -B "${CMAKE_CURRENT_SOURCE_DIR}/tools/advice.py" $<TARGET_FILE:gnomon_program> 24)
set_tests_properties(advice_test PROPERTIES TIMEOUT 900 SKIP_RETURN_CODE 77)
