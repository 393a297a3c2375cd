# Sweeps and tuning. The sources go into the room's library gnomon_compare; the rest happens once that exists.
set(GNOMON_COMPARE_SWEEP_SOURCES
  ../tune/tune.cpp axis.cpp bias_axis.cpp charts.cpp engine.cpp grid.cpp journal.cpp merge.cpp page.cpp summary.cpp table.cpp)
list(TRANSFORM GNOMON_COMPARE_SWEEP_SOURCES PREPEND "${CMAKE_CURRENT_LIST_DIR}/")

function(gnomon_compare_sweep target)
  set(sweep "${CMAKE_CURRENT_FUNCTION_LIST_DIR}")
  gnomon_embed(${target} sweep "${sweep}/sweep.css" "${sweep}/sweep.js")
endfunction()
cmake_language(DEFER CALL gnomon_compare_sweep gnomon_compare)
