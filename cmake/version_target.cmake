# softgrip_version_file: a target that updates version.cpp in each build. version.cpp belongs to the room base.
set(version_file ${CMAKE_BINARY_DIR}/version.cpp)
add_custom_target(softgrip_version_file BYPRODUCTS ${version_file}
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DVERSION=${PROJECT_VERSION}
    -DINPUT=${PROJECT_SOURCE_DIR}/base/version.cpp.in -DOUTPUT=${version_file}
    -P ${PROJECT_SOURCE_DIR}/cmake/version.cmake
  VERBATIM)
