# The program for Linux: every library that it is built from, all of them Debian packages (the list is in ./gnomon), and the
# files of each room that another platform has others for (web.cmake).
set(GNOMON_READ_ONLY_DATA ".rodata")  # the section of embedded files
set(GNOMON_TEXT_OPTIMIZATION -Og)  # of sources that read and write text (GnomonTarget.cmake)
set(GNOMON_STACK_NOTE "    .section .note.GNU-stack,\"\",@progbits\n")  # of assembler files: no stack that can be executed
set(GNOMON_SCENE_PLATFORM
  base/confine.cpp base/interruptible.cpp base/parallel.cpp base/run_apart.cpp base/run_program.cpp base/sort_keys.cpp base/start_threads.cpp base/terminal.cpp
  files/gltf/gltf_draco.cpp
  files/pictures/image_library.cpp)
set(GNOMON_RASTER_PLATFORM gl/context.cpp gl/context_egl.cpp gl/context_osmesa.cpp gl/dynamic_library.cpp)
set(GNOMON_LAB_PLATFORM view/work/job.cpp view/work/priority.cpp view/work/turns.cpp)
set(GNOMON_PROGRAM_PLATFORM main.cpp process/stack.cpp process/thread_start.cpp process/out_of_memory.cpp)

find_package(glm REQUIRED)
find_package(tl-expected REQUIRED)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(OpenImageIO REQUIRED)
find_package(draco REQUIRED)
find_package(meshoptimizer REQUIRED)
find_package(TBB REQUIRED)
find_package(CLI11 REQUIRED)
find_package(hwy REQUIRED)
find_package(glfw3 REQUIRED)
find_package(Threads REQUIRED)
find_package(PNG REQUIRED)
find_package(LibArchive REQUIRED)  # gnomon grade alone

# Dear ImGui, for the window alone; its library has the GLFW and OpenGL 3 backends in it. It has no CMake file.
find_package(PkgConfig REQUIRED)
pkg_check_modules(IMGUI REQUIRED imgui)

# toml++, for `gnomon check` alone, and Boost.Beast, for `gnomon serve` alone: headers, and nothing to link.
find_path(TOML_HEADERS toml++/toml.h REQUIRED)
find_path(BEAST_HEADERS boost/beast/http.hpp REQUIRED)

# libdeflate 1.14, Debian 12's, has no CMake file.
find_library(LIBDEFLATE_LIBRARY deflate REQUIRED)
find_path(LIBDEFLATE_HEADERS libdeflate.h REQUIRED)
add_library(libdeflate INTERFACE)
target_link_libraries(libdeflate INTERFACE ${LIBDEFLATE_LIBRARY})
target_include_directories(libdeflate SYSTEM INTERFACE ${LIBDEFLATE_HEADERS})

# TurboJPEG, for JPEG files; where its CMake file is, it names another package's files.
find_library(TURBOJPEG_LIBRARY turbojpeg REQUIRED)

# Nettle, for SHA-256 by what the processor has for it; it has no CMake file.
find_library(NETTLE_LIBRARY nettle REQUIRED)

# Debian's package of md4c's HTML writer has no CMake file.
find_library(MD4C_HTML_LIBRARY md4c-html REQUIRED)
find_path(MD4C_HTML_HEADERS md4c-html.h REQUIRED)
add_library(md4c_html INTERFACE)
target_link_libraries(md4c_html INTERFACE ${MD4C_HTML_LIBRARY})
target_include_directories(md4c_html SYSTEM INTERFACE ${MD4C_HTML_HEADERS})

# Debian's OpenImageIO exports OpenCV's header folder, which its headers that we use do not need; CMake refuses to
# generate when an exported folder does not exist.
foreach(property INTERFACE_INCLUDE_DIRECTORIES INTERFACE_SYSTEM_INCLUDE_DIRECTORIES)
  get_target_property(folders OpenImageIO::OpenImageIO ${property})
  set(present "")
  foreach(folder IN LISTS folders)
    if(EXISTS "${folder}")
      list(APPEND present "${folder}")
    endif()
  endforeach()
  set_target_properties(OpenImageIO::OpenImageIO PROPERTIES ${property} "${present}")
endforeach()

# The headers of Draco and meshoptimizer lie where the compiler looks.
set(GNOMON_SCENE_LIBRARIES TBB::tbb ${CMAKE_DL_LIBS} $<LINK_ONLY:draco::draco> $<LINK_ONLY:meshoptimizer::meshoptimizer>)
set(GNOMON_RASTER_LIBRARIES ${CMAKE_DL_LIBS})
set(GNOMON_EXACT_INTEGERS gmpxx gmp)
set(GNOMON_SORTING hwy::hwy_contrib)
