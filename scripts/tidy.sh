#!/usr/bin/env bash
# clang-tidy (.clang-tidy says what it asks, and why not more) over the sources of the project, not over its tests:
#   scripts/tidy.sh                    all of them, folder by folder, with the processor time that each took
#   scripts/tidy.sh daemon tools/rig   these folders or files
# JOBS and BUILD_DIR (default: all cores, build/release) may be set in the environment. Exits 1 on a finding.
set -euo pipefail
cd "$(dirname "$(realpath "$0")")/.."
build=${BUILD_DIR:-build/release} jobs=${JOBS:-$(nproc)}
[ $# -gt 0 ] || set -- model control drivers daemon sysid tools
[ -f "$build/compile_commands.json" ] || cmake --preset release -B "$build" >/dev/null

log=$(mktemp)
trap 'rm -f "$log"' EXIT
failed=0 TIMEFORMAT='%U s of processor time'
for place in "$@"; do
  mapfile -t sources < <(git ls-files "$place" | grep '\.cpp$')
  [ ${#sources[@]} -gt 0 ] || { echo "tidy.sh: no sources in $place" >&2; exit 2; }
  printf '%s: %d files, ' "$place" ${#sources[@]}
  { time printf '%s\0' "${sources[@]}" | xargs -0 -P "$jobs" -n 1 clang-tidy -p "$build" --quiet >"$log" 2>&1 || failed=1; } 2>&1
  # A finding in a header comes once per source that includes it.
  awk '/ warnings? generated\.$/ {next} /: (error|warning): / {told = seen[$0]++} !told' "$log"
done
exit $failed
