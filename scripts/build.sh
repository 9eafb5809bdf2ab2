# To be sourced: builds and prints the last line of the build, or the lines of the failure.

# build PRESET [TARGET ...]
build() {
  local preset=$1 log=build/$1.log
  shift
  if ! cmake --build --preset "$preset" -j "$(nproc)" ${1:+--target "$@"} >"$log" 2>&1; then
    grep -A 12 '^FAILED:' "$log" >&2 || tail -n 40 "$log" >&2
    return 1
  fi
  tail -n 1 "$log"
}
