#!/usr/bin/env bash
# Compares the results of another version with the results of this version. Both builds do the same work at the same time:
#   same_numbers.sh OTHER_CHECKOUT OTHER_BUILD [BUILD]
# Two recordings in virtual time, three simulations, and the figures of the control study must be identical. The causes in
# three diagnoses are printed next to each other. The other checkout provides the configuration, because this version can
# still read older rig files. The exit code is 1 if a recording, a simulation or the study differs.
set -euo pipefail
[ $# -ge 2 ] || { sed -n '2,6s/^# \{0,1\}//p' "$0" >&2; exit 2; }
root=$(dirname "$(dirname "$(realpath "$0")")")
config=$(realpath "$1")/config
declare -A build=([other]=$(realpath "$2") [this]=$(realpath "${3:-$root/build/release}"))
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
differs=0

compare() {  # compare NAME FILE
  if cmp -s "$work/other/$2" "$work/this/$2"; then
    echo "$1: identical"
  else
    echo "$1: different"
    diff "$work/other/$2" "$work/this/$2" | head -n 6
    differs=1
  fi
}

sed '/valve_lag/,/time_constant_s/d' "$config/models/bench_twin.yaml" >"$work/one.yaml"
cp "$config/models/bench_twin.yaml" "$work/two.yaml"
cp "$config/models/zhang2025.yaml" "$work/none.yaml"

for side in other this; do
  mkdir "$work/$side"
  cd "$work/$side"
  for sequence in track_sine pick_stone; do
    "${build[$side]}/daemon/softgripd" --config "$config/rig.yaml" --virtual-time --seed 1 \
      --sequence "$config/sequences/$sequence.yaml" --record "$sequence" >"$sequence.log" 2>&1
  done
  for hidden in none one two; do
    logs=()
    for signal in tp1 tp2 sp2; do
      "${build[$side]}/tools/softgrip" simulate --model "$work/$hidden.yaml" --input $signal --noise-mm 0.04 --seed 5 \
        --rate-hz 240 --out "${hidden}_$signal.csv" >/dev/null
      logs+=("${hidden}_$signal.csv")
    done
    "${build[$side]}/tools/softgrip" diagnose --model "$config/models/zhang2025.yaml" --data "${logs[@]}" \
      --out "$hidden" --no-closed-loop --json >"$hidden.json" 2>"$hidden.err" || true
  done
  # Removes the first line, because its text differs between versions even if the results are the same.
  "${build[$side]}/bench/tracking_study" | tail -n +2 >study.txt
done

for sequence in track_sine pick_stone; do compare "recording of $sequence" "$sequence/run.csv"; done
for hidden in none one two; do
  for signal in tp1 tp2 sp2; do compare "simulation of $signal, $hidden hidden" "${hidden}_$signal.csv"; done
done
compare "control study" study.txt
python3 - "$work" <<'PYTHON'
import json, pathlib, sys

work = pathlib.Path(sys.argv[1])
for hidden in "none", "one", "two":
    for side in "other", "this":
        diagnosis = json.loads((work / side / f"{hidden}.json").read_text())
        named = ["{} {}".format(cause["id"], ", ".join(f"{name} {one['value']:.5g} [{one['ci95'][0]:.5g}, {one['ci95'][1]:.5g}]"
                                                      for name, one in cause["parameters"].items()))
                 for cause in diagnosis["causes"]]
        print(f"diagnosis, {hidden} hidden, {side}: {diagnosis['verdict']}; {'; '.join(named) or 'nothing named'}")
PYTHON
exit $differs
