# Compiles through ccache where it is installed. Paths below the checkout are hashed as relative ones, so that two
# checkouts of the same sources share what the cache holds. Not where its own path has a space: ccache leaves such paths
# as they are in the lists of headers that it keeps, and another checkout would then look for its headers there.
find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  set(settings CCACHE_SLOPPINESS=pch_defines,time_macros)
  if(NOT PROJECT_SOURCE_DIR MATCHES " ")
    list(APPEND settings "CCACHE_BASEDIR=${PROJECT_SOURCE_DIR}" CCACHE_NOHASHDIR=true)
  endif()
  set(launcher "${CMAKE_COMMAND}" -E env ${settings} "${CCACHE_PROGRAM}")
  set(CMAKE_C_COMPILER_LAUNCHER ${launcher})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${launcher})
endif()
