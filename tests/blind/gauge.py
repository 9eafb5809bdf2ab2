#!/usr/bin/python3
"""Simulates a gauge check of the sensor in a simulated world, for `softgrip investigate --gauge-command "gauge.py
PROGRAM FOLDER WORLD..."`.

    gauge.py BLIND_WORLD FOLDER [option of blind-world ...] POSITIONS_CSV GAUGE_OUT

FOLDER contains the earlier commands of rig.py. The simulation plays these commands before the gauge check.
"""
import pathlib
import subprocess
import sys

program, folder, *world, positions, gauge = sys.argv[1:]
played = sorted(pathlib.Path(folder).glob("*.csv"))
before = [word for path in played for word in ("--command", path)]
subprocess.run([program, *world, *before, "--gauge", positions, "--log", gauge], check=True)
