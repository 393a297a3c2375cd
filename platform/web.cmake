# The program for pages and for Node (preset web), by emscripten: what Linux has and a page has not is left out or has a file of
# its own in web/. docs/platforms.md says what the program can do there.
set(GNOMON_READ_ONLY_DATA ".rodata,\"\",@")
set(GNOMON_TEXT_OPTIMIZATION -Oz)
set(GNOMON_STACK_NOTE)
set(platform "${PROJECT_SOURCE_DIR}/platform/web")
set(GNOMON_SCENE_PLATFORM "${platform}/one_thread.cpp" "${platform}/outside.cpp" "${platform}/images.cpp")
set(GNOMON_RASTER_PLATFORM)
set(GNOMON_LAB_PLATFORM "${platform}/turns.cpp")
# A page and Node have no windows, no other programs and none of the machine's own hardware; all that they have is one program.
set(GNOMON_COMMANDS_LEFT_OUT check diff merge shimmer sweep)
set(GNOMON_MAIN_ROOMS gnomon::lab)
set(GNOMON_PROGRAM_ROOMS gnomon_judge_commands gnomon_studies_commands gnomon::lab)
set(GNOMON_PROGRAM_PLATFORM "${platform}/main.cpp" "${platform}/lab.cpp")
set(GNOMON_PROGRAM_PROPERTIES SUFFIX .mjs)
set(GNOMON_RASTER_LIBRARIES web_gl)
set(GNOMON_SORTING)
foreach(script gnomon.js gnomon_worker.mjs)
  configure_file("${platform}/${script}" "${PROJECT_BINARY_DIR}/app/${script}" COPYONLY)
endforeach()
file(WRITE "${PROJECT_BINARY_DIR}/app/package.json" "{ \"type\": \"module\" }\n")

# One thread, of vectors of 128 bits; errors are WebAssembly's own exceptions.
set(flags -msimd128 -fwasm-exceptions)
add_compile_options(${flags} "$<$<COMPILE_LANGUAGE:CXX>:-fexperimental-library>")
# A module whose callMain(words) runs a command line over files in memory (FS), in a page, a worker or Node.
add_link_options(${flags} -sMODULARIZE -sEXPORT_ES6 -sEXPORT_NAME=gnomon -sINVOKE_RUN=0 -sEXIT_RUNTIME=0
  -sEXPORTED_RUNTIME_METHODS=callMain,ccall,FS,HEAPU8,NODEFS -sEXPORTED_FUNCTIONS=_main,_malloc,_free -lnodefs.js -sFORCE_FILESYSTEM -sENVIRONMENT=web,worker,node
  -sMIN_WEBGL_VERSION=2 -sMAX_WEBGL_VERSION=2
  -sALLOW_MEMORY_GROWTH -sMAXIMUM_MEMORY=4GB -sINITIAL_MEMORY=64MB -sSTACK_SIZE=8MB)
add_compile_definitions(HWY_COMPILE_ONLY_STATIC FMT_HEADER_ONLY)
include_directories(BEFORE SYSTEM "${platform}/include")

# Libraries of headers alone: those of the toolchain's release.
set(headers "${GNOMON_WEB_FOLDER}/root/usr/include")
file(MAKE_DIRECTORY "${PROJECT_BINARY_DIR}/web/headers")
foreach(library CLI fast_float fmt glm hwy nlohmann tl)
  file(CREATE_LINK "${headers}/${library}" "${PROJECT_BINARY_DIR}/web/headers/${library}" SYMBOLIC)
endforeach()
foreach(library CLI11::CLI11 fmt::fmt glm::glm hwy::hwy nlohmann_json::nlohmann_json tl::expected)
  add_library(${library} INTERFACE IMPORTED GLOBAL)
  target_include_directories(${library} SYSTEM INTERFACE "${PROJECT_BINARY_DIR}/web/headers")
endforeach()

include("${platform}/libraries.cmake")
set(TURBOJPEG_LIBRARY web_jpeg)
set(NETTLE_LIBRARY nettle)
set(GNOMON_SCENE_LIBRARIES web_meshoptimizer)
set(GNOMON_EXACT_INTEGERS mini_gmp)

# OpenGL over WebGL 2. Not compiled with raster/, whose OpenGL headers declare the same names otherwise.
add_library(web_gl STATIC "${platform}/webgl/calls.cpp" "${platform}/webgl/context.cpp" "${platform}/webgl/fallbacks.cpp" "${platform}/webgl/glsl.cpp" "${platform}/webgl/objects.cpp" "${platform}/webgl/programs.cpp"
  "${platform}/webgl/read_back.cpp")
target_link_libraries(web_gl PRIVATE gnomon_flags gnomon_warnings fmt::fmt glm::glm tl::expected)
