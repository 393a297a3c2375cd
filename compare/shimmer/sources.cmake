# Shadows in time. The sources go into the room's library gnomon_compare.
set(GNOMON_COMPARE_SHIMMER_SOURCES film.cpp film_file.cpp json.cpp page.cpp page_chart.cpp path.cpp shimmer.cpp summary.cpp temporal.cpp write.cpp)
list(TRANSFORM GNOMON_COMPARE_SHIMMER_SOURCES PREPEND "${CMAKE_CURRENT_LIST_DIR}/")
