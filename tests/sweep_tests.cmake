# Sweeps: axes, journal and metrics; the engine against single comparisons; the command line with real signals.
gnomon_test(sweep_test SOURCES sweep_axis_test.cpp sweep_headline_test.cpp sweep_journal_test.cpp sweep_merge_test.cpp sweep_ssim_test.cpp LIBS gnomon::studies)
gnomon_test(sweep_engine_gl_test TIMEOUT 900
  SOURCES sweep_engine_gl_test.cpp sweep_edge_gl_test.cpp sweep_theory_gl_test.cpp tune_grid_gl_test.cpp sweep_cell_pictures_gl_test.cpp
  LIBS compare_support gnomon::app)
gnomon_test(sweep_program_gl_test TIMEOUT 900 SOURCES sweep_program_gl_test.cpp tune_program_gl_test.cpp tune_lights_gl_test.cpp views_program_gl_test.cpp LIBS nlohmann_json::nlohmann_json)
add_dependencies(sweep_program_gl_test gnomon_program)
