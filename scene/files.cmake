# The loaders, and everything that reads or writes a file.
target_sources(gnomon_scene PRIVATE
  texture_sample.cpp
  files/defaults.cpp files/gltf.cpp files/gltf_accessor.cpp files/gltf_check.cpp files/gltf_container.cpp
  files/gltf_materials.cpp files/gltf_meshes.cpp files/image_io.cpp files/json_document.cpp files/json_generate.cpp files/json_geometry.cpp
  files/json_lights.cpp files/json_materials.cpp files/json_reader.cpp files/json_solids.cpp files/json_scene.cpp files/load.cpp
  files/merge.cpp files/obj.cpp files/obj_check.cpp files/obj_materials.cpp files/ply.cpp files/ply_header.cpp files/image_check.cpp files/polygon.cpp files/read_file.cpp files/sha256.cpp
  files/validate.cpp files/write_file.cpp)
target_link_libraries(gnomon_scene PRIVATE OpenImageIO::OpenImageIO nlohmann_json::nlohmann_json
  tinyobjloader::tinyobjloader_double TinyGLTF::TinyGLTF)
