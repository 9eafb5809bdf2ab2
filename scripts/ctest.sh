# A file for other scripts. Its functions run the tests. Tests with the label `realtime` (tests/CMakeLists.txt) measure
# real time on a shared computer, so they get a second attempt. All other tests get one attempt, because a second
# attempt would hide a defect that occurs in 1 of 10 runs. The real-time tests mostly wait, so five of them run per
# processor at the same time.

# Tests that compute run at the same time as the real-time tests. They run in the idle scheduling class, so the
# real-time tests get the processor immediately.

# start_computing_tests PRESET LABELS [CTEST OPTION ...]  starts all tests that have none of the LABELS
# (a|b|c, or empty)
start_computing_tests() {
  local preset=$1 without=$2
  shift 2
  chrt --idle 0 ctest --preset "$preset" -j "$(nproc)" -LE "^(${without:+$without|}realtime)\$" "$@" \
    >"build/$preset-computing.log" 2>&1 &
  computing=$!
}

# end_computing_tests PRESET  waits for the end of the computing tests, prints their results and returns their exit
# status
end_computing_tests() {
  local failed=0
  wait "$computing" || failed=1
  cat "build/$1-computing.log"
  return $failed
}

# run_real_time_tests PRESET LABELS [CTEST OPTION ...]  runs the tests that measure real time and have none of
# the LABELS
run_real_time_tests() {
  local preset=$1 without=$2
  shift 2
  ctest --preset "$preset" -j $((5 * $(nproc))) -L '^realtime$' ${without:+-LE "^($without)\$"} --repeat until-pass:2 "$@" \
    | tee "build/$preset-real-time.log"
}

# list_failed_tests PRESET  prints the names of the failed tests of both groups. Their output is several thousand
# lines earlier.
list_failed_tests() {
  local group
  for group in real-time computing; do
    sed -n '/^The following tests FAILED:/,/^Errors while running/p' "build/$1-$group.log"
  done
}

# run_ctest PRESET LABELS [CTEST OPTION ...]  runs both groups of tests
run_ctest() {
  local failed=0
  start_computing_tests "$@"
  run_real_time_tests "$@" || failed=1
  end_computing_tests "$1" || failed=1
  return $failed
}
