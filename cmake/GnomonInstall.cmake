# cmake --install BUILD [--prefix P]: the program, its licence, and completion for bash, zsh and fish, which the program
# prints itself.
install(TARGETS gnomon_program RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" "${PROJECT_SOURCE_DIR}/README.md" DESTINATION "${CMAKE_INSTALL_DOCDIR}")

# gnomon_install_completion(SHELL FOLDER FILE): FOLDER is below the data folder (share).
function(gnomon_install_completion shell folder file)
  install(CODE "
    set(folder \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/${folder}\")
    file(MAKE_DIRECTORY \"\${folder}\")
    execute_process(COMMAND \"$<TARGET_FILE:gnomon_program>\" --completion ${shell}
      OUTPUT_FILE \"\${folder}/${file}\" COMMAND_ERROR_IS_FATAL ANY)
    message(STATUS \"Installing: \${folder}/${file}\")")
endfunction()
gnomon_install_completion(bash bash-completion/completions gnomon)
gnomon_install_completion(zsh zsh/site-functions _gnomon)
gnomon_install_completion(fish fish/vendor_completions.d gnomon.fish)
