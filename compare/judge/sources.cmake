# Judging other renderers' pictures. The sources go into the room's library gnomon_compare, what is text into its part gnomon_compare_untimed.
set(GNOMON_COMPARE_JUDGE_SOURCES align.cpp capture_pictures.cpp captured_frame.cpp captured_map.cpp described_test.cpp drawn_test.cpp encoding.cpp evidence.cpp identify.cpp judge.cpp receivers.cpp resolution.cpp suspects.cpp)
set(GNOMON_COMPARE_JUDGE_TEXT_SOURCES page.cpp advice.cpp several.cpp capture.cpp)
list(TRANSFORM GNOMON_COMPARE_JUDGE_SOURCES PREPEND "${CMAKE_CURRENT_LIST_DIR}/")
list(TRANSFORM GNOMON_COMPARE_JUDGE_TEXT_SOURCES PREPEND "${CMAKE_CURRENT_LIST_DIR}/")
