#!/usr/bin/env bash
# Runs the system test: builds the package, boots a Debian 12 guest with the PREEMPT_RT kernel in QEMU, installs the package
# in the guest and runs the steps of tests/system/vm/drive/steps.py.
#   scripts/system_test.sh [--latency] [--seed N] [--work DIR] [--log FILE]
#   --latency   measures the wake-up latency of softgripd and cyclictest instead; the clock of the guest counts instructions
# DIR (default $SOFTGRIP_GUEST, else build/guest) keeps the guest. The first preparation of the guest downloads about 250 MB.
# Needs root for Debian packages and for the guest's root file system, but no KVM. The exit code is 0 if every step passed.
set -euo pipefail
cd "$(dirname "$(realpath "$0")")/.."
work=${SOFTGRIP_GUEST:-build/guest} log= seed= latency=false
while [ $# -gt 0 ]; do
  case $1 in
    --latency) latency=true ;;
    --seed) seed=$2 && shift ;;
    --work) work=$2 && shift ;;
    --log) log=$2 && shift ;;
    *) sed -n '2,8s/^# \{0,1\}//p' "$0" >&2; exit 2 ;;
  esac
  shift
done
mkdir -p "$work"
work=$(realpath "$work")
log=$(realpath -m "${log:-$work/$($latency && echo latency || echo system_test).log}")
vm=tests/system/vm
drive=$(mktemp -d -p "$work" folder.XXXXXX)
trap 'rm -rf "$drive"' EXIT

bash scripts/packages.sh build package guest
cp $vm/drive/* "$drive/"
# Builds two packages of the same programs. The guest installs the second package as an upgrade of the first.
for revision in 1 2; do
  bash scripts/package.sh "$work/packages" "$revision" >"$work/package.log" 2>&1 || { cat "$work/package.log" >&2; exit 1; }
  package=$(tail -n 1 "$work/package.log")
  cp "$package" "$drive/"
done
bash $vm/prepare.sh "$work" "$package"
if $latency; then touch "$drive/latency"; else echo "$seed" >"$drive/seed"; fi
bash $vm/boot.sh "$work" "$drive" "$log"
grep -q ': PASSED' "$log"
