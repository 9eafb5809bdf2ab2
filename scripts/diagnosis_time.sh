#!/usr/bin/env bash
# How long a diagnosis takes and what the time goes into: three logs of about 12,000 samples, all causes, once where
# one cause is hidden and once where two are: diagnosis_time.sh [BUILD]
set -euo pipefail
root=$(dirname "$(dirname "$(realpath "$0")")")
build=${1:-$root/build/release}
softgrip=$build/tools/softgrip
models=$root/config/models
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

sed '/valve_lag/,/time_constant_s/d' "$models/bench_twin.yaml" >"$work/one.yaml"
cp "$models/bench_twin.yaml" "$work/two.yaml"
for hidden in one two; do
  logs=()
  for signal in tp1 tp2 sp2; do
    "$softgrip" simulate --model "$work/$hidden.yaml" --input $signal --noise-mm 0.04 --seed 5 --rate-hz 240 \
      --out "$work/${hidden}_$signal.csv" >/dev/null
    logs+=("$work/${hidden}_$signal.csv")
  done
  TIMEFORMAT="$hidden hidden: %R s by the clock, %U s of processor time, $(cat "${logs[@]}" | wc -l) samples"
  time "$softgrip" diagnose --model "$models/zhang2025.yaml" --data "${logs[@]}" --out "$work/$hidden" \
    --no-closed-loop --json >"$work/$hidden.json"
  python3 - "$work/$hidden.json" <<'PYTHON'
import json, sys
diagnosis = json.load(open(sys.argv[1]))
print("  named:", ", ".join(cause["id"] for cause in diagnosis["causes"]))
for stage, took_s in diagnosis["stages_s"].items():
    print(f"  {stage}: {took_s:.2f} s")
PYTHON
done
