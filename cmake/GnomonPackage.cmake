# cpack --config BUILD/CPackConfig.cmake: gnomon_VERSION_ARCH.deb with what cmake --install puts in place. Needs dpkg-dev,
# whose dpkg-shlibdeps finds the libraries that the program is linked with; OpenGL is opened at run time and named here.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME gnomon)
set(CPACK_PACKAGE_VERSION "${PROJECT_VERSION}")
set(CPACK_PACKAGE_CONTACT "The developers of Gnomon")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "shadow maps against exact shadows, pixel by pixel")
set(CPACK_PACKAGE_DESCRIPTION
  "Gnomon renders a scene with shadow maps and with rays, says for every pixel where\n the two shadows differ and why, and what the accuracy costs in time.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libosmesa6 | libegl1, libgl1-mesa-dri")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "assimp-utils")
include(CPack)
