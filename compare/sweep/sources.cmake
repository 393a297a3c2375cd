# Sweeps and tuning. The sources go into gnomon_compare_untimed, a part of the room's library.
set(GNOMON_COMPARE_SWEEP_SOURCES
  ../report/log_chart.cpp ../tune/chart.cpp ../tune/choose.cpp ../tune/cost_chart.cpp ../tune/explain.cpp ../tune/full_grid.cpp ../tune/measure_in_turn.cpp ../tune/ties.cpp ../tune/page.cpp ../tune/tune.cpp axis.cpp bias_axis.cpp cell_files.cpp cell_table.cpp charts.cpp engine.cpp engine_pictures.cpp grid.cpp headline.cpp journal.cpp merge.cpp page.cpp page_data.cpp ray_points.cpp size_chart.cpp summary.cpp words.cpp)
list(TRANSFORM GNOMON_COMPARE_SWEEP_SOURCES PREPEND "${CMAKE_CURRENT_LIST_DIR}/")
