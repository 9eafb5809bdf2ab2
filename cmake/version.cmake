# Runs at build time. Writes OUTPUT from INPUT with the version that git reports for the working tree. Writes the file
# only if its content has changed. Without a git repository, for example in a release tarball, the version is that of
# the project.
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --tags
  OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
set(SOFTGRIP_VERSION_TEXT "${VERSION}")
if(NOT failed AND NOT described STREQUAL "")
  string(APPEND SOFTGRIP_VERSION_TEXT "+${described}")
endif()
configure_file(${INPUT} ${OUTPUT} @ONLY)
