#!/usr/bin/env bash
# Installs what the tests need, builds, and runs them: the release build with every test; beside those that compute the
# Debian package, under AddressSanitizer and UndefinedBehaviorSanitizer what meets bytes from outside, and under
# ThreadSanitizer what has threads; then clang-tidy over the sources that differ from origin's main.
#   scripts/test.sh            all of it
#   scripts/test.sh --quick    the release build and the tests that take no more than a moment each
#   scripts/test.sh --all      hours: with the tests labelled campaign (more blind worlds) and recipe (the pages that say how
#                              to add something, carried out in a copy of the sources), every test under the sanitizers,
#                              every source under clang-tidy
set -euo pipefail
cd "$(dirname "$(realpath "$0")")/.."

quick=false all=false
case "${1:-}" in
  "") ;;
  --quick) quick=true ;;
  --all) all=true ;;
  *) echo "usage: scripts/test.sh [--quick | --all]" >&2; exit 2 ;;
esac

if $quick; then wanted="build tests workflows"; else wanted="build tests workflows readers package lint"; fi
bash scripts/packages.sh $wanted
$quick || bash scripts/mcap_reader.sh
. scripts/build.sh
. scripts/ctest.sh
started=$SECONDS
say() { printf '\n== %s (%d s)\n' "$*" $((SECONDS - started)); }
# The last words: what was left out stands among them.
end() {
  if [ -s build/mcap/unreachable ]; then printf '\nNOT TESTED: MCAP by its own reader, for %s\n' "$(cat build/mcap/unreachable)"; fi
  say "done"
  exit 0
}

# Other versions read .clang-format otherwise.
if clang-format --version 2>/dev/null | grep -q 'version 14\.'; then
  say "format"
  git ls-files '*.h' '*.cpp' | xargs clang-format --dry-run --Werror
fi

say "build"
cmake --preset release -DSOFTGRIP_TESTS=ON -DSOFTGRIP_BENCHMARKS=ON -DSOFTGRIP_PRECOMPILE=ON >/dev/null
build release

if $quick; then
  say "test"
  run_ctest release 'blind|system|recipe|campaign|long'
  say "done"
  exit 0
fi

# Beside the tests, most of which wait, with what they leave of the processors.
mkdir -p build
without='recipe|campaign'
if $all; then without=''; fi
set -m  # groups of their own, so that they can be ended whole
chrt --idle 0 bash scripts/sanitize.sh build </dev/null >build/sanitize.log 2>&1 &
sanitized=$!
start_computing_tests release "$without"
set +m
trap 'kill -- -$sanitized -$computing 2>/dev/null || true' EXIT
say "test: in real time"
failed=false
run_real_time_tests release "$without" || failed=true
# Beside the rest of those that compute.
say "package"
bash scripts/package.sh | tail -n 1
say "sanitizers"
wait $sanitized || { tail -n 40 build/sanitize.log >&2; exit 1; }
$all || bash scripts/sanitize.sh
say "test: the others"
end_computing_tests release || failed=true
! $failed || exit 1
if $all; then
  bash scripts/sanitize.sh all
  say "clang-tidy: every source"
  python3 scripts/tidy.py
  end
fi
mapfile -t changed < <(git diff --name-only --diff-filter=d origin/main...HEAD -- '*.cpp' 2>/dev/null || true)
if [ ${#changed[@]} -gt 0 ] && [ ${#changed[@]} -le 40 ]; then
  say "clang-tidy: ${#changed[@]} changed sources"
  python3 scripts/tidy.py "${changed[@]}"
fi
end
