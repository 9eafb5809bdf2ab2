#!/usr/bin/env bash
# Runs a fuzz target under AddressSanitizer and UndefinedBehaviorSanitizer, at idle priority:
#   scripts/fuzz.sh TARGET MINUTES      one target
#   scripts/fuzz.sh all MINUTES         one after the other, MINUTES each
#   scripts/fuzz.sh list                their names
#   scripts/fuzz.sh minimise TARGET     keeps the inputs of the grown corpus that add coverage: at most 100 files of 4 KiB
# A run starts with the corpus in the repository and collects new inputs in build/fuzz/grown/TARGET. Each run
# adds a line with its executions, coverage and findings to build/fuzz/runs.csv. The inputs of the findings
# are in build/fuzz/findings. The exit code is 1 if there are findings. FUZZ_BUILD names another folder with
# built targets, which is then not built. FUZZ_NICE=15 sets this niceness instead of idle priority, which
# leaves a target almost no time on a busy computer.
set -euo pipefail
cd "$(dirname "$(realpath "$0")")/.."
home=build/fuzz

# Columns of the table: target | corpus in the repository | additional inputs to start with | dictionary | longest input
# [bytes]
targets() {
  cat <<'TABLE'
yaml_fuzz|tests/document/corpus||tests/document/yaml.dict|4096
model_file_fuzz|tests/model/file/model_file_corpus|config/models|tests/document/yaml.dict|4096
sequence_file_fuzz|tests/control/sequences/sequence_file_corpus|config/sequences|tests/document/yaml.dict|4096
rig_file_fuzz|tests/rig/rig_file_corpus|config|tests/document/yaml.dict|8192
board_map_fuzz|tests/rig/board_map_corpus|config/boards|tests/document/yaml.dict|8192
faults_file_fuzz|tests/simulation/emulator/faults_file_corpus||tests/document/yaml.dict|4096
modbus_reply_fuzz|tests/drivers/modbus/modbus_reply_corpus|||512
rtu_reply_fuzz|tests/drivers/modbus/rtu_reply_corpus|||512
emulator_fuzz|tests/simulation/emulator/emulator_corpus|||1024
client_request_fuzz|tests/daemon/socket/client_request_corpus||tests/daemon/client_request.dict|1024
log_fuzz|tests/sysid/logs/log_corpus|||4096
import_fuzz|tests/sysid/import/import_corpus|||4096
plc_request_fuzz|tests/tools/plc/plc_request_corpus|||1024
web_request_fuzz|tests/tools/web/web_request_corpus|||12000
gauge_fuzz|tests/sysid/diagnosis/gauge/gauge_corpus|||4096
recording_fuzz|tests/tools/recordings/recording_corpus||tests/daemon/client_request.dict|4096
TABLE
}

priority=(nice -n 19 chrt -i 0)
[ -z "${FUZZ_NICE:-}" ] || priority=(nice -n "$FUZZ_NICE")

row_of() { targets | awk -F'|' -v target="$1" '$1 == target'; }
program_of() { find "${FUZZ_BUILD:-$home/tests}" -name "$1" -type f -perm -u+x | head -n 1; }

prepare() {
  if [ -n "${FUZZ_BUILD:-}" ]; then return; fi
  cmake --preset fuzz >/dev/null
  nice -n 19 cmake --build --preset fuzz --target "$1" | tail -n 1
}

fuzz() {
  local target=$1 minutes=$2 corpus seeds dictionary longest
  IFS='|' read -r _ corpus seeds dictionary longest <<<"$(row_of "$target")"
  prepare "$target"
  local program grown=$home/grown/$target findings=$home/findings log=$home/logs/$target.log
  program=$(program_of "$target")
  [ -n "$program" ] || { echo "fuzz.sh: $target is not built" >&2; exit 1; }
  mkdir -p "$grown" "$findings" "$(dirname "$log")"
  local options=("-max_total_time=$(awk "BEGIN {print int(60 * $minutes)}")" "-max_len=$longest" -timeout=20 -rss_limit_mb=2048 -print_final_stats=1
                 -reload=0 "-artifact_prefix=$findings/$target-")
  [ -z "$dictionary" ] || options+=("-dict=$dictionary")
  local folders=("$grown") status=0 folder
  for folder in $corpus $seeds; do [ ! -d "$folder" ] || folders+=("$folder"); done
  local began=$SECONDS
  local TIMEFORMAT=%U cpu_s executions coverage
  cpu_s=$({ time "${priority[@]}" "$program" "${options[@]}" "${folders[@]}" >"$log" 2>&1; } 2>&1) || status=$?
  executions=$(awk '/stat::number_of_executed_units/ {print $2}' "$log")
  coverage=$(grep -o 'cov: [0-9]*' "$log" | tail -n 1 | cut -d' ' -f2)
  [ -f "$home/runs.csv" ] || echo 'target,seconds,cpu_s,executions,coverage,exit_code' >"$home/runs.csv"
  echo "$target,$((SECONDS - began)),$cpu_s,${executions:-0},${coverage:-0},$status" >>"$home/runs.csv"
  tail -n 1 "$home/runs.csv"
  if [ "$status" -ne 0 ]; then
    tail -n 40 "$log" >&2
    return 1
  fi
}

# Copies inputs of the grown corpus to the repository. The copied set is the smallest set of short inputs with
# the same coverage.
minimise() {
  local target=$1 corpus longest kept
  IFS='|' read -r _ corpus _ _ longest <<<"$(row_of "$target")"
  kept=$(mktemp -d)
  local folders=("$home/grown/$target") folder
  [ ! -d "$corpus" ] || folders+=("$corpus")
  "${priority[@]}" "$(program_of "$target")" -merge=1 "-max_len=$longest" -timeout=20 "$kept" "${folders[@]}" >/dev/null 2>&1
  mkdir -p "$corpus"
  # Passes short inputs to the fuzzer before long ones, because a person can read short inputs.
  find "$kept" -type f -size -9 -printf '%s %p\n' | sort -n | head -n 100 | while read -r _ file; do
    cp "$file" "$corpus/"
  done
  echo "$target: $(find "$corpus" -type f | wc -l) files in $corpus"
  rm -rf "$kept"
}

case "${1:-}" in
  list) targets | cut -d'|' -f1 ;;
  minimise) [ -n "$(row_of "${2:-}")" ] || { echo "fuzz.sh: no target ${2:-}" >&2; exit 2; }; minimise "$2" ;;
  all)
    found=0
    for target in $(targets | cut -d'|' -f1); do fuzz "$target" "${2:?minutes}" || found=1; done
    exit $found ;;
  *)
    if [ -z "${2:-}" ] || [ -z "$(row_of "$1")" ]; then
      echo "usage: scripts/fuzz.sh TARGET|all MINUTES, scripts/fuzz.sh list, scripts/fuzz.sh minimise TARGET" >&2
      exit 2
    fi
    fuzz "$1" "$2" ;;
esac
