# Judging other renderers' pictures. The sources go into the room's library gnomon_compare.
set(GNOMON_COMPARE_JUDGE_SOURCES advice.cpp align.cpp capture.cpp capture_pictures.cpp captured_frame.cpp captured_map.cpp encoding.cpp evidence.cpp identify.cpp judge.cpp page.cpp receivers.cpp resolution.cpp several.cpp suspects.cpp)
list(TRANSFORM GNOMON_COMPARE_JUDGE_SOURCES PREPEND "${CMAKE_CURRENT_LIST_DIR}/")
