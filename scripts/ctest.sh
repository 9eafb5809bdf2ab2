# Sourced: how the tests are run. A second attempt forgives a defect that shows one time in ten, so only tests have one
# that measure real time, on machines that others use, too (label `realtime`, given in tests/CMakeLists.txt). They wait
# far more than they compute: three per processor run at a time.

# Those that compute run beside them, on what they leave of the processors: a thread of the idle class gives way at once.

# start_computing_tests PRESET LABELS [CTEST OPTION ...]: every test without one of LABELS (a|b|c, or nothing)
start_computing_tests() {
  local preset=$1 without=$2
  shift 2
  chrt --idle 0 ctest --preset "$preset" -j "$(nproc)" -LE "^(${without:+$without|}realtime)\$" "$@" \
    >"build/$preset-computing.log" 2>&1 &
  computing=$!
}

# end_computing_tests PRESET: waits for them and says how they went
end_computing_tests() {
  local failed=0
  wait "$computing" || failed=1
  cat "build/$1-computing.log"
  return $failed
}

# run_real_time_tests PRESET LABELS [CTEST OPTION ...]
run_real_time_tests() {
  local preset=$1 without=$2
  shift 2
  ctest --preset "$preset" -j $((3 * $(nproc))) -L '^realtime$' ${without:+-LE "^($without)\$"} --repeat until-pass:2 "$@"
}

# run_ctest PRESET LABELS [CTEST OPTION ...]
run_ctest() {
  local failed=0
  start_computing_tests "$@"
  run_real_time_tests "$@" || failed=1
  end_computing_tests "$1" || failed=1
  return $failed
}
