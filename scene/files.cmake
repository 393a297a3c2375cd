# The loaders, and everything that reads or writes a file.
target_sources(gnomon_scene PRIVATE
  texture_sample.cpp files/apng.cpp files/encodings.cpp files/foreign.cpp files/defaults.cpp files/gltf_accessor.cpp
  files/gltf_container.cpp files/gltf_data.cpp files/gltf_draco.cpp files/gltf_meshes.cpp files/gltf_meshopt.cpp
  files/gltf_transforms.cpp files/gltf_writer_meshes.cpp files/image_io.cpp files/image_library.cpp files/interior.cpp
  files/png_encode.cpp files/mapped_file.cpp files/merge.cpp files/obj.cpp files/obj_text.cpp
  files/ply.cpp files/ply_regular.cpp files/jpeg_decode.cpp files/png_decode.cpp files/polygon.cpp files/read_file.cpp
  files/row_file.cpp files/validate.cpp)
gnomon_untimed(scene
  files/gltf.cpp files/gltf_extras.cpp files/gltf_materials.cpp files/gltf_paths.cpp files/gltf_parse.cpp
  files/gltf_parse_nodes.cpp files/gltf_textures.cpp files/gltf_writer.cpp files/gltf_writer_materials.cpp
  files/json_document.cpp files/json_generate.cpp files/json_geometry.cpp files/json_lights.cpp
  files/json_materials.cpp files/json_reader.cpp files/json_repeat.cpp files/json_solids.cpp files/json_scene.cpp files/light_json.cpp
  files/load.cpp files/material_notes.cpp files/mtl.cpp files/obj_materials.cpp files/obj_textures.cpp files/path_keys.cpp files/path_status.cpp files/ply_header.cpp
  files/publication.cpp files/shadow_variants.cpp files/staged_folder.cpp files/exr_file.cpp files/write_file.cpp
  LIBRARIES glm::glm tl::expected fmt::fmt nlohmann_json::nlohmann_json)
target_link_libraries(gnomon_scene PRIVATE nlohmann_json::nlohmann_json PNG::PNG libdeflate ${TURBOJPEG_LIBRARY} ${NETTLE_LIBRARY} TBB::tbb ${CMAKE_DL_LIBS})
# The headers of both lie where the compiler looks.
target_link_libraries(gnomon_scene PRIVATE $<LINK_ONLY:draco::draco> $<LINK_ONLY:meshoptimizer::meshoptimizer>)

# OpenImageIO, loaded when an image file is read or an EXR written (scene/files/image_library.h).
add_library(gnomon_images MODULE files/image_module.cpp)
gnomon_compile_for_text(gnomon_images)
target_link_libraries(gnomon_images PRIVATE gnomon_flags gnomon_warnings OpenImageIO::OpenImageIO fmt::fmt glm::glm tl::expected)
target_include_directories(gnomon_images PRIVATE ${PROJECT_SOURCE_DIR})
set_target_properties(gnomon_images PROPERTIES CXX_VISIBILITY_PRESET hidden)
add_dependencies(gnomon_scene gnomon_images)
set_source_files_properties(files/image_library.cpp PROPERTIES COMPILE_DEFINITIONS
  "GNOMON_IMAGE_MODULE=\"$<TARGET_FILE:gnomon_images>\";GNOMON_IMAGE_MODULE_FROM_BIN=\"../lib/gnomon\"")
# Sanitized programs have it from the start: GCC 12's leak checker can crash at exit ("Tracer caught signal 11") where a
# library that was loaded late has variables of its own in each thread.
if(GNOMON_SANITIZE)
  target_link_options(gnomon_scene INTERFACE -Wl,--push-state,--no-as-needed $<TARGET_FILE:gnomon_images> -Wl,--pop-state)
endif()
