# The shadow lab in a browser: gnomon serve.
target_sources(gnomon_app PRIVATE serve/lab_server.cpp serve/serve.cpp)
set_source_files_properties(serve/lab_server.cpp PROPERTIES COMPILE_OPTIONS "${HTTPLIB_CFLAGS_OTHER}" SKIP_UNITY_BUILD_INCLUSION ON)
target_link_libraries(gnomon_app PRIVATE ${HTTPLIB_LINK_LIBRARIES})
