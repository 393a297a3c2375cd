# The shadow lab in a browser: gnomon serve.
target_sources(gnomon_app PRIVATE serve/http_server.cpp serve/lab_server.cpp serve/serve.cpp)
set_source_files_properties(serve/http_server.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
