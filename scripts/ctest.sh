# Sourced: how the tests are run. A second attempt forgives a defect that shows one time in ten, so only tests have one
# that measure real time, on machines that others use, too (label `realtime`, given in tests/CMakeLists.txt). They wait
# far more than they compute: three per processor run at a time.

# Those that compute run beside them, on what they leave of the processors: a thread of the idle class gives way at once.

# run_ctest PRESET LABELS [CTEST OPTION ...]: every test without one of LABELS (a|b|c, or nothing)
run_ctest() {
  local preset=$1 without=$2 failed=0 jobs computing
  shift 2
  jobs=$(nproc)
  chrt --idle 0 ctest --preset "$preset" -j "$jobs" -LE "^(${without:+$without|}realtime)\$" "$@" \
    >"build/$preset-computing.log" 2>&1 &
  computing=$!
  ctest --preset "$preset" -j $((3 * jobs)) -L '^realtime$' ${without:+-LE "^($without)\$"} --repeat until-pass:2 "$@" ||
    failed=1
  wait "$computing" || failed=1
  cat "build/$preset-computing.log"
  return $failed
}
