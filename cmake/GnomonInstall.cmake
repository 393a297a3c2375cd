# cmake --install BUILD [--prefix P]: the program, its licence, and what the program prints of itself: its manual page,
# completion for bash, zsh and fish.
install(TARGETS gnomon_program RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
# Where scene/files/image_library.cpp looks for it from the folder of the program.
install(TARGETS gnomon_images LIBRARY DESTINATION lib/gnomon)
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" "${PROJECT_SOURCE_DIR}/README.md" DESTINATION "${CMAKE_INSTALL_DOCDIR}")

# gnomon_install_printed(OPTION FOLDER FILE): what the program prints for OPTION; FOLDER is below the data folder (share).
function(gnomon_install_printed option folder file)
  install(CODE "
    set(folder \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/${folder}\")
    file(MAKE_DIRECTORY \"\${folder}\")
    execute_process(COMMAND \"$<TARGET_FILE:gnomon_program>\" ${option}
      OUTPUT_FILE \"\${folder}/${file}\" COMMAND_ERROR_IS_FATAL ANY)
    message(STATUS \"Installing: \${folder}/${file}\")")
endfunction()
gnomon_install_printed("--man-page" man/man1 gnomon.1)
gnomon_install_printed("--completion bash" bash-completion/completions gnomon)
gnomon_install_printed("--completion zsh" zsh/site-functions _gnomon)
gnomon_install_printed("--completion fish" fish/vendor_completions.d gnomon.fish)
