# Shadows in time. The sources go into the room's library gnomon_compare, what is text into its part gnomon_compare_untimed.
set(GNOMON_COMPARE_SHIMMER_SOURCES film.cpp shimmer.cpp temporal.cpp)
set(GNOMON_COMPARE_SHIMMER_TEXT_SOURCES film_file.cpp json.cpp page.cpp page_chart.cpp path.cpp summary.cpp write.cpp)
list(TRANSFORM GNOMON_COMPARE_SHIMMER_SOURCES PREPEND "${CMAKE_CURRENT_LIST_DIR}/")
list(TRANSFORM GNOMON_COMPARE_SHIMMER_TEXT_SOURCES PREPEND "${CMAKE_CURRENT_LIST_DIR}/")
