# cmake --install BUILD [--prefix P]: the program, its licence, the manual, lessons, pictures and schemas, and what the
# program prints of itself: chapters of the manual, its manual page, completion for bash, zsh and fish.
# Beside it gnomon_program() installs the others: a program starts them from its own folder.
install(TARGETS gnomon_program RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
# Where scene/files/pictures/image_library.cpp looks for it from the folder of the program.
install(TARGETS gnomon_images LIBRARY DESTINATION lib/gnomon)
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" "${PROJECT_SOURCE_DIR}/README.md" "${PROJECT_SOURCE_DIR}/CHANGELOG.md" "${PROJECT_SOURCE_DIR}/CITATION.cff" DESTINATION "${CMAKE_INSTALL_DOCDIR}")
# The manual, lessons and pictures, with the folders that their links name; the schemas; the shaders as examples.
install(DIRECTORY "${PROJECT_SOURCE_DIR}/docs/manual" "${PROJECT_SOURCE_DIR}/docs/lessons" "${PROJECT_SOURCE_DIR}/docs/images" DESTINATION "${CMAKE_INSTALL_DOCDIR}/docs")
file(GLOB documents CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/docs/*.md")
install(FILES ${documents} DESTINATION "${CMAKE_INSTALL_DOCDIR}/docs")
install(FILES "${PROJECT_SOURCE_DIR}/scene/files/scene.schema.json" "${PROJECT_SOURCE_DIR}/app/outputs/render.schema.json"
  "${PROJECT_SOURCE_DIR}/functions/answers.schema.json" "${PROJECT_SOURCE_DIR}/grade/rubric.schema.json" "${PROJECT_SOURCE_DIR}/grade/grade.schema.json"
  "${PROJECT_SOURCE_DIR}/judge/capture.schema.json" "${PROJECT_SOURCE_DIR}/studies/shimmer/shimmer.schema.json"
  DESTINATION "${CMAKE_INSTALL_DATADIR}/gnomon/schema")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/shaders" DESTINATION "${CMAKE_INSTALL_DOCDIR}/examples" FILES_MATCHING PATTERN "*.glsl" PATTERN "*.frag" PATTERN "*.vert" PATTERN "*.h")
# What judge starts for a frame that RenderDoc recorded: where judge/recorded_frame.cpp looks from the folder of the program.
install(DIRECTORY "${PROJECT_SOURCE_DIR}/adapters/renderdoc" DESTINATION share/gnomon FILES_MATCHING PATTERN "*.py" PATTERN "*.js" PATTERN "*.json" PATTERN "__pycache__" EXCLUDE)

# gnomon_install_printed(OPTION FOLDER FILE): what the program prints for OPTION; FOLDER is below the prefix.
function(gnomon_install_printed option folder file)
  install(CODE "
    set(folder \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${folder}\")
    file(MAKE_DIRECTORY \"\${folder}\")
    execute_process(COMMAND \"$<TARGET_FILE:gnomon_program>\" ${option}
      OUTPUT_FILE \"\${folder}/${file}\" COMMAND_ERROR_IS_FATAL ANY)
    message(STATUS \"Installing: \${folder}/${file}\")")
endfunction()
foreach(chapter options json techniques)
  gnomon_install_printed("--manual ${chapter}" "${CMAKE_INSTALL_DOCDIR}/docs/manual" ${chapter}.md)
endforeach()
gnomon_install_printed("--man-page" "${CMAKE_INSTALL_DATADIR}/man/man1" gnomon.1)
gnomon_install_printed("--manual schema" "${CMAKE_INSTALL_DATADIR}/gnomon/schema" result.schema.json)
gnomon_install_printed("--completion bash" "${CMAKE_INSTALL_DATADIR}/bash-completion/completions" gnomon)
gnomon_install_printed("--completion zsh" "${CMAKE_INSTALL_DATADIR}/zsh/site-functions" _gnomon)
gnomon_install_printed("--completion fish" "${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d" gnomon.fish)
