#!/usr/bin/python3
"""Provides a simulated world as the rig of `softgrip investigate --rig-command "rig.py PROGRAM FOLDER WORLD..."`.

    rig.py BLIND_WORLD FOLDER [option of blind-world ...] COMMAND_CSV LOG_OUT

The state of the world continues from call to call: each call stores its command in FOLDER and plays all earlier
commands before its own command.
"""
import pathlib
import shutil
import subprocess
import sys

program, folder, *world, command, log = sys.argv[1:]
played = pathlib.Path(folder)
played.mkdir(parents=True, exist_ok=True)
shutil.copy(command, played / f"{len(list(played.iterdir())) + 1:03}.csv")
before = [word for path in sorted(played.iterdir()) for word in ("--command", path)]
subprocess.run([program, *world, *before, "--log", log], check=True)
