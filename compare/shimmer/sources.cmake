# Shadows in time. The sources go into the room's library gnomon_compare.
set(GNOMON_COMPARE_SHIMMER_SOURCES json.cpp path.cpp path_file.cpp shimmer.cpp summary.cpp temporal.cpp)
list(TRANSFORM GNOMON_COMPARE_SHIMMER_SOURCES PREPEND "${CMAKE_CURRENT_LIST_DIR}/")
