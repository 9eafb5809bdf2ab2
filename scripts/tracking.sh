#!/usr/bin/env bash
# Tracks a sine of 6 to 20 mm over Modbus TCP with softgrip-rig at 200 Hz. Repeats the run with each type of
# feedforward; the PID gains are the same in all runs. Prints the tracking errors of both fingers:
# tracking.sh [BUILD_DIR] [FREQUENCY_HZ] [CYCLES] The figures include the noise of the readings (0.03 mm) and
# the resolution of the board (12 bits).
set -euo pipefail
cd "$(dirname "$(realpath "$0")")/.."
build=${1:-build/release} frequency_hz=${2:-0.1} cycles=${3:-3}
work=$(mktemp -d) runs=$work/runs
. scripts/rig_session.sh
trap 'stop_daemon; stop_rig; rm -rf "$work"' EXIT

cat >"$work/track.yaml" <<Y
name: track
about: sine between 6 and 20 mm
steps:
  - move: {displacement_mm: 6, speed_mm_per_s: 5, settle_s: 2}
  - track: {mean_mm: 13, amplitude_mm: 7, frequency_hz: $frequency_hz, cycles: $cycles}
  - release: {duration_s: 1, purge_s: 0.5, timeout_s: 10, on_fail: vent}
Y
printf '%-24s %14s %14s\n' "feedforward, with PID" "RMSE left mm" "RMSE right mm"
for feedforward in none bouc_wen full_model; do
  start_rig
  start_daemon "s#feedforward: full_model#feedforward: $feedforward#"
  "$softgrip" start --wait "$work/track.yaml" >"$work/start.log" 2>&1 || { cat "$work/start.log" >&2; exit 1; }
  stop_daemon
  stop_rig
  # Finds the positions of the columns by their names. Selects those rows of the track step (index 1) that have a
  # reference.
  awk -F, -v name="$feedforward" '
    NR == 1 {for (i = 1; i <= NF; ++i) at[$i] = i; next}
    $at["step"] == 1 && $at["state"] == "running" && $at["reference_mm"] != "" && $at["displacement_mm"] != "" {
      e = $at["reference_mm"] - $at["displacement_mm"]; sum[$at["channel"]] += e * e; ++n[$at["channel"]]}
    END {printf "%-24s %14.4f %14.4f\n", name, sqrt(sum["left"] / n["left"]), sqrt(sum["right"] / n["right"])}
  ' "$runs"/*/run.csv
  rm -rf "$runs"
done
