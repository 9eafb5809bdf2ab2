# A file for other scripts. Its function builds targets. It prints the last line of the output, or the error messages if
# the build fails.

# build PRESET [TARGET ...]  builds the targets
build() {
  local preset=$1 log=build/$1.log
  shift
  if ! cmake --build --preset "$preset" -j "$(nproc)" ${1:+--target "$@"} >"$log" 2>&1; then
    grep -A 12 '^FAILED:' "$log" >&2 || tail -n 40 "$log" >&2
    return 1
  fi
  tail -n 1 "$log"
}
