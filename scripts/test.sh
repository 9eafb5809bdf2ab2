#!/usr/bin/env bash
# Installs what the tests need, builds, and runs them: the release build with every test; the Debian package; then, under
# AddressSanitizer and UndefinedBehaviorSanitizer, what meets bytes from outside; then, under ThreadSanitizer, what has
# threads; then clang-tidy over the sources that differ from origin's main (over all of them: scripts/tidy.sh).
#   scripts/test.sh            all of it
#   scripts/test.sh --quick    the release build and its tests only
# docs/how-to/measure.md says how to run every test under a sanitizer.
set -euo pipefail
cd "$(dirname "$(realpath "$0")")/.."

quick=false
case "${1:-}" in
  "") ;;
  --quick) quick=true ;;
  *) echo "usage: scripts/test.sh [--quick]" >&2; exit 2 ;;
esac

bash scripts/packages.sh build tests package
jobs=$(nproc)
started=$SECONDS
say() { printf '\n== %s (%d s)\n' "$*" $((SECONDS - started)); }

# sanitized PRESET TEST_PROGRAM ...: builds and runs them. A test whose clock went wrong on a busy machine is run once
# more; what a sanitizer reports is never forgiven, since the reports are files.
sanitized() {
  local preset=$1 reports=$PWD/build/$1/reports others='_NOT_BUILT|^(system|systemd|packaging|blind|BlocksPage)\.'
  shift
  say "$preset: $*"
  cmake --preset "$preset" >/dev/null
  cmake --build --preset "$preset" -j "$jobs" --target "$@" | tail -n 1
  rm -rf "$reports" && mkdir -p "$reports"
  ASAN_OPTIONS=log_path=$reports/asan UBSAN_OPTIONS=print_stacktrace=1:log_path=$reports/ubsan \
    TSAN_OPTIONS=log_path=$reports/tsan \
    ctest --preset "$preset" -j "$jobs" --repeat until-pass:2 -E "$others" | grep -v ' Start \| Passed '
  if [ -n "$(ls "$reports")" ]; then
    cat "$reports"/* >&2
    return 1
  fi
}

say "format"
git ls-files '*.h' '*.cpp' | xargs clang-format --dry-run --Werror

say "build"
cmake --preset release -DSOFTGRIP_TESTS=ON -DSOFTGRIP_BENCHMARKS=ON >/dev/null
cmake --build --preset release -j "$jobs" | tail -n 1

say "test"
# Real sockets and real time on a machine that may be busy: what fails once is run once more, twice is a failure.
# The recipe compiles a second tree.
$quick && slow=(-LE recipe) || slow=()
ctest --preset release -j "$jobs" --repeat until-pass:2 "${slow[@]}"

if ! $quick; then
  say "package"
  bash scripts/package.sh | tail -n 1

  sanitized asan-ubsan model_document_test drivers_test modbus_tcp_link_test modbus_rtu_link_test modbus_board_test
  sanitized tsan daemon_cells_test daemon_bus_test daemon_recorder_test daemon_loop_test daemon_socket_test \
    daemon_process_test daemon_panel_test modbus_tcp_link_test modbus_rtu_link_test modbus_board_test

  mapfile -t changed < <(git diff --name-only --diff-filter=d origin/main...HEAD -- \
    {model,control,drivers,daemon,sysid,tools}/'*.cpp' 2>/dev/null || true)
  if [ ${#changed[@]} -gt 0 ] && [ ${#changed[@]} -le 40 ]; then
    say "clang-tidy: ${#changed[@]} changed sources"
    bash scripts/tidy.sh "${changed[@]}"
  fi
fi
say "done"
