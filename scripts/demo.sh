#!/usr/bin/env bash
# Installs the required packages, builds, and demonstrates the project on a simulated rig:
#   scripts/demo.sh [OUTPUT_DIR]      default: demo-output/
# The output of an earlier demo in OUTPUT_DIR is deleted. Any other folder with content is refused.
set -euo pipefail
cd "$(dirname "$(realpath "$0")")/.."
out=$(realpath -m "${1:-demo-output}")
# The output of a demo contains a marker file. The output of earlier versions has no marker file. It contains only names
# that the demo writes, among them runs/ and pick_stone.svg. If an earlier version stopped early, it left only runs/.
marker=.softgrip-demo
content() { find "$out" -mindepth 1 -maxdepth 1 "$@"; }
is_of_a_demo() {
  [ ! -f "$out/$marker" ] || return 0
  local name others=()
  for name in runs pick_stone.svg {tp1,steps,sp2,second_tp2,second_sp1,aged_tp2,aged_sp1}.csv identified diagnosis baseline \
    changed grips health; do
    others+=(! -name "$name")
  done
  [ -d "$out/runs" ] && [ -z "$(content "${others[@]}")" ] && { [ -f "$out/pick_stone.svg" ] || [ -z "$(content ! -name runs)" ]; }
}
require_deletable() {
  if [ ! -e "$out" ] || { [ -d "$out" ] && { [ -z "$(content)" ] || is_of_a_demo; }; }; then return; fi
  echo "demo.sh: $out exists, but is not the output of a demo, and its content would be deleted. Name a new folder." >&2
  exit 2
}
require_deletable
# Updates an existing build. If no build exists, builds the four programs that the demo needs, without debug
# information.
build=build/release
[ -f "$build/CMakeCache.txt" ] || build=build/demo

bash scripts/packages.sh build
echo "Building (a few minutes the first time) ..."
[ -f "$build/CMakeCache.txt" ] || cmake --preset demo >/dev/null
build() { cmake --build "$build" -j "$(nproc)" --target softgrip softgripd softgrip-rig softgrip-web; }
if [ -t 1 ]; then
  build  # on a terminal, ninja shows its progress on one line
else
  build >"$build/demo.log" || { tail -n 40 "$build/demo.log" >&2; exit 1; }
fi
python3 tests/repository/libraries.py --build "$build" >>"$build/demo.log" || { tail -n 4 "$build/demo.log" >&2; exit 1; }

require_deletable  # again, because the build takes minutes
# The marker exists during the whole deletion, so that the next demo accepts the folder after an interruption.
mkdir -p "$out" && touch "$out/$marker"
content ! -name "$marker" -exec rm -rf {} +
mkdir "$out/runs"
work=$(mktemp -d) runs=$out/runs
. scripts/rig_session.sh
web_pid=
stop_web() { if [ -n "$web_pid" ]; then kill "$web_pid" 2>/dev/null; wait "$web_pid" 2>/dev/null; fi; web_pid=; }
trap 'stop_web; stop_daemon; stop_rig; rm -rf "$work"' EXIT
say() { printf '\n== %s\n' "$*"; }

say "Operator page, available while the demo runs (softgrip-web)"
"$build/tools/softgrip-web" --config config/web.yaml --socket "$work/sock" --recordings "$runs" --operate --port 0 \
  >"$work/web.log" 2>&1 &
web_pid=$!
for _ in $(seq 50); do grep -q 'listening on' "$work/web.log" && break; sleep 0.1; done
sed -n 's/^listening on /   /p' "$work/web.log"

say "1. Start an emulated rig: two fingers and a stone behind a Modbus TCP board (softgrip-rig)"
start_rig --object stone
cat "$work/rig.log"

say "2. Start the daemon at 200 Hz (softgripd) and pick the stone with both fingers"
start_daemon
sed 's/^/   /' "$work/daemon.log"
"$softgrip" start --wait pick_stone ||
  { echo "The pick did not succeed. The lines above give the reason. On a busy computer, try again." >&2; exit 1; }
"$softgrip" vent
"$softgrip" status
stop_daemon
stop_rig
tail -n 1 "$work/daemon.log"
"$softgrip" plot "$runs"/*pick_stone* --out "$out/pick_stone.svg"

say "3. Track a sine from 6 to 20 mm at 0.2 Hz over Modbus: equal PID gains, three feedforwards"
bash scripts/tracking.sh "$build" 0.2 2

say "4. Simulate three logs of the same finger with 0.05 mm of sensor noise"
for signal in tp1 steps sp2; do
  "$softgrip" simulate --model config/models/bench_twin.yaml --input $signal --out "$out/$signal.csv" \
    --noise-mm 0.05 --seed 3 --rate-hz 100
done

say "5. Fit the published model to tp1 and validate it on the other logs: the fit looks good"
"$softgrip" identify --start config/models/zhang2025.yaml --data "$out/tp1.csv" --validate "$out/steps.csv" "$out/sp2.csv" \
  --out "$out/identified" | sed -n '1,12p'

say "6. Diagnose the model: size and cause of its error"
"$softgrip" diagnose --model config/models/zhang2025.yaml --data "$out/tp1.csv" "$out/steps.csv" "$out/sp2.csv" --out "$out/diagnosis"

say "7. Record a baseline, then detect a drift of the gain in later logs"
twin=config/models/bench_twin.yaml
{ cat "$twin"; printf '  - ageing:\n      gain_per_h: 1.0\n'; } >"$work/aged.yaml"
simulate() { "$softgrip" simulate --model "$1" --input "$2" --out "$3" --noise-mm 0.05 --seed "$4" --rate-hz 100 >/dev/null; }
for signal in tp2 sp1; do
  simulate "$twin" $signal "$out/second_$signal.csv" 7
  simulate "$work/aged.yaml" $signal "$out/aged_$signal.csv" 9
done
"$softgrip" baseline --model "$twin" --data "$out/tp1.csv" "$out/steps.csv" "$out/sp2.csv" \
  --check "$out/second_tp2.csv" "$out/second_sp1.csv" --out "$out/baseline"
"$softgrip" diagnose --baseline "$out/baseline" --data "$out/aged_tp2.csv" "$out/aged_sp1.csv" --out "$out/changed"

say "8. Monitor 30 ordinary grips: after grip 18, the gain of the left finger decreases by 0.3 % per grip"
for grip in $(seq -w 30); do
  awk -v gain="$(awk -v n="$grip" 'BEGIN { print 1 - 0.003 * (n > 18 ? n - 18 : 0) }')" '
    /_mm_per_kpa:/ { sub(/[0-9.]+$/, $2 * gain) } /_per_mm:/ { sub(/[0-9.]+$/, $2 / gain) } { print }' "$twin" >"$work/worn.yaml"
  sed -e "0,/model: models/s#model: models/bench_twin.yaml#model: $work/worn.yaml#" -e "s# models/# $PWD/config/models/#" \
    -e "s#sequence_directory: sequences#sequence_directory: $PWD/config/sequences#" config/rig.yaml >"$work/worn_rig.yaml"
  "$softgrip" run config/sequences/pick_stone.yaml --rig "$work/worn_rig.yaml" --virtual-time --seed "$((10#$grip))" \
    --record "$out/grips/grip-$grip" --quiet --no-socket >/dev/null
done
# Exit code 6 of the command means that an alarm is active.
"$softgrip" health "$out/grips" --baseline "$out/baseline" --out "$out/health" || [ $? -eq 6 ]

say "All fingers are vented and all programs have stopped. Results in $out:"
(cd "$out" && ls -1d pick_stone.svg runs/*/run.csv identified/report.html diagnosis/* changed/report.html health/*.html)
echo
echo "The report: $out/diagnosis/report.html"
