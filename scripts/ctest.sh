# Sourced: how the tests are run. A second attempt forgives a defect that shows one time in ten, so only tests have one
# that measure real time, on machines that others use, too (label `realtime`, given in tests/CMakeLists.txt). They wait
# far more than they compute: three per processor run at a time.

# run_ctest PRESET LABELS [CTEST OPTION ...]: every test without one of LABELS (a|b|c, or nothing)
run_ctest() {
  local preset=$1 without=$2 failed=0 jobs
  shift 2
  jobs=$(nproc)
  ctest --preset "$preset" -j "$jobs" -LE "^(${without:+$without|}realtime)\$" "$@" || failed=1
  ctest --preset "$preset" -j $((3 * jobs)) -L '^realtime$' ${without:+-LE "^($without)\$"} --repeat until-pass:2 "$@" ||
    failed=1
  return $failed
}
