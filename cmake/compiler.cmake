# Compiler flags that all targets of the project share: the warnings, and the sanitizers that the option
# SOFTGRIP_SANITIZE selects.
add_library(softgrip_flags INTERFACE)
target_include_directories(softgrip_flags INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_options(softgrip_flags INTERFACE
  -Wall -Wextra -Wpedantic $<$<BOOL:${SOFTGRIP_WERROR}>:-Werror> -Wshadow -Wconversion -Wsign-conversion
  -Wnon-virtual-dtor -Wold-style-cast -Woverloaded-virtual -Wnull-dereference -Wdouble-promotion -Wimplicit-fallthrough
  # Compilers contract a*b+c to one operation, but at different places. Without this contraction, runs can be repeated
  # bit for bit.
  -ffp-contract=off)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # With -O2, GCC 12 incorrectly reports null dereferences in inlined standard containers.
  target_compile_options(softgrip_flags INTERFACE -Wno-null-dereference)
  # GCC searches its own memory for free space from 128 MB on. A room needs up to 1.7 GB without this search, and 1.3 GB
  # with it. The objects are the same.
  cmake_host_system_information(RESULT memory_mib QUERY TOTAL_PHYSICAL_MEMORY)
  cmake_host_system_information(RESULT processors QUERY NUMBER_OF_LOGICAL_CORES)
  math(EXPR memory_per_job_mib "${memory_mib} / ${processors}")
  if(memory_per_job_mib GREATER 3000)
    target_compile_options(softgrip_flags INTERFACE --param=ggc-min-heapsize=1000000)
  endif()
endif()
if(SOFTGRIP_SANITIZE)
  add_compile_options(-fsanitize=${SOFTGRIP_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${SOFTGRIP_SANITIZE})
  if(SOFTGRIP_SANITIZE MATCHES "undefined")
    add_compile_options(-fno-sanitize-recover=undefined)
  endif()
endif()
if(NOT SOFTGRIP_SANITIZE)
  # The hardening options of the Debian package. All builds have these options, because a user may run any build on a
  # rig.
  include(CheckCXXCompilerFlag)
  check_cxx_compiler_flag(-fcf-protection SOFTGRIP_HAS_CF_PROTECTION)
  if(NOT CMAKE_BUILD_TYPE STREQUAL "Debug")  # _FORTIFY_SOURCE needs an optimised build
    add_compile_options(-U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2)
  endif()
  add_compile_options(-fstack-protector-strong -fstack-clash-protection
    $<$<BOOL:${SOFTGRIP_HAS_CF_PROTECTION}>:-fcf-protection>)
  add_link_options(-Wl,-z,relro,-z,now)
endif()
if(SOFTGRIP_FUZZERS)
  # The fuzzer is guided by the coverage of all libraries, so all are compiled for it. The fuzz targets alone are linked
  # with main() of libFuzzer.
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()
