# Flags that every target of the project shares: warnings, sanitizers by one option.
add_library(softgrip_flags INTERFACE)
target_include_directories(softgrip_flags INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_options(softgrip_flags INTERFACE
  -Wall -Wextra -Wpedantic $<$<BOOL:${SOFTGRIP_WERROR}>:-Werror> -Wshadow -Wconversion -Wsign-conversion
  -Wnon-virtual-dtor -Wold-style-cast -Woverloaded-virtual -Wnull-dereference -Wdouble-promotion -Wimplicit-fallthrough
  # Bit-for-bit repeatable runs: no contraction of a*b+c that differs between compilers and call sites.
  -ffp-contract=off)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # GCC 12 reports null dereferences inside inlined standard containers under -O2.
  target_compile_options(softgrip_flags INTERFACE -Wno-null-dereference)
endif()
if(SOFTGRIP_SANITIZE)
  add_compile_options(-fsanitize=${SOFTGRIP_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${SOFTGRIP_SANITIZE})
  if(SOFTGRIP_SANITIZE MATCHES "undefined")
    add_compile_options(-fno-sanitize-recover=undefined)
  endif()
endif()
if(NOT SOFTGRIP_SANITIZE)
  # What Debian's package builds with, for whoever runs another build on a rig.
  include(CheckCXXCompilerFlag)
  check_cxx_compiler_flag(-fcf-protection SOFTGRIP_HAS_CF_PROTECTION)
  if(NOT CMAKE_BUILD_TYPE STREQUAL "Debug")  # it needs an optimiser
    add_compile_options(-U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2)
  endif()
  add_compile_options(-fstack-protector-strong -fstack-clash-protection
    $<$<BOOL:${SOFTGRIP_HAS_CF_PROTECTION}>:-fcf-protection>)
  add_link_options(-Wl,-z,relro,-z,now)
endif()
if(SOFTGRIP_FUZZERS)
  # Coverage of all libraries steers the fuzzer; only its own targets get its main().
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()
