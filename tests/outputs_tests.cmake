# What a comparison is written as.
gnomon_test(outputs_test
  SOURCES outputs_text_test.cpp outputs_json_test.cpp outputs_pictures_test.cpp outputs_flip_test.cpp
  LIBS gnomon::compare nlohmann_json::nlohmann_json OpenImageIO::OpenImageIO TBB::tbb)

# The report page in a real browser: sample pages are written first, then looked at.
add_executable(outputs_sample "${CMAKE_CURRENT_LIST_DIR}/outputs_sample_main.cpp")
target_link_libraries(outputs_sample PRIVATE gnomon_flags gnomon_warnings gnomon::compare)
