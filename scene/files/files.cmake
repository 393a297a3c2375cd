# The loaders, and everything that reads or writes a file.
target_sources(gnomon_scene PRIVATE
  texture_sample.cpp files/pictures/apng.cpp files/encodings.cpp files/foreign.cpp files/repeated_instances.cpp files/defaults.cpp files/gltf/gltf_accessor.cpp
  files/gltf/gltf_container.cpp files/gltf/gltf_data.cpp files/gltf/gltf_meshes.cpp files/gltf/gltf_meshopt.cpp
  files/gltf/gltf_transforms.cpp files/gltf/gltf_writer_meshes.cpp files/pictures/exr_decode.cpp files/pictures/exr_encode.cpp files/pictures/image_io.cpp files/pictures/texture_memory.cpp files/interior.cpp files/made_view.cpp files/parts.cpp files/sketch.cpp
  files/pictures/png_encode.cpp files/mapped_file.cpp files/merge.cpp files/obj/obj.cpp files/obj/obj_text.cpp
  files/ply/ply.cpp files/ply/ply_regular.cpp files/pictures/jpeg_decode.cpp files/pictures/png_decode.cpp files/polygon.cpp files/read_file.cpp
  files/row_file.cpp files/validate.cpp)
gnomon_untimed(scene
  files/gltf/gltf.cpp files/gltf/gltf_extras.cpp files/gltf/gltf_materials.cpp files/gltf/gltf_paths.cpp files/gltf/gltf_parse.cpp
  files/gltf/gltf_parse_nodes.cpp files/gltf/gltf_textures.cpp files/gltf/gltf_writer.cpp files/gltf/gltf_writer_materials.cpp
  files/json/json_document.cpp files/json/json_generate.cpp files/json/json_geometry.cpp files/json/json_lights.cpp
  files/json/json_materials.cpp files/json/json_reader.cpp files/json/json_repeat.cpp files/json/json_solids.cpp files/json/json_scene.cpp files/json/light_json.cpp
  files/load.cpp files/material_notes.cpp files/obj/mtl.cpp files/obj/obj_materials.cpp files/obj/obj_textures.cpp files/path_keys.cpp files/own_program.cpp files/path_status.cpp files/ply/ply_header.cpp
  files/folder.cpp files/new_file.cpp files/publication.cpp files/shadow_variants.cpp files/staged_files.cpp files/staged_folder.cpp files/pictures/exr_file.cpp files/write_file.cpp
  LIBRARIES glm::glm tl::expected fmt::fmt nlohmann_json::nlohmann_json)
target_link_libraries(gnomon_scene PRIVATE nlohmann_json::nlohmann_json PNG::PNG libdeflate ${TURBOJPEG_LIBRARY} ${NETTLE_LIBRARY} ${GNOMON_SCENE_LIBRARIES})
# Where the programs are built.
set_source_files_properties(files/own_program.cpp PROPERTIES COMPILE_DEFINITIONS "GNOMON_PROGRAMS_BUILT=\"${PROJECT_BINARY_DIR}/app\"")
if(NOT GNOMON_PLATFORM STREQUAL native)
  return()
endif()

# OpenImageIO, loaded when an image file other than PNG and JPEG is read (scene/files/pictures/image_library.h).
add_library(gnomon_images MODULE files/pictures/image_module.cpp)
gnomon_compile_for_text(gnomon_images)
target_link_libraries(gnomon_images PRIVATE gnomon_flags gnomon_warnings OpenImageIO::OpenImageIO fmt::fmt glm::glm tl::expected)
target_include_directories(gnomon_images PRIVATE ${PROJECT_SOURCE_DIR})
set_target_properties(gnomon_images PROPERTIES CXX_VISIBILITY_PRESET hidden)
add_dependencies(gnomon_scene gnomon_images)
set_source_files_properties(files/pictures/image_library.cpp PROPERTIES COMPILE_DEFINITIONS
  "GNOMON_IMAGE_MODULE=\"$<TARGET_FILE:gnomon_images>\";GNOMON_IMAGE_MODULE_FROM_BIN=\"../lib/gnomon\"")
# Sanitized programs have it from the start: GCC 12's leak checker can crash at exit ("Tracer caught signal 11") where a
# library that was loaded late has variables of its own in each thread.
if(GNOMON_SANITIZE)
  target_link_options(gnomon_scene INTERFACE -Wl,--push-state,--no-as-needed $<TARGET_FILE:gnomon_images> -Wl,--pop-state)
endif()
