# What a comparison is written as.
gnomon_test(outputs_test
  SOURCES outputs_text_test.cpp outputs_json_test.cpp outputs_pictures_test.cpp outputs_flip_test.cpp
  LIBS gnomon::compare nlohmann_json::nlohmann_json OpenImageIO::OpenImageIO TBB::tbb)
