# Compiles through ccache where it is installed. Paths below the checkout are hashed as relative ones, so that two
# checkouts of the same sources share what the cache holds.
find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  foreach(language C CXX)
    set(CMAKE_${language}_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env "CCACHE_BASEDIR=${PROJECT_SOURCE_DIR}"
      CCACHE_NOHASHDIR=true "${CCACHE_PROGRAM}")
  endforeach()
endif()
