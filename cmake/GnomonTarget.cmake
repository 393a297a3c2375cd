# gnomon_library(NAME SOURCES... [DEPENDS targets...] [PRIVATE_DEPENDS targets...])
# One static library per room, with the project's warnings and numeric flags; alias gnomon::NAME.

add_library(gnomon_flags INTERFACE)
target_compile_features(gnomon_flags INTERFACE cxx_std_20)
target_include_directories(gnomon_flags INTERFACE "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>" "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/gnomon>")
# Contraction to FMA makes a watertight triangle test leak (see raytrace/shapes/intersect.h).
target_compile_options(gnomon_flags INTERFACE -ffp-contract=off)
target_compile_definitions(gnomon_flags INTERFACE GLM_FORCE_EXPLICIT_CTOR GLM_FORCE_SILENT_WARNINGS)

add_library(gnomon_warnings INTERFACE)
target_compile_options(gnomon_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow
  -Wnon-virtual-dtor -Wcast-align -Woverloaded-virtual -Wnull-dereference
  $<$<BOOL:${GNOMON_WARNINGS_AS_ERRORS}>:-Werror>
  # GCC 12 reports false null dereferences inside libstdc++ and glm when it inlines at -O3.
  $<$<CXX_COMPILER_ID:GNU>:-Wno-null-dereference>
  # GCC 13 and 14 take the other alternatives of a std::variant for uninitialised members; GCC 12 and clang look.
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_GREATER_EQUAL:$<CXX_COMPILER_VERSION>,13>>:-Wno-maybe-uninitialized>)

if(GNOMON_SANITIZE)
  target_compile_options(gnomon_flags INTERFACE -fsanitize=address,undefined -fno-omit-frame-pointer
    -fno-sanitize-recover=undefined)
  target_link_options(gnomon_flags INTERFACE -fsanitize=address,undefined)
endif()

# Coverage counters that libFuzzer reads (tests/fuzz_tests.cmake), and the sanitizers that tell it of a fault.
if(GNOMON_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID MATCHES Clang)
    message(FATAL_ERROR "GNOMON_FUZZ: libFuzzer is a part of clang (got ${CMAKE_CXX_COMPILER_ID})")
  endif()
  target_compile_options(gnomon_flags INTERFACE -fsanitize=fuzzer-no-link,address,undefined
    -fno-sanitize-recover=undefined)
  target_link_options(gnomon_flags INTERFACE -fsanitize=address,undefined)
endif()

function(gnomon_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  add_library(gnomon_${name} STATIC ${ARG_SOURCES})
  add_library(gnomon::${name} ALIAS gnomon_${name})
  target_link_libraries(gnomon_${name} PUBLIC gnomon_flags ${ARG_DEPENDS}
    PRIVATE $<BUILD_INTERFACE:gnomon_warnings> ${ARG_PRIVATE_DEPENDS})
endfunction()
