# Builds the shared library libsoftgrip from the sources of the room `library`. Installs the public headers. Also
# installs the files with which CMake and pkg-config find the library.
add_library(libsoftgrip SHARED $<TARGET_OBJECTS:softgrip_library>)
target_link_libraries(libsoftgrip PRIVATE softgrip_library)
# scripts/abi.sh reads the types of the interface from the debug information. Precompiled headers would remove this
# information.
target_compile_options(softgrip_library PRIVATE $<$<CONFIG:RelWithDebInfo>:-g2>)
set_target_properties(softgrip_library PROPERTIES DISABLE_PRECOMPILE_HEADERS ON)
add_library(softgrip::softgrip ALIAS libsoftgrip)
target_compile_features(libsoftgrip INTERFACE cxx_std_20)
target_include_directories(libsoftgrip INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/library/include>
  $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
set_target_properties(libsoftgrip PROPERTIES OUTPUT_NAME softgrip EXPORT_NAME softgrip LINKER_LANGUAGE CXX
  VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR} LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/library)
# The library exports the functions that its headers mark. It does not export instances of standard templates.
set(exported ${PROJECT_SOURCE_DIR}/library/exported.map)
target_link_options(libsoftgrip PRIVATE -Wl,--version-script=${exported} -Wl,-z,relro,-z,now,--as-needed)
if(NOT SOFTGRIP_SANITIZE)  # with a sanitizer, the functions of the sanitizer are defined in the programs, not in the
                           # library
  target_link_options(libsoftgrip PRIVATE -Wl,--no-undefined)
endif()
set_property(TARGET libsoftgrip APPEND PROPERTY LINK_DEPENDS ${exported})

# The library can be installed alone (`cmake --install BUILD --component library`) or together with the
# programs.
include(CMakePackageConfigHelpers)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/softgrip)
file(GLOB public_headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/library/include/softgrip/*.h)
install(TARGETS libsoftgrip EXPORT softgrip
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT library)
install(FILES ${public_headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/softgrip COMPONENT library)
install(EXPORT softgrip NAMESPACE softgrip:: FILE softgrip-config.cmake DESTINATION ${package_folder} COMPONENT library)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/library/softgrip-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/library/softgrip-config-version.cmake DESTINATION ${package_folder} COMPONENT library)
# softgrip.pc contains a prefix relative to its own folder, so that the installed tree can be moved.
file(RELATIVE_PATH SOFTGRIP_PC_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(${PROJECT_SOURCE_DIR}/library/softgrip.pc.in ${CMAKE_BINARY_DIR}/library/softgrip.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/library/softgrip.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT library)
