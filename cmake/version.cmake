# Run at build time: writes OUTPUT from INPUT with the version of the working tree as git names it, and only if it
# changed. Without git or outside a repository (a release's tarball) the project's version stands alone.
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --tags
  OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
set(SOFTGRIP_VERSION_TEXT "${VERSION}")
if(NOT failed AND NOT described STREQUAL "")
  string(APPEND SOFTGRIP_VERSION_TEXT "+${described}")
endif()
configure_file(${INPUT} ${OUTPUT} @ONLY)
