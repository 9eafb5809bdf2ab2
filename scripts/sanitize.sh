#!/usr/bin/env bash
# Builds tests with the sanitizers and runs them:
#   scripts/sanitize.sh        tests of code that parses external bytes, with AddressSanitizer and UndefinedBehaviorSanitizer;
#                              tests of code with threads, with ThreadSanitizer. scripts/test.sh runs this form.
#   scripts/sanitize.sh all    every test program and the Python module with the first two, all daemon tests with the third
#   scripts/sanitize.sh build  builds the programs of the first form without running them. The release build must be complete
# The first form compiles code with a sanitizer only if this code parses external bytes or has threads. The programs are
# linked with the libraries of the release build for all other rooms.
# Tests that run other programs of the system are skipped. Reports are files in build/PRESET/reports, so no report is missed.
# tests/support/lsan.supp lists memory that other libraries keep until the process ends.
set -euo pipefail
cd "$(dirname "$(realpath "$0")")/.."
. scripts/build.sh
. scripts/ctest.sh

only_build=false
# Tests that run no code of a sanitized build: checks of the sources, and tests of Python code. The fuzz test of the
# Python module does run such code.
elsewhere='^(systemd|packaging|repository|workflow|bench|library|blind|textbook_world|BlocksPage|KeyTables|PlcMapPage)\.|^python\.test_[^f]'
without='^python\.test_fuzz$'  # the default form of this script does not build the Python module
# sanitized PRESET ROOMS TEST_PROGRAM ...  builds the test programs with a sanitizer preset and runs them. The sanitizer
# does not check the code of ROOMS (a;b;c, or empty)
sanitized() {
  local preset=$1 rooms=$2 reports=$PWD/build/$1/reports failed=0
  shift 2
  echo "$preset: $*"
  cmake --preset "$preset" -DSOFTGRIP_PRECOMPILE=ON -DSOFTGRIP_LINKED_ROOMS="$rooms" >/dev/null
  build "$preset" "$@"
  ! $only_build || return 0
  rm -rf "$reports" && mkdir -p "$reports"
  ASAN_OPTIONS=log_path=$reports/asan UBSAN_OPTIONS=print_stacktrace=1:log_path=$reports/ubsan \
    TSAN_OPTIONS=log_path=$reports/tsan LSAN_OPTIONS=suppressions=$PWD/tests/support/lsan.supp:print_suppressions=0 \
    run_ctest "$preset" 'blind|campaign|system|recipe' -E "_NOT_BUILT|$elsewhere|$without" |
    grep -v ' Start \| Passed ' || failed=1
  if [ -n "$(ls "$reports")" ]; then
    cat "$reports"/* >&2
    failed=1
  fi
  return $failed
}

case ${1:-} in
  "" | build)
    # The tests of this form pass no external bytes to these rooms.
    computing='model;control/elements;control/feedforward;control/tick;control/sequences'
    # These rooms start no threads and share no variables between threads.
    reading='base/result;document;model;model/file;control/sequences;rig/plc_file;rig/web_file;rig'
    if [ -n "${1:-}" ]; then
      only_build=true
    else
      [ -e build/release/build.ninja ] || cmake --preset release >/dev/null
      build release $(tr ';/' ' _' <<<" $computing;$reading" | sed 's/ / softgrip_/g')
    fi
    sanitized asan-ubsan "$computing" base_test base_threads_test drivers_test emulator_test
    # Omit the other tests of the drivers and of base, because they start no threads.
    sanitized tsan "$reading" base_threads_test daemon_test daemon_process_test
    ;;
  all)
    without='^$'
    sanitized asan-ubsan "" all
    sanitized tsan "" daemon_test daemon_process_test daemon_real_time_test drivers_test emulator_test emulator_wire_test
    ;;
  *) sed -n '2,10s/^# \{0,1\}//p' "$0" >&2; exit 2 ;;
esac
