# gnomon_library(NAME SOURCES... [DEPENDS targets...] [PRIVATE_DEPENDS targets...])
# One static library per room, with the project's warnings and numeric flags; alias gnomon::NAME.

add_library(gnomon_flags INTERFACE)
target_compile_features(gnomon_flags INTERFACE cxx_std_20)
target_include_directories(gnomon_flags INTERFACE "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>" "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/gnomon>")
# Contraction to FMA makes a watertight triangle test leak (see raytrace/shapes/intersect.h). Where GCC 12 joins neighbouring
# scalars to vectors (-O2 and above), it leaves doubles as they are that should become floats and then doubles again
# (tests/scene/core_rounding_test.cpp): Vec3(Vec3f(v)) has float's digits in z alone.
target_compile_options(gnomon_flags INTERFACE -ffp-contract=off -fno-tree-slp-vectorize)
target_compile_definitions(gnomon_flags INTERFACE GLM_FORCE_EXPLICIT_CTOR GLM_FORCE_SILENT_WARNINGS)

# A definition for targets with files that Highway compiles once per instruction set: for AVX-512, AVX2, SSE4 and a baseline,
# which is one number at a time.
# Without GNOMON_ALL_VECTORS it is compiled for this machine's and the baseline, which is a quarter of the whole time less:
# another machine, if it ever runs that, falls back to the baseline.
set(GNOMON_INSTRUCTION_SETS HWY_DISABLED_TARGETS=HWY_SSSE3)
if(NOT GNOMON_ALL_VECTORS AND CMAKE_SYSTEM_PROCESSOR STREQUAL x86_64)
  execute_process(COMMAND "${CMAKE_CXX_COMPILER}" -march=native -dM -E -x c++ /dev/null OUTPUT_VARIABLE macros ERROR_QUIET)
  if(macros MATCHES "__AVX512F__" AND macros MATCHES "__AVX512VL__" AND macros MATCHES "__AVX512BW__" AND macros MATCHES "__AVX512DQ__")
    set(GNOMON_INSTRUCTION_SETS "HWY_DISABLED_TARGETS=(HWY_SSSE3|HWY_SSE4|HWY_AVX2)")
  elseif(macros MATCHES "__AVX2__" AND macros MATCHES "__FMA__" AND macros MATCHES "__BMI2__" AND macros MATCHES "__F16C__")
    set(GNOMON_INSTRUCTION_SETS "HWY_DISABLED_TARGETS=(HWY_SSSE3|HWY_SSE4|HWY_AVX3)")
  endif()
endif()
if(CMAKE_SYSTEM_PROCESSOR STREQUAL aarch64)  # NEON alone, without a choice: SVE's vectors cannot stand in arrays
  set(GNOMON_INSTRUCTION_SETS TOOLCHAIN_MISS_SYS_AUXV_H)
endif()

add_library(gnomon_warnings INTERFACE)
target_compile_options(gnomon_warnings INTERFACE -Wall -Wextra -Wpedantic
  # Of files compiled together one's constant would be shadowed by another's variable; the other presets look for shadows.
  $<$<NOT:$<BOOL:$<TARGET_PROPERTY:UNITY_BUILD>>>:-Wshadow>
  -Wnon-virtual-dtor -Wcast-align -Woverloaded-virtual -Wnull-dereference
  $<$<BOOL:${GNOMON_WARNINGS_AS_ERRORS}>:-Werror>
  # GCC 12 reports false null dereferences inside libstdc++ and glm when it inlines at -O3.
  $<$<CXX_COMPILER_ID:GNU>:-Wno-null-dereference>
  # GCC 13 and 14 take the other alternatives of a std::variant for uninitialised members; GCC 12 and clang look.
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_GREATER_EQUAL:$<CXX_COMPILER_VERSION>,13>>:-Wno-maybe-uninitialized>)

if(GNOMON_SANITIZE)
  target_compile_options(gnomon_flags INTERFACE -fsanitize=${GNOMON_SANITIZE} -fno-omit-frame-pointer
    -fno-sanitize-recover=undefined)
  target_link_options(gnomon_flags INTERFACE -fsanitize=${GNOMON_SANITIZE})
endif()

# Coverage counters that libFuzzer reads (tests/fuzz/tests.cmake), and the sanitizers that tell it of a fault.
if(GNOMON_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID MATCHES Clang)
    message(FATAL_ERROR "GNOMON_FUZZ: libFuzzer is a part of clang (got ${CMAKE_CXX_COMPILER_ID})")
  endif()
  target_compile_options(gnomon_flags INTERFACE -fsanitize=fuzzer-no-link,address,undefined
    -fno-sanitize-recover=undefined)
  target_link_options(gnomon_flags INTERFACE -fsanitize=address,undefined)
endif()

# What nearly every file includes is parsed once, where files are compiled together; and with it, for sources that are text,
# JSON. A precompiled header holds for the flags that it was made with. Without GNOMON_UNITY each file is compiled with what it
# includes itself.
function(gnomon_headers name)
  file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/${name}.cpp" CONTENT "// Generated: what ${name} is made with.\n")
  add_library(${name} OBJECT "${PROJECT_BINARY_DIR}/${name}.cpp")
  target_link_libraries(${name} PRIVATE gnomon_flags gnomon_warnings fmt::fmt glm::glm tl::expected nlohmann_json::nlohmann_json)
  target_precompile_headers(${name} PRIVATE <algorithm> <array> <cmath> <functional> <memory> <optional> <span> <string> <string_view>
    <vector> <glm/glm.hpp> <tl/expected.hpp> <fmt/core.h> ${ARGN})
  target_compile_options(${name} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)  # tells ccache which one was read
endfunction()

# gnomon_use_headers(TARGET): those of gnomon_headers that suit it.
function(gnomon_use_headers target)
  if(NOT GNOMON_UNITY OR NOT GNOMON_PLATFORM STREQUAL native)
    return()
  endif()
  foreach(name gnomon_common_headers gnomon_text_headers)
    if(NOT TARGET ${name})
      if(name STREQUAL gnomon_text_headers)
        gnomon_headers(${name} <nlohmann/json.hpp>)
        gnomon_compile_for_text(${name})
      else()
        gnomon_headers(${name})
      endif()
    endif()
  endforeach()
  get_target_property(is_text ${target} GNOMON_TEXT)
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:fmt::fmt>)
  if(is_text)
    target_precompile_headers(${target} REUSE_FROM gnomon_text_headers)
  else()
    target_precompile_headers(${target} REUSE_FROM gnomon_common_headers)
  endif()
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
endfunction()

function(gnomon_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  add_library(gnomon_${name} STATIC ${ARG_SOURCES})
  add_library(gnomon::${name} ALIAS gnomon_${name})
  target_link_libraries(gnomon_${name} PUBLIC gnomon_flags ${ARG_DEPENDS}
    PRIVATE $<BUILD_INTERFACE:gnomon_warnings> ${ARG_PRIVATE_DEPENDS})
endfunction()

# gnomon_compile_for_text(TARGET): for sources that read and write text: options, JSON, tables, pages. With -Og GCC takes half
# of the time that -O3 takes and three quarters of that of -O1, and what a user waits for is elsewhere; a page is downloaded, so
# there -Oz makes them small (GNOMON_TEXT_OPTIMIZATION). What goes over
# pixels, triangles or a model's data is no text.
function(gnomon_compile_for_text target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:${GNOMON_TEXT_OPTIMIZATION}>)
  set_target_properties(${target} PROPERTIES GNOMON_TEXT ON)
endfunction()

# gnomon_untimed(ROOM SOURCES... [LIBRARIES targets...]): the sources of a room that are text.
function(gnomon_untimed room)
  cmake_parse_arguments(ARG "" "" "LIBRARIES" ${ARGN})
  set(target gnomon_${room}_untimed)
  add_library(${target} OBJECT ${ARG_UNPARSED_ARGUMENTS})
  gnomon_compile_for_text(${target})
  target_include_directories(${target} PRIVATE $<TARGET_PROPERTY:gnomon_${room},INCLUDE_DIRECTORIES>)
  target_link_libraries(${target} PRIVATE gnomon_flags gnomon_warnings ${ARG_LIBRARIES})
  target_sources(gnomon_${room} PRIVATE $<TARGET_OBJECTS:${target}>)
  gnomon_compile_together(${target} 64)
endfunction()

# gnomon_compile_together(TARGET [MOST]), once all its sources are known: with GNOMON_UNITY (every preset but dev) the
# sources of a target are compiled together, up to MOST (36) at a time in the order they are listed in (CMake's unity
# builds), for most of what a file costs is its headers and the templates in them. So names in the unnamed namespaces of one
# target must differ. With -O3 GCC 12 inlines less in larger units: MOST is 64 where that does not matter.
# Files that Highway compiles once per instruction set include themselves and stand alone.
function(gnomon_compile_together target)
  set(most 36)
  if(ARGC GREATER 1)
    set(most ${ARGV1})
  endif()
  if(NOT GNOMON_UNITY)
    return()
  endif()
  if(NOT target MATCHES "_test$")  # whose headers are tests_headers
    gnomon_use_headers(${target})
  endif()
  get_target_property(sources ${target} SOURCES)
  set(together)
  foreach(source IN LISTS sources)
    get_filename_component(path "${source}" ABSOLUTE)
    string(FIND "${path}" "${PROJECT_BINARY_DIR}/" generated)
    if(generated EQUAL 0 OR NOT path MATCHES "[.]cpp$")
      continue()
    endif()
    file(STRINGS "${path}" itself REGEX "define HWY_TARGET_INCLUDE" LIMIT_COUNT 1)
    if(NOT itself)
      list(APPEND together "${source}")
    endif()
  endforeach()
  list(LENGTH together count)
  math(EXPR parts "(${count} + ${most} - 1) / ${most}")
  set(number 0)
  foreach(source IN LISTS together)
    math(EXPR part "${number} * ${parts} / ${count}")
    math(EXPR number "${number} + 1")
    set_source_files_properties("${source}" PROPERTIES UNITY_GROUP "part_${part}")
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
