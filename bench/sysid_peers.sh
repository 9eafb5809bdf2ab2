#!/bin/bash
# Fits the same three logs from the same start points with softgrip, with scipy's least_squares and with
# Octave's lsqcurvefit, and prints the ratios. The fits with scipy and
# Octave use a compiled simulator that is as exact as softgrip's.
#
#   bench/sysid_peers.sh [BUILD_FOLDER [STARTS [PEER_STARTS [SAMPLES]]]]
#
# Needs the packages python3-scipy, octave, octave-optim, octave-dev (scripts/packages.txt, section bench).
# The fits with scipy and Octave take minutes for twenty starts. They use only the first PEER_STARTS starts if this
# number is given.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
build=${1:-$here/../build/release}
starts=${2:-20}
peer_starts=${3:-5}
samples=${4:-12000}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

cc -O2 -shared -fPIC -o "$folder/simulator.so" "$here/sysid_peer_simulator.c" -lm
"$build/bench/sysid_starts" "$folder" "$starts" "$samples"
OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 /usr/bin/python3 "$here/sysid_peers.py" "$folder" "$peer_starts"
if command -v mkoctfile > /dev/null; then
  cp "$here/sysid_peer_simulator.c" "$here/sysid_peer_mex.c" "$here/sysid_peers.m" "$folder"
  (cd "$folder" && mkoctfile -O2 --mex -o simulate.mex sysid_peer_mex.c sysid_peer_simulator.c > /dev/null 2>&1 \
    && OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 octave --no-gui --quiet --no-history --eval "sysid_peers('$folder', $peer_starts)")
else
  echo "Octave: mkoctfile is missing (octave-dev); left out"
fi
