# softgrip_library(NAME FILES... [LINK ...])  a static library of one folder
function(softgrip_library name)
  cmake_parse_arguments(arg "" "" "LINK" ${ARGN})
  add_library(${name} STATIC ${arg_UNPARSED_ARGUMENTS})
  target_link_libraries(${name} PUBLIC softgrip_flags ${arg_LINK})
endfunction()

# softgrip_program(NAME FILES... [LINK ...])  an installed executable
function(softgrip_program name)
  cmake_parse_arguments(arg "" "" "LINK" ${ARGN})
  add_executable(${name} ${arg_UNPARSED_ARGUMENTS})
  target_link_libraries(${name} PRIVATE softgrip_flags ${arg_LINK})
  # All symbols are bound at the start: a first call in the loop must not look one up.
  target_link_options(${name} PRIVATE -Wl,-z,relro,-z,now)
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endfunction()

# softgrip_test(NAME FILES... [LINK ...])  a GoogleTest program; its tests are discovered one by one
function(softgrip_test name)
  cmake_parse_arguments(arg "" "" "LINK;PROPERTIES" ${ARGN})
  add_executable(${name} ${arg_UNPARSED_ARGUMENTS})
  target_link_libraries(${name} PRIVATE softgrip_flags ${arg_LINK} GTest::gtest GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE SOFTGRIP_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  gtest_discover_tests(${name} PROPERTIES TIMEOUT 120 ${arg_PROPERTIES} DISCOVERY_TIMEOUT 60)
endfunction()

# softgrip_fuzzer(NAME FILES... [LINK ...])  a libFuzzer target; only with SOFTGRIP_FUZZERS
function(softgrip_fuzzer name)
  cmake_parse_arguments(arg "" "" "LINK" ${ARGN})
  add_executable(${name} ${arg_UNPARSED_ARGUMENTS})
  target_link_libraries(${name} PRIVATE softgrip_flags ${arg_LINK})
  target_link_options(${name} PRIVATE -fsanitize=fuzzer)
endfunction()
