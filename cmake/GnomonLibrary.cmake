# cmake --install BUILD --component development [--prefix P]: the rooms as static libraries with their headers, for other
# programs: find_package(gnomon), then gnomon::compare and the like (docs/library.md). No part of what a plain install puts
# in place, nor of the Debian package.
set(rooms scene shaders raster raytrace rays hybrid compare report functions studies judge grade)
set(package "${CMAKE_INSTALL_LIBDIR}/cmake/gnomon")
foreach(room ${rooms})
  set_target_properties(gnomon_${room} PROPERTIES EXPORT_NAME ${room})
  list(APPEND room_targets gnomon_${room})
endforeach()
install(TARGETS gnomon_flags libdeflate ${room_targets} EXPORT gnomon
  ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT development EXCLUDE_FROM_ALL)
install(EXPORT gnomon NAMESPACE gnomon:: FILE gnomonTargets.cmake DESTINATION "${package}" COMPONENT development EXCLUDE_FROM_ALL)
foreach(room ${rooms})
  install(DIRECTORY "${PROJECT_SOURCE_DIR}/${room}" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/gnomon"
    COMPONENT development EXCLUDE_FROM_ALL FILES_MATCHING PATTERN "*.h" PATTERN "page" EXCLUDE)
endforeach()
# Image files are read by a module, which a program looks for in ../lib/gnomon beside its own folder.
install(TARGETS gnomon_images LIBRARY DESTINATION lib/gnomon COMPONENT development EXCLUDE_FROM_ALL)

include(CMakePackageConfigHelpers)
configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/gnomonConfig.cmake.in" "${PROJECT_BINARY_DIR}/gnomonConfig.cmake"
  INSTALL_DESTINATION "${package}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/gnomonConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/gnomonConfig.cmake" "${PROJECT_BINARY_DIR}/gnomonConfigVersion.cmake"
  DESTINATION "${package}" COMPONENT development EXCLUDE_FROM_ALL)
