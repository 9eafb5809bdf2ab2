#!/usr/bin/env bash
# Installs what the tests need, builds, and runs them: the release build with everything, then the same
# tests under AddressSanitizer + UndefinedBehaviorSanitizer and the threaded ones under ThreadSanitizer.
#   scripts/test.sh            all of it
#   scripts/test.sh --quick    the release build and its tests only
set -euo pipefail
cd "$(dirname "$(realpath "$0")")/.."

quick=false
case "${1:-}" in
  "") ;;
  --quick) quick=true ;;
  *) echo "usage: scripts/test.sh [--quick]" >&2; exit 2 ;;
esac

bash scripts/packages.sh build tests
jobs=$(nproc)
started=$SECONDS
say() { printf '\n== %s (%d s)\n' "$*" $((SECONDS - started)); }

say "format"
git ls-files '*.h' '*.cpp' | xargs clang-format --dry-run --Werror

build_and_test() {  # preset, then ctest arguments
  local preset=$1; shift
  say "build $preset"
  cmake --preset "$preset" >/dev/null
  cmake --build --preset "$preset" -j "$jobs" | tail -n 1
  say "test $preset"
  ctest --preset "$preset" -j "$jobs" "$@"
}

build_and_test release
if ! $quick; then
  say "clang-tidy"
  bash scripts/tidy.sh build/release
  build_and_test asan-ubsan -LE 'timing|system'
  build_and_test tsan -L threads
fi
say "done"
