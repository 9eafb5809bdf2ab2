# Builds the Debian package with `cpack` in the build folder, or with scripts/package.sh. The package installs the
# programs to /usr, regardless of the prefix of the build. The configuration is always in /etc/softgrip.
set(packaging ${PROJECT_SOURCE_DIR}/packaging)
set(packaged ${CMAKE_CURRENT_BINARY_DIR}/packaging)

# The units and rules contain the full paths of programs. These paths are not known before the installation, so CMake
# configures the files at installation time.
install(CODE "set(CMAKE_INSTALL_FULL_BINDIR \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_BINDIR}\")
set(SOFTGRIP_CONFIGURATION \"${SOFTGRIP_CONFIGURATION}\")
foreach(unit IN ITEMS softgripd softgrip-plc softgrip-web softgrip-health)
  configure_file(\"${PROJECT_SOURCE_DIR}/systemd/\${unit}.service.in\" \"${packaged}/\${unit}.service\" @ONLY)
  file(INSTALL \"${packaged}/\${unit}.service\" DESTINATION \"\${CMAKE_INSTALL_PREFIX}/lib/systemd/system\")
endforeach()
configure_file(\"${PROJECT_SOURCE_DIR}/systemd/softgrip.rules.in\" \"${packaged}/70-softgrip.rules\" @ONLY)
file(INSTALL \"${packaged}/70-softgrip.rules\" DESTINATION \"\${CMAKE_INSTALL_PREFIX}/lib/udev/rules.d\")")
install(FILES systemd/softgrip-health.timer DESTINATION lib/systemd/system)
install(FILES systemd/softgrip.sysusers DESTINATION lib/sysusers.d RENAME softgrip.conf)
install(FILES systemd/softgrip.tmpfiles DESTINATION lib/tmpfiles.d RENAME softgrip.conf)

# Builds the man pages if pandoc is installed.
find_program(SOFTGRIP_PANDOC pandoc)
string(TIMESTAMP man_date "%Y-%m-%d" UTC)
set(man_pages "")
# man_page(NAME SECTION SUMMARY [PROGRAM] REFERENCE.md)  builds and installs one man page
function(man_page name section summary)
  set(page ${packaged}/man/${name}.${section}.gz)
  set(reference ${ARGV})
  list(GET reference -1 reference)
  if(ARGC GREATER 4)
    set(program $<TARGET_FILE:${ARGV3}>)
  endif()
  add_custom_command(OUTPUT ${page}
    COMMAND bash ${packaging}/man/page.sh ${PROJECT_VERSION} ${man_date} ${page} ${name} ${summary} ${program}
            ${PROJECT_SOURCE_DIR}/docs/${reference}
    DEPENDS ${packaging}/man/page.sh ${packaging}/man/help.awk ${packaging}/man/plain.lua
            ${PROJECT_SOURCE_DIR}/docs/${reference} ${program}
    VERBATIM)
  install(FILES ${page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man${section})
  list(APPEND man_pages ${page})
  set(man_pages ${man_pages} PARENT_SCOPE)
endfunction()
if(SOFTGRIP_PANDOC)
  file(MAKE_DIRECTORY ${packaged}/man)
  man_page(softgripd 8 "controller daemon of soft pneumatic grippers" softgripd explanation/real-time.md)
  man_page(softgrip 1 "command line of the soft gripper controller" softgrip reference/commands.md)
  man_page(softgrip-rig 1 "emulator of board, valves, fingers and object" softgrip-rig reference/emulator.md)
  man_page(softgrip-plc 8 "soft grippers for PLCs, on Modbus TCP" softgrip-plc reference/plc-map.md)
  man_page(softgrip-web 8 "page for operators and metrics of soft grippers" softgrip-web how-to/operator-page.md)
  man_page(softgrip-rig-file 5 "description of a rig for softgripd" reference/rig-file.md)
  man_page(softgrip-sequence-file 5 "grip sequences, step by step" reference/sequence-file.md)
  add_custom_target(man_pages ALL DEPENDS ${man_pages})
else()
  message(STATUS "pandoc is missing: no man pages")
endif()

# The completion scripts of the shells. The program softgrip writes them.
set(completions "")
# completion(SHELL FILE FOLDER)  writes the completion script for one shell to FILE and installs it in FOLDER
function(completion shell file folder)
  set(script ${packaged}/completion/${file})
  add_custom_command(OUTPUT ${script}
    COMMAND softgrip completion ${shell} > ${script}
    DEPENDS softgrip
    VERBATIM)
  install(FILES ${script} DESTINATION ${CMAKE_INSTALL_DATADIR}/${folder})
  set(completions ${completions} ${script} PARENT_SCOPE)
endfunction()
file(MAKE_DIRECTORY ${packaged}/completion)
completion(bash softgrip bash-completion/completions)
completion(zsh _softgrip zsh/vendor-completions)
completion(fish softgrip.fish fish/vendor_completions.d)
add_custom_target(completions ALL DEPENDS ${completions})

# Files that a Debian package must contain: changelog, copyright, and the overrides for lintian.
set(SOFTGRIP_PACKAGE_RELEASE 1 CACHE STRING "Debian revision of the package")
string(TIMESTAMP SOFTGRIP_PACKAGE_DATE "%a, %d %b %Y %H:%M:%S +0000" UTC)
configure_file(${packaging}/deb/changelog.in ${packaged}/changelog.Debian @ONLY)
execute_process(COMMAND gzip -9nkf ${packaged}/changelog.Debian)
install(FILES ${packaged}/changelog.Debian.gz DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES ${packaging}/deb/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES ${packaging}/deb/lintian-overrides DESTINATION share/lintian/overrides RENAME softgrip)

# Mark all files in /etc as configuration files, so that an upgrade keeps the changes of the user.
file(GLOB_RECURSE conffiles CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/config ${PROJECT_SOURCE_DIR}/config/*)
list(TRANSFORM conffiles PREPEND ${SOFTGRIP_CONFIGURATION}/)
list(JOIN conffiles "\n" conffiles)
file(WRITE ${packaged}/conffiles "${conffiles}\n")

set(CPACK_GENERATOR DEB)
set(CPACK_SET_DESTDIR ON)
set(CPACK_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
    WORLD_READ WORLD_EXECUTE)
set(CPACK_PACKAGE_NAME softgrip)
set(CPACK_PACKAGE_CONTACT "The softgrip developers <developers@softgrip.example>")
set(CPACK_DEB_COMPONENT_INSTALL OFF)
# packaging/deb/library.sh builds the packages of the library. The package softgrip does not contain the library.
set(CPACK_INSTALL_CMAKE_PROJECTS "${CMAKE_BINARY_DIR};softgrip;Unspecified;/")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE ${SOFTGRIP_PACKAGE_RELEASE})
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "systemd, udev")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "linux-image-rt-amd64 | linux-image-rt-arm64, libjs-chart.js")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA
    "${packaging}/deb/postinst;${packaging}/deb/prerm;${packaging}/deb/postrm;${packaged}/conffiles")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "controller of soft pneumatic grippers")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"softgripd reads displacement sensors and drives proportional pressure valves
through Modbus or analog boards at a fixed rate: model-based feedforward with
hysteresis and creep, feedback, grip sequences with an answer to every grip.

softgrip talks to it, and at the desk identifies models from recordings and
finds out what a model gets wrong. softgrip-rig stands in for the board, the
valves and the fingers.")
include(CPack)
