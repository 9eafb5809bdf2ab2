#!/usr/bin/env bash
# Measures the wake-up latency and the overruns of softgripd, and compares them with cyclictest. softgripd
# runs at 1 kHz over Modbus TCP on the loopback interface. Both programs have the same priority and processor
# and run alternately: latency.sh [ROUNDS [SECONDS_PER_TURN]] Needs a built tree (build/release, or
# BUILD=...), cyclictest (rt-tests) and the right to use SCHED_FIFO.
set -euo pipefail
rounds=${1:-3}
turn_s=${2:-20}
root=$(dirname "$(dirname "$(realpath "$0")")")
build=${BUILD:-$root/build/release}
priority=70
cpu=$(($(nproc) - 1))
work=$(mktemp -d)
emulator=

finish() {
  [ -z "$emulator" ] || kill "$emulator" 2>/dev/null || true
  rm -rf "$work"
}
trap finish EXIT
command -v cyclictest >/dev/null || { echo "latency.sh: cyclictest is missing (package rt-tests)" >&2; exit 1; }

# The example rig runs at 1 kHz. If a busy computer delays an exchange, the delay must count as an overrun of the bus
# and must not end the run.
sed -e 's/^rate_hz: .*/rate_hz: 1000/' -e "s|models/|$root/config/models/|; s|boards/|$root/config/boards/|" \
  -e "s|sequence_directory: .*|sequence_directory: $root/config/sequences}|" \
  -e 's/^  bus_down_cycles: .*/  bus_down_cycles: 100/' -e 's/^  invalid_reading_cycles: .*/  invalid_reading_cycles: 100/' \
  -e 's/^  max_missed_commands: .*/  max_missed_commands: 100/' \
  -e "s/priority: [0-9]*, cpus: \[[0-9]*\]/priority: $priority, cpus: [$cpu]/" \
  "$root/config/rig_tcp.yaml" >"$work/rig.yaml"

"$build/tools/softgrip-rig" --model "$root/config/models/bench_twin.yaml" --rig "$work/rig.yaml" --tcp 0 \
  >"$work/emulator.log" 2>&1 &
emulator=$!
for _ in $(seq 100); do
  grep -q 'listening on' "$work/emulator.log" && break
  sleep 0.1
done
port=$(sed -n 's/.*listening on .*:\([0-9]*\).*/\1/p' "$work/emulator.log" | head -1)
[ -n "$port" ] || { cat "$work/emulator.log" >&2; exit 1; }
sed -i "s/^    port: .*/    port: $port/" "$work/rig.yaml"

# Prints one histogram from a file of softgripd, one line "microseconds count" for each bin.
bins_of() {
  awk -v title="# Histogram ($2, us)" '$0 == title {inside = 1; next} /^#/ {inside = 0} inside {print $1 + 0, $2 + 0}' "$1"
}
# Reads lines "microseconds count" from several histograms. Prints p50, p99, p99.9, the maximum and the number of
# samples of all histograms together.
quantiles() {
  sort -n | awk '
    {us[NR] = $1; count[NR] = $2; total += $2}
    function at(share,   i, seen) {
      for (i = 1; i <= NR; ++i) {seen += count[i]; if (seen >= share * total) return us[i]}
      return us[NR]
    }
    END {if (total) printf "%8d %8d %8d %8d %9d\n", at(0.5), at(0.99), at(0.999), us[NR], total}'
}
row() { printf '%-34s %s\n' "$1" "$(quantiles)"; }
count_of() { sed -n "s/^# $2: //p" "$1"; }

printf '%-34s %8s %8s %8s %8s %9s\n' 'microseconds' p50 p99 p99.9 max number
for round in $(seq "$rounds"); do
  "$build/daemon/softgripd" --config "$work/rig.yaml" --no-socket --duration-s "$turn_s" \
    --histograms "$work/softgripd.$round" >>"$work/softgripd.log" 2>&1 || { cat "$work/softgripd.log" >&2; exit 1; }
  cyclictest -m -q -t 1 -p "$priority" -a "$cpu" -i 1000 -D "$turn_s" -h 100000 |
    awk '/^[0-9]/ && $2 + 0 > 0 {print $1 + 0, $2 + 0}' >"$work/cyclictest.$round"
  bins_of "$work/softgripd.$round" 'loop wake-up' | row "round $round softgripd loop wake-up"
  row "round $round cyclictest" <"$work/cyclictest.$round"
done

echo
cat "$work"/cyclictest.* | row 'cyclictest'
for what in 'loop wake-up' 'bus wake-up' 'loop compute' 'exchange' 'reading age'; do
  for file in "$work"/softgripd.[0-9]*; do bins_of "$file" "$what"; done | row "softgripd $what"
done
for what in 'Ticks' 'Overruns, woken late' 'Overruns, took long' 'Exchanges' 'Failed exchanges'; do
  total=0
  for file in "$work"/softgripd.[0-9]*; do total=$((total + $(count_of "$file" "$what"))); done
  printf 'softgripd %s: %d\n' "${what,}" "$total"
done
grep -h 'real time:\|cost:' "$work/softgripd.log" | sed 's/^.*info: //' | sort -u
