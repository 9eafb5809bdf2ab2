# Builds the extension module of the Python package if pybind11 and the headers of the system's Python are installed.
# The folder python/softgrip of the build contains the module and links to the other files of the package. To use it,
# set PYTHONPATH=BUILD/python. The system's Python is built without sanitizers, so a test with AddressSanitizer preloads
# the library of AddressSanitizer (tests/python/CMakeLists.txt).
if(SOFTGRIP_SANITIZE AND (NOT SOFTGRIP_SANITIZE MATCHES "address" OR SOFTGRIP_FUZZERS))
  return()
endif()
if(EXISTS /usr/bin/python3)  # another python3 that is earlier in PATH would have different headers
  set(Python_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "Python of the extension module")
endif()
find_package(Python 3.9 COMPONENTS Interpreter Development.Module)
set(PYBIND11_FINDPYTHON ON)
find_package(pybind11 2.10 CONFIG)
if(NOT Python_Development.Module_FOUND OR NOT pybind11_FOUND)
  message(STATUS "pybind11 is missing: no Python functions on arrays")
  return()
endif()
file(GLOB core_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/python/core/*.cpp)
add_library(softgrip_python MODULE ${core_sources})
target_link_libraries(softgrip_python PRIVATE softgrip_flags softgrip::softgrip pybind11::module)
pybind11_extension(softgrip_python)
set(python_folder ${CMAKE_BINARY_DIR}/python/softgrip)
set_target_properties(softgrip_python PROPERTIES OUTPUT_NAME _core CXX_VISIBILITY_PRESET hidden
  VISIBILITY_INLINES_HIDDEN ON LIBRARY_OUTPUT_DIRECTORY ${python_folder})
file(MAKE_DIRECTORY ${python_folder})
file(GLOB package_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/python/softgrip/*)
foreach(file IN LISTS package_files)
  get_filename_component(name ${file} NAME)
  if(NOT IS_DIRECTORY ${file})
    file(CREATE_LINK ${file} ${python_folder}/${name} SYMBOLIC)
  endif()
endforeach()
install(TARGETS softgrip_python LIBRARY DESTINATION lib/python3/dist-packages/softgrip COMPONENT python)
