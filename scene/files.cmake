# The loaders, and everything that reads or writes a file.
target_sources(gnomon_scene PRIVATE texture_sample.cpp)
