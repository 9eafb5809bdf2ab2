# Functions for other scripts: they run the programs of examples/cpp and check the output of these programs.
source=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
model=$source/config/models/bench_twin.yaml
daemon=
end_daemon() { [ -z "$daemon" ] || kill "$daemon" 2>/dev/null || true; }

fail() { echo "$(basename "$0"): $*" >&2; exit 1; }
# says TEXT COMMAND...  runs the command and fails if its output does not contain TEXT
says() {
  local text=$1
  shift
  "$@" >output.txt 2>&1 || { cat output.txt >&2; fail "failed: $*"; }
  grep -qF -- "$text" output.txt || { cat output.txt >&2; fail "'$text' is not in the output of: $*"; }
}

# run_examples FOLDER SOFTGRIP SOFTGRIPD  runs each example in FOLDER. SOFTGRIP writes the logs and SOFTGRIPD
# runs the rig for the examples. On exit, the caller calls end_daemon.
run_examples() {
  local examples=$1 softgrip=$2 softgripd=$3
  says "19.99," "$examples/simulate_finger" "$model"
  says "largest error" "$examples/invert_finger" "$model"
  grep -Eq 'largest error [0-9.]+e-[0-9]+ mm' output.txt || { cat output.txt >&2; fail "the inverse is not exact"; }
  says "RMSE of the last cycle: 0.0" "$examples/closed_loop" "$model"
  says "20.0 kPa: ok, 4.0 mm" "$examples/board_driver"

  "$softgrip" simulate --model "$model" --input tp1 --rate-hz 20 --noise-mm 0.05 --out one.csv >/dev/null
  "$softgrip" simulate --model "$model" --input tp2 --rate-hz 20 --noise-mm 0.05 --seed 2 --out other.csv >/dev/null
  # A log file as another program writes it, with other column names, pressures in bar, and semicolons between the
  # columns.
  awk -F, 'BEGIN {print "Time [s];Pressure setpoint [bar];Displacement [mm]"}
    NR > 1 {printf "%s;%.8f;%s\n", $1, $2 / 100, $3}' one.csv >external.csv
  says "transport_delay" "$examples/diagnose_csv" external.csv report.html
  grep -q "<html" report.html || fail "no report"
  says "parameters differ" "$examples/compare_fingers" one.csv other.csv

  "$softgrip" baseline --data one.csv --model "$model" --out baseline >/dev/null
  mkdir recordings && cp one.csv recordings/
  says "too few grips" "$examples/nightly_health" recordings/one.csv baseline night
  grep -q "<html" night/health-.html && [ -s night/health-scores.jsonl ] || fail "no page or no scores of the health"

  # A daemon with a simulated board.
  sed -e "s#/tmp/softgrip.sock#$PWD/socket#; s#/tmp/softgrip-runs#$PWD/runs#; s#models/bench_twin.yaml#$model#" \
    -e "s#sequence_directory: sequences#sequence_directory: $source/config/sequences#" "$source/config/rig.yaml" >rig.yaml
  "$softgripd" --config rig.yaml >daemon.log 2>&1 &
  daemon=$!
  # On a busy machine, the daemon has its socket before its first reading.
  for _ in $(seq 600); do ! "$softgrip" status --socket socket 2>/dev/null | grep -q idle || break; sleep 0.05; done
  says "result: HOLDING" "$examples/grip_and_wait" socket pick_stone
  ! "$examples/grip_and_wait" socket pick_stome 2>output.txt || fail "grip_and_wait started a sequence that does not exist"
  grep -q "cannot be run on this rig" output.txt || { cat output.txt >&2; fail "no reason of the refusal"; }
  kill "$daemon" && wait "$daemon" || fail "softgripd ended with $?"
  daemon=
}
