# softgrip_room(FOLDER [FOLDERS more ...] [USES room ...] [LIBRARIES target ...] [PRECOMPILE header ...])
# Adds a room: a folder, a static library of all its .cpp files, and the rooms whose headers its files may include. A room
# without .cpp files is an interface library. The target of the room daemon/loop is softgrip_daemon_loop, and
# ${softgrip_room_target} is the target of the most recent room.
#
# The other measures only reduce the compile time and need SOFTGRIP_PRECOMPILE. PRECOMPILE names a header that most files
# of the room include and that takes most of their compile time. The files of a room are compiled as one file, because they
# use the same headers and templates. So the names in their unnamed namespaces must differ.
#
# The rooms in SOFTGRIP_LINKED_ROOMS are not compiled. The programs are linked with the libraries of these rooms in
# build/release.
set_property(GLOBAL PROPERTY softgrip_rooms "")
function(softgrip_room folder)
  cmake_parse_arguments(arg "" "" "FOLDERS;USES;LIBRARIES;PRECOMPILE" ${ARGN})
  softgrip_target_of(${folder} target)
  set(folders ${folder} ${arg_FOLDERS})
  set(sources "")
  set(headers "")
  set(reachable "")
  foreach(one IN LISTS folders)
    file(GLOB found CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${one}/*.cpp)
    list(APPEND sources ${found})
    file(GLOB found CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${one}/*.h)
    list(APPEND headers ${found})
  endforeach()
  list(FILTER sources EXCLUDE REGEX "/softgripd\\.cpp$")
  set(links softgrip_flags ${arg_LIBRARIES})
  get_property(rooms GLOBAL PROPERTY softgrip_rooms)
  foreach(used IN LISTS arg_USES)
    if(NOT used IN_LIST rooms)
      message(FATAL_ERROR "rooms.cmake: ${folder} uses ${used}, which does not stand above it")
    endif()
    softgrip_target_of(${used} used_target)
    list(APPEND links ${used_target})
    get_property(used_folders GLOBAL PROPERTY softgrip_folders_of_${used})
    list(APPEND reachable ${used_folders})
  endforeach()
  if(folder IN_LIST SOFTGRIP_LINKED_ROOMS)
    add_library(${target} STATIC IMPORTED GLOBAL)
    set_target_properties(${target} PROPERTIES IMPORTED_LOCATION ${PROJECT_SOURCE_DIR}/build/release/lib${target}.a)
    target_link_libraries(${target} INTERFACE ${links})
  elseif(sources)
    add_library(${target} STATIC ${sources})
    target_link_libraries(${target} PUBLIC ${links})
    softgrip_for_shared_library(${target})
    softgrip_arrows(${target} "${folders}" "${reachable}" ${sources} ${headers})
    softgrip_may_precompile(may)
    if(may)
      softgrip_precompile_for_rooms(${target} "${arg_PRECOMPILE}" "${arg_LIBRARIES}")
      softgrip_compile_together(${target})
    endif()
  else()
    add_library(${target} INTERFACE)
    target_link_libraries(${target} INTERFACE ${links})
  endif()
  set_property(GLOBAL APPEND PROPERTY softgrip_rooms ${folder})
  set_property(GLOBAL PROPERTY softgrip_folders_of_${folder} ${folders})
  set(softgrip_room_target ${target} PARENT_SCOPE)
endfunction()

# The shared library consists of the same object files as the programs. Names that the library does not export are
# hidden. Calls within the library are therefore direct, as in a program.
function(softgrip_for_shared_library target)
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden
    VISIBILITY_INLINES_HIDDEN ON)
  target_compile_options(${target} PRIVATE -fno-semantic-interposition)
endfunction()

# softgrip_public_headers(FOLDER)  adds FOLDER to the include paths of the most recent room, so that it finds
# the public headers as they are installed
function(softgrip_public_headers folder)
  target_include_directories(${softgrip_room_target} PUBLIC ${PROJECT_SOURCE_DIR}/${folder})
endfunction()

function(softgrip_target_of folder variable)
  string(REPLACE "/" "_" name "softgrip_${folder}")
  set(${variable} ${name} PARENT_SCOPE)
endfunction()

# Before a room is compiled, checks the includes of its files. A file may include only headers of rooms that its room
# may use.
function(softgrip_arrows target folders uses)
  set(stamp ${CMAKE_BINARY_DIR}/arrows/${target}.checked)
  string(REPLACE ";" "," folders "${folders}")
  string(REPLACE ";" "," uses "${uses}")
  set(list ${CMAKE_BINARY_DIR}/arrows/${target}.files)
  string(REPLACE ";" "\n" files "${ARGN}")
  file(CONFIGURE OUTPUT ${list} CONTENT "${files}\n")
  add_custom_command(OUTPUT ${stamp}
    COMMAND ${CMAKE_COMMAND} -DFOLDERS=${folders} -DUSES=${uses} -DFILES=${list} -DSOURCE=${PROJECT_SOURCE_DIR}
            -DSTAMP=${stamp} -P ${PROJECT_SOURCE_DIR}/cmake/arrows.cmake
    DEPENDS ${ARGN} ${list} ${PROJECT_SOURCE_DIR}/cmake/arrows.cmake
    COMMENT "" VERBATIM)
  add_custom_target(${target}_arrows DEPENDS ${stamp})
  add_dependencies(${target} ${target}_arrows)
endfunction()

# softgrip_page_files(FOLDER)  compiles page.html, page.css and page.js of FOLDER into the most recent room
function(softgrip_page_files folder)
  foreach(ending IN ITEMS html css js)
    set(file ${PROJECT_SOURCE_DIR}/${folder}/page.${ending})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    file(READ ${file} page_${ending})
  endforeach()
  configure_file(${PROJECT_SOURCE_DIR}/${folder}/page_files.cpp.in ${CMAKE_BINARY_DIR}/page_files.cpp @ONLY)
  target_sources(${softgrip_room_target} PRIVATE ${CMAKE_BINARY_DIR}/page_files.cpp)
endfunction()

# softgrip_flags_of(ROOM FLAG FILES...)  sets the compile option FLAG for some files of a room
function(softgrip_flags_of folder flag)
  list(TRANSFORM ARGN PREPEND ${PROJECT_SOURCE_DIR}/${folder}/)
  set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS ${flag})
endfunction()

# softgrip_program(NAME FILES OUTPUT ROOM room [USES room ...] [LIBRARIES target ...])  adds an executable
# that is installed. OUTPUT is its folder in the build tree.
function(softgrip_program name files output)
  cmake_parse_arguments(arg "" "ROOM" "USES;LIBRARIES" ${ARGN})
  list(TRANSFORM files PREPEND ${PROJECT_SOURCE_DIR}/)
  add_executable(${name} ${files})
  foreach(room IN LISTS arg_ROOM arg_USES)
    softgrip_target_of(${room} target)
    target_link_libraries(${name} PRIVATE ${target})
  endforeach()
  target_link_libraries(${name} PRIVATE softgrip_flags ${arg_LIBRARIES})
  softgrip_compile_together(${name})
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/${output})
  # All symbols are resolved when the program starts. Otherwise, the first call of a function in the control loop would
  # have to look up its symbol. The program loads only libraries from which it calls a function.
  target_link_options(${name} PRIVATE -Wl,-z,relro,-z,now,--as-needed)
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endfunction()

# If a source uses a precompiled header, Clang requires the same definitions for both. ccache finds no cached objects
# for such sources.
function(softgrip_may_precompile variable)
  if(SOFTGRIP_PRECOMPILE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set(${variable} TRUE PARENT_SCOPE)
  else()
    set(${variable} FALSE PARENT_SCOPE)
  endif()
endfunction()
# GCC 12 incorrectly warns about accesses to the inner buffer of a short std::string. The warning is hidden in system
# headers. It appears if the header is precompiled or if several files are compiled as one.
set(softgrip_misread_strings -Wno-array-bounds -Wno-restrict -Wno-stringop-overflow -Wno-stringop-overread)

# Compiles up to 32 files of a target as one file, which takes 1.4 GB of memory. Files are combined in builds with
# precompiled headers only. These builds are made once and are not used for debugging.
function(softgrip_compile_together target)
  softgrip_may_precompile(may)
  if(may)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 32)
    target_compile_options(${target} PRIVATE ${softgrip_misread_strings})
    if(NOT SOFTGRIP_SANITIZE)  # the reports of a sanitizer need line numbers
      target_compile_options(${target} PRIVATE -g0)
    endif()
  endif()
endfunction()

# Compiles the headers that most rooms include, once for all rooms, and once more for the rooms with JSON. A room that
# precompiles headers of its own libraries does not use this result.
function(softgrip_precompile_for_rooms target own libraries)
  if(own)
    target_precompile_headers(${target} PRIVATE ${own})
    return()
  endif()
  set(shared softgrip_room_headers)
  set(more "")
  if(nlohmann_json::nlohmann_json IN_LIST libraries)
    set(shared softgrip_json_room_headers)
    set(more <nlohmann/json.hpp>)
  endif()
  if(NOT TARGET ${shared})
    file(WRITE ${CMAKE_BINARY_DIR}/${shared}.cpp "")
    add_library(${shared} OBJECT ${CMAKE_BINARY_DIR}/${shared}.cpp)
    target_link_libraries(${shared} PRIVATE softgrip_flags)
    softgrip_for_shared_library(${shared})
    softgrip_compile_together(${shared})
    target_precompile_headers(${shared} PRIVATE <algorithm> <array> <chrono> <cmath> <functional> <limits> <map>
      <memory> <numeric> <optional> <span> <string> <string_view> <variant> <vector> ${more})
  endif()
  target_precompile_headers(${target} REUSE_FROM ${shared})
endfunction()

# softgrip_rooms(OUT room ...)  sets OUT to the targets of the rooms
function(softgrip_rooms variable)
  set(targets "")
  foreach(room IN LISTS ARGN)
    softgrip_target_of(${room} target)
    list(APPEND targets ${target})
  endforeach()
  set(${variable} ${targets} PARENT_SCOPE)
endfunction()

# Compile options of all tests. The tests take most of the build time, and they check results instead of speed.
# Therefore they are compiled with little optimisation. The headers that all tests include are compiled once.
add_library(softgrip_test_flags INTERFACE)
if(NOT SOFTGRIP_SANITIZE AND NOT CMAKE_BUILD_TYPE STREQUAL "Debug")
  target_compile_options(softgrip_test_flags INTERFACE -Og -g1)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(softgrip_test_flags INTERFACE ${softgrip_misread_strings})
endif()
function(softgrip_precompile_for_tests target)
  softgrip_may_precompile(may)
  if(NOT may)
    return()
  endif()
  if(NOT TARGET softgrip_test_headers)
    file(WRITE ${CMAKE_BINARY_DIR}/test_headers.cpp "")
    add_library(softgrip_test_headers OBJECT ${CMAKE_BINARY_DIR}/test_headers.cpp)
    target_link_libraries(softgrip_test_headers PRIVATE softgrip_flags softgrip_test_flags GTest::gtest)
    softgrip_compile_together(softgrip_test_headers)
    target_precompile_headers(softgrip_test_headers PRIVATE <algorithm> <array> <chrono> <cmath> <filesystem> <fstream>
      <functional> <limits> <map> <memory> <numeric> <optional> <random> <span> <sstream> <string> <thread> <vector>
      <gtest/gtest.h>)
  endif()
  target_precompile_headers(${target} REUSE_FROM softgrip_test_headers)
  softgrip_compile_together(${target})
endfunction()

# softgrip_test(NAME FILES... [ROOMS room ...] [LINK target ...] [REALTIME test ...] [LONG test ...]
#   [CAMPAIGN test ...] [PROPERTIES ...])
# Adds a GoogleTest program. CTest runs each of its tests separately. Three options are lists of patterns of test names:
#   REALTIME  tests that measure real time. A shared machine may disturb them, so they get a second attempt
#             (scripts/ctest.sh).
#   LONG      tests that compute for seconds. scripts/test.sh --quick leaves them out. CTest starts them first (COST),
#             because a long test that starts last would run alone.
#   CAMPAIGN  long tests that another test of the same kind nearly replaces. Only scripts/test.sh --all runs them. A
#             CAMPAIGN test may also match a pattern of LONG.
function(softgrip_test name)
  cmake_parse_arguments(arg "" "" "ROOMS;LINK;REALTIME;LONG;CAMPAIGN;PROPERTIES" ${ARGN})
  softgrip_rooms(rooms ${arg_ROOMS})
  add_executable(${name} ${arg_UNPARSED_ARGUMENTS})
  target_link_libraries(${name}
    PRIVATE softgrip_flags softgrip_test_flags ${rooms} ${arg_LINK} GTest::gtest GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE SOFTGRIP_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  softgrip_precompile_for_tests(${name})
  string(JOIN ":" labelled ${arg_REALTIME} ${arg_LONG} ${arg_CAMPAIGN})
  softgrip_discover(${name} "*:-${labelled}" "" ${arg_PROPERTIES})
  string(JOIN ":" realtime ${arg_REALTIME})
  softgrip_discover(${name} "${realtime}" realtime ${arg_PROPERTIES})
  string(JOIN ":" campaign ${arg_CAMPAIGN})
  string(JOIN ":" long ${arg_LONG})
  if(campaign AND long)
    string(APPEND long ":-${campaign}")
  endif()
  softgrip_discover(${name} "${long}" long COST 10 ${arg_PROPERTIES})
  softgrip_discover(${name} "${campaign}" campaign COST 10 ${arg_PROPERTIES})
endfunction()
# Every parameter of a test has a name. The name of the CTest test therefore does not contain the value of the
# parameter, which could contain memory addresses that differ between builds.
function(softgrip_discover name filter label)
  if(filter AND NOT filter STREQUAL "*:-*")
    if(label)
      list(APPEND ARGN LABELS ${label})
    endif()
    if(SOFTGRIP_SANITIZE AND NOT label STREQUAL "realtime")
      softgrip_two_parts(${name} "${filter}" "${label}" TIMEOUT 36000 ${ARGN})
      return()
    endif()
    gtest_discover_tests(${name} NO_PRETTY_VALUES TEST_FILTER "${filter}" DISCOVERY_TIMEOUT 60
      TEST_LIST ${name}_tests_${label}
      PROPERTIES TIMEOUT 600 ${ARGN})
  endif()
endfunction()

# In a build with a sanitizer, the start of a process takes more time than most tests. Therefore two processes run all
# tests that measure no real time. CTest reads the file of a program only if the program has been built.
function(softgrip_two_parts name filter label)
  set(content "if(EXISTS \"$<TARGET_FILE:${name}>\")\n")
  foreach(part IN ITEMS 0 1)
    set(test ${name}.${label}part${part})
    list(TRANSFORM ARGN REPLACE "(.+)" "\"\\1\"" OUTPUT_VARIABLE properties)
    list(JOIN properties " " properties)
    string(APPEND content "  add_test(${test} \"$<TARGET_FILE:${name}>\" \"--gtest_filter=${filter}\")\n"
      "  set_tests_properties(${test} PROPERTIES ENVIRONMENT \"GTEST_TOTAL_SHARDS=2;GTEST_SHARD_INDEX=${part}\" ${properties})\n")
  endforeach()
  set(file ${CMAKE_CURRENT_BINARY_DIR}/${name}_${label}parts.cmake)
  file(GENERATE OUTPUT ${file} CONTENT "${content}endif()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${file})
endfunction()

# softgrip_fuzzer(NAME FILES... [ROOMS room ...] [LINK ...])  adds a libFuzzer target; requires the option
# SOFTGRIP_FUZZERS
function(softgrip_fuzzer name)
  cmake_parse_arguments(arg "" "" "ROOMS;LINK" ${ARGN})
  softgrip_rooms(rooms ${arg_ROOMS})
  add_executable(${name} ${arg_UNPARSED_ARGUMENTS})
  target_link_libraries(${name} PRIVATE softgrip_flags ${rooms} ${arg_LINK})
  target_compile_definitions(${name} PRIVATE SOFTGRIP_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  target_link_options(${name} PRIVATE -fsanitize=fuzzer)
endfunction()
