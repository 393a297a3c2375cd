# The loaders, and everything that reads or writes a file.
target_sources(gnomon_scene PRIVATE
  texture_sample.cpp
  files/image_io.cpp files/read_file.cpp files/sha256.cpp files/write_file.cpp)
target_link_libraries(gnomon_scene PRIVATE OpenImageIO::OpenImageIO)
