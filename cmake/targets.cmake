# softgrip_room(FOLDER [FOLDERS more ...] [USES room ...] [LIBRARIES target ...] [PRECOMPILE header ...])
# A room is a folder, a static library of all its .cpp files (one that has none is an interface), and the rooms that
# its files may include. PRECOMPILE: a library's header that most of its files include and that is most of their compile
# time. Most of the rest are the same headers and templates in every file, so the files of a room are compiled as one: the
# names in their unnamed namespaces differ. Both only with SOFTGRIP_PRECOMPILE. The target of daemon/loop is
# softgrip_daemon_loop; ${softgrip_room_target} names the last one.
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
  if(sources)
    add_library(${target} STATIC ${sources})
    target_link_libraries(${target} PUBLIC ${links})
    softgrip_for_shared_library(${target})
    softgrip_arrows(${target} "${folders}" "${reachable}" ${sources} ${headers})
    softgrip_may_precompile(may)
    if(may)
      softgrip_precompile_for_rooms(${target} "${arg_PRECOMPILE}")
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

# The shared library is made of the same objects as the programs. Names that it does not export are hidden, so that calls
# within it are direct, as in a program.
function(softgrip_for_shared_library target)
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden
    VISIBILITY_INLINES_HIDDEN ON)
  target_compile_options(${target} PRIVATE -fno-semantic-interposition)
endfunction()

# softgrip_public_headers(FOLDER)  the last room also finds the headers under FOLDER as they are installed
function(softgrip_public_headers folder)
  target_include_directories(${softgrip_room_target} PUBLIC ${PROJECT_SOURCE_DIR}/${folder})
endfunction()

function(softgrip_target_of folder variable)
  string(REPLACE "/" "_" name "softgrip_${folder}")
  set(${variable} ${name} PARENT_SCOPE)
endfunction()

# Before anything of a room compiles, what its files include is held against what the room may use.
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

# softgrip_page_files(FOLDER)  the page of the folder (page.html, page.css, page.js) becomes part of the last room
function(softgrip_page_files folder)
  foreach(ending IN ITEMS html css js)
    set(file ${PROJECT_SOURCE_DIR}/${folder}/page.${ending})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    file(READ ${file} page_${ending})
  endforeach()
  configure_file(${PROJECT_SOURCE_DIR}/${folder}/page_files.cpp.in ${CMAKE_BINARY_DIR}/page_files.cpp @ONLY)
  target_sources(${softgrip_room_target} PRIVATE ${CMAKE_BINARY_DIR}/page_files.cpp)
endfunction()

# softgrip_flags_of(ROOM FLAG FILES...)  compile options of some files of a room
function(softgrip_flags_of folder flag)
  list(TRANSFORM ARGN PREPEND ${PROJECT_SOURCE_DIR}/${folder}/)
  set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS ${flag})
endfunction()

# softgrip_program(NAME FILES OUTPUT ROOM room [USES room ...] [LIBRARIES target ...])  an installed executable, in
# the folder OUTPUT of the build tree
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
  # All symbols are bound at the start: a first call in the loop must not look one up.
  # And only libraries of which it calls something are loaded.
  target_link_options(${name} PRIVATE -Wl,-z,relro,-z,now,--as-needed)
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endfunction()

# clang wants the same definitions wherever a precompiled header is used; ccache finds nothing again behind one.
function(softgrip_may_precompile variable)
  if(SOFTGRIP_PRECOMPILE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set(${variable} TRUE PARENT_SCOPE)
  else()
    set(${variable} FALSE PARENT_SCOPE)
  endif()
endfunction()
# GCC 12 takes a short std::string for its inner buffer; that it happens in a system header hides it elsewhere, but not
# where the header is precompiled or many files are one.
set(softgrip_misread_strings -Wno-array-bounds -Wno-restrict -Wno-stringop-overflow -Wno-stringop-overread)

# The files of a target are compiled as one (at most 32, which take 1.4 GB), where headers may be precompiled, too: a build
# that is made once, in which nobody debugs.
function(softgrip_compile_together target)
  softgrip_may_precompile(may)
  if(may)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 32)
    target_compile_options(${target} PRIVATE ${softgrip_misread_strings})
    if(NOT SOFTGRIP_SANITIZE)  # whose reports name lines
      target_compile_options(${target} PRIVATE -g0)
    endif()
  endif()
endfunction()

# What most rooms include is compiled once, where a room has no library of its own to precompile.
function(softgrip_precompile_for_rooms target own)
  if(own)
    target_precompile_headers(${target} PRIVATE ${own})
    return()
  endif()
  if(NOT TARGET softgrip_room_headers)
    file(WRITE ${CMAKE_BINARY_DIR}/room_headers.cpp "")
    add_library(softgrip_room_headers OBJECT ${CMAKE_BINARY_DIR}/room_headers.cpp)
    target_link_libraries(softgrip_room_headers PRIVATE softgrip_flags)
    softgrip_for_shared_library(softgrip_room_headers)
    softgrip_compile_together(softgrip_room_headers)
    target_precompile_headers(softgrip_room_headers PRIVATE <algorithm> <array> <chrono> <cmath> <functional> <limits> <map>
      <memory> <numeric> <optional> <span> <string> <string_view> <variant> <vector>)
  endif()
  target_precompile_headers(${target} REUSE_FROM softgrip_room_headers)
endfunction()

# softgrip_rooms(OUT room ...)  the targets of rooms
function(softgrip_rooms variable)
  set(targets "")
  foreach(room IN LISTS ARGN)
    softgrip_target_of(${room} target)
    list(APPEND targets ${target})
  endforeach()
  set(${variable} ${targets} PARENT_SCOPE)
endfunction()

# What all tests are compiled with: they check answers, not speed, and are most of what a build compiles. What every one
# of them includes is compiled once.
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
# a GoogleTest program; its tests are discovered one by one. REALTIME: patterns of the tests that measure real time, which
# a shared machine may disturb: they get a second attempt (scripts/ctest.sh). LONG: of those that compute for seconds,
# which scripts/test.sh --quick leaves out and CTest begins with (COST), since one that began last would run alone.
# CAMPAIGN: of those that take long and guard what another test of the same kind guards, too, for scripts/test.sh --all; a
# name may stand there that a pattern of LONG has.
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
# Each parameter has a name of its own, so CTest's names do without its value, which may be bytes with addresses in them
# that differ from build to build.
function(softgrip_discover name filter label)
  if(filter AND NOT filter STREQUAL "*:-*")
    if(label)
      list(APPEND ARGN LABELS ${label})
    endif()
    gtest_discover_tests(${name} NO_PRETTY_VALUES TEST_FILTER "${filter}" DISCOVERY_TIMEOUT 60
      TEST_LIST ${name}_tests_${label}
      PROPERTIES TIMEOUT 600 ${ARGN})
  endif()
endfunction()

# softgrip_fuzzer(NAME FILES... [ROOMS room ...] [LINK ...])  a libFuzzer target; only with SOFTGRIP_FUZZERS
function(softgrip_fuzzer name)
  cmake_parse_arguments(arg "" "" "ROOMS;LINK" ${ARGN})
  softgrip_rooms(rooms ${arg_ROOMS})
  add_executable(${name} ${arg_UNPARSED_ARGUMENTS})
  target_link_libraries(${name} PRIVATE softgrip_flags ${rooms} ${arg_LINK})
  target_compile_definitions(${name} PRIVATE SOFTGRIP_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  target_link_options(${name} PRIVATE -fsanitize=fuzzer)
endfunction()
