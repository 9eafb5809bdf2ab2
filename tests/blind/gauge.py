#!/usr/bin/python3
"""The sensor of a blind world on a gauge, for `softgrip investigate --gauge-command "gauge.py PROGRAM FOLDER WORLD..."`.

    gauge.py BLIND_WORLD FOLDER [option of blind-world ...] POSITIONS_CSV GAUGE_OUT

FOLDER is that of rig.py: what was played before lies in it, and the world's time has gone on.
"""
import pathlib
import subprocess
import sys

program, folder, *world, positions, gauge = sys.argv[1:]
played = sorted(pathlib.Path(folder).glob("*.csv"))
before = [word for path in played for word in ("--command", path)]
subprocess.run([program, *world, *before, "--gauge", positions, "--log", gauge], check=True)
